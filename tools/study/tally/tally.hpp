// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/study/tally/judge.hpp"

namespace hotfire::study {

/// Exact 95 % interval of a probability of which `hits` of `trials` were seen: the values that a binomial test would not
/// refuse at 2.5 % to either side [Clopper and Pearson 1934, Biometrika 26(4)].
std::array<double, 2> exact_interval(std::size_t hits, std::size_t trials);

/// One figure that a study has to reach.
struct Figure {
  std::string name;
  std::size_t reached = 0;
  std::size_t of = 0;
  bool met = false;
  std::string asked;
};

/// The figures of all cases: of one effect, of two, of none and of unlisted ones, each kind only if it occurs.
///
/// One effect: 19 of 20 named right, the model closer to the truth than the sensor in 18 of 20. Pairs: 8 of 10 named.
/// Unlisted: none given a wrong name, 5 of 6 sites right, the error halved in all. Drawn at random: no wrong name in 97 of
/// 100, in 85 the right site or an error below the noise, in 85 the error halved; beside a listed effect that one named in
/// 27 of 30, both in 24, no wrong name in 29. Null: at most one of 40 with a false
/// find. Other counts are held to the same shares; half a case is none.
std::vector<Figure> figures_of(const std::vector<Judgement>& judgements);

/// A line for each figure; the false finds with their exact interval.
std::string summary_of(const std::vector<Judgement>& judgements);

nlohmann::json summary_json(const std::vector<Judgement>& judgements);

/// Whether every figure is met.
bool all_met(const std::vector<Judgement>& judgements);

}  // namespace hotfire::study
