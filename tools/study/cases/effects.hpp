// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/draws/random.hpp"
#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::study {

/// An axis in the making: the true one, the same without the effects, and what the effects are.
struct Plan {
  ReferenceAxis axis;
  ReferenceAxis without;
  std::map<std::string, double> values;  ///< of the effects, by name
  std::string law;                       ///< of the effect, if it has laws
  std::string declared_effects;          ///< what the declared model knows of effects, as TOML
  std::string true_effects;              ///< the true effects in the model's own keys, as TOML
  bool in_model_terms = true;            ///< whether the model has keys for all of them
};

/// One effect that may be missing in a case.
struct StudiedEffect {
  std::string_view name;
  /// Where it acts; a second site, after a bar, is one that cannot be separated from it.
  std::string_view site;
  /// Draws the magnitude from a plausible range and puts it into the plan. The seed picks the law, so that three seeds are
  /// three laws.
  void (*plan)(Plan& plan, Random& random, std::uint64_t seed);
  /// A listed effect that is a true part of an unlisted one: naming it is no wrong name.
  std::string_view contains{};
};

/// Every effect of docs/physics.md section 4 that one axis can have.
std::span<const StudiedEffect> listed_effects();

/// Effects that are in no list.
std::span<const StudiedEffect> unlisted_effects();

/// Whether an effect is one of the listed.
bool is_listed(const StudiedEffect& effect);

/// The effect of that name, listed or not. Throws UsageError that lists the names if there is none.
const StudiedEffect& studied_effect(std::string_view name);

/// Ten pairs of listed effects, each effect at most twice.
std::span<const std::pair<std::string_view, std::string_view>> studied_pairs();

}  // namespace hotfire::study
