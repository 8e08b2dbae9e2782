// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "tools/explain/result/result.hpp"
#include "tools/study/tally/judge.hpp"

namespace hotfire::study {

// What counts as right where something is missing that is in no list.

/// Adds an effect that the finder reports: its name with its site, or "unlisted", "residual" or no name with the sites that
/// it may be at, its site, or none.
void add_find(const explain::FoundEffect& effect, Judgement& judgement);

/// Sets `wrong_name`, `site_right`, `names_right` and `halved` of a judgement that has its finds and errors. A listed effect
/// of `may_name` is a true part of the unlisted one. Of what is found beside the listed effects that are missing everything
/// has to be placed right: at a right site, or at one of at most four of which one is right.
void rule_on_unlisted(const std::set<std::string>& may_name, Judgement& judgement);

}  // namespace hotfire::study
