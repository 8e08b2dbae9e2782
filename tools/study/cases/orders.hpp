// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/cases/case.hpp"

namespace hotfire::study {

/// Which cases of a study: seeds `first_seed` onward, and only those named (all if none is).
struct Selection {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 3;
  std::vector<std::string> only;
};

/// The cases of a study, seed by seed. A case is named after its effects and its seed, "backlash-2", "leakage+rate_limit-1",
/// "null-7". `only` names effects, or pairs as "leakage+rate_limit". Throws UsageError for a name that the study does not
/// have.
std::vector<CaseOrder> effect_orders(const Selection& selection);
std::vector<CaseOrder> pair_orders(const Selection& selection);
std::vector<CaseOrder> unlisted_orders(const Selection& selection);

/// Engines with two axes, five cases a seed: `cross_axis` on pitch, on yaw, a hose across the axes that is in no list, one
/// other effect on one axis, and nothing missing. They are named "two-axes-cross_axis.pitch-1".
std::vector<CaseOrder> two_axis_orders(const Selection& selection);

/// Hard data, two cases for each of `hard_conditions()`: one effect, another one with every seed, and nothing missing.
/// `only` names conditions. They are named "closed-loop-backlash-1".
std::vector<CaseOrder> hard_orders(const Selection& selection);

/// A law drawn at random a seed, alone or beside a listed effect drawn at random. They are named "wild-1", or
/// "backlash+wild-1".
std::vector<CaseOrder> wild_orders(const Selection& selection, bool beside_a_listed_one);

/// Null records: noise of half to five times the usual, true parameters scattered within half to twice the tolerances.
std::vector<CaseOrder> null_orders(const Selection& selection);

}  // namespace hotfire::study
