// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tools/study/tally/judge.hpp"

namespace hotfire::study {

// What counts as right where something is missing that is in no list.

/// Adds one entry of the report's `effects`: a name with its site, or "unlisted" or "residual", or no name, with a `site`,
/// with the `sites` that it may be, or with none. What has no name of a listed effect is no name.
void add_find(const nlohmann::json& effect, Judgement& judgement);

/// Sets `wrong_name`, `site_right`, `names_right` and `halved` of a judgement that has its finds and errors. A listed effect
/// of `may_name` is a true part of the unlisted one. Of what is found beside the listed effects that are missing everything
/// has to be placed right: at a right site, or at one of at most four of which one is right.
void rule_on_unlisted(const std::set<std::string>& may_name, Judgement& judgement);

}  // namespace hotfire::study
