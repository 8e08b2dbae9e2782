// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace hotfire::disperse {

/// Every number of a JSON document under its path, as in `engine.0.overshoot` of the first member of an array; true is 1,
/// false 0, null not a number. Text has no place here.
std::vector<std::pair<std::string, double>> numbers_of(const nlohmann::ordered_json& document,
                                                       const std::string& prefix = "");

/// The value that a share of a sample lies below, 0 to 1, interpolated between the ordered values
/// [Hyndman and Fan 1996, The American Statistician 50, definition 7]. `ordered` rises and is not empty.
double quantile(const std::vector<double>& ordered, double share);

/// What a sample says of a quantity; values that are not finite are left out.
struct Statistics {
  std::vector<double> ordered;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of a sample: divided by the number of values less one
};
Statistics statistics_of(const std::vector<double>& values);

/// Rank correlation of two samples, -1 to 1 [Spearman 1904, American Journal of Psychology 15]; equal values have the mean
/// of their ranks. Pairs with a value that is not finite are left out; not a number where a sample does not vary.
double rank_correlation(const std::vector<double>& one, const std::vector<double>& other);

}  // namespace hotfire::disperse
