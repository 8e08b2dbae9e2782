// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tools/study/draws/random.hpp"
#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::study {

/// What an axis goes through: half of what 99 % of the rows stay below, of each quantity and of each product of two.
class WildScales {
 public:
  explicit WildScales(const QuantityRows& rows);
  double of(WildArgument argument, std::optional<WildArgument> factor = {}) const;

 private:
  std::array<double, kWildArguments * kWildArguments> products_{};
  std::array<double, kWildArguments> single_{};
};

/// A law at random: every site as likely as any other; half of what a site transmits replaced, else a term added over a
/// quantity of the site, one of another site, or a product; a memory, a curve, or both. Its amplitude or constants are a
/// first guess (`resized`). What is one of the listed effects, a declared parameter, or next to one of these, is drawn
/// again.
WildLaw draw_wild_law(Random& random, const ReferenceAxis& axis, const WildScales& scales);

/// The same law at `factor` times the size: the amplitude of what is added, the constants of what replaces.
WildLaw resized(const WildLaw& law, double factor);

/// The sites that are right for it, as in `StudiedEffect::site`: its own, and those from which no prior separates it.
std::string_view right_sites(const WildLaw& law);

/// Whether a law is a listed effect, a declared parameter, or so near to one that naming that would be fair.
bool is_known_effect(const WildLaw& law);

/// A listed effect that is a true part of the law: naming it is no wrong name. Empty: none.
std::string_view contained_effect(const WildLaw& law);

/// "engine_torque: even waves of rate x pressure, band-passed (7.2 Hz, 0.30)".
std::string words_of(const WildLaw& law);

}  // namespace hotfire::study
