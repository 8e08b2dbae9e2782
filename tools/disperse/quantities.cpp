// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

namespace hotfire::disperse {

namespace {

/// Ranks from 1; equal values share the mean of theirs.
std::vector<double> mean_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) { return values[one] < values[other]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) {
      ++end;
    }
    for (std::size_t place = first; place < end; ++place) {
      ranks[order[place]] = 0.5 * static_cast<double>(first + 1 + end);
    }
    first = end;
  }
  return ranks;
}

}  // namespace

std::vector<std::pair<std::string, double>> numbers_of(const nlohmann::ordered_json& document, const std::string& prefix) {
  if (document.is_structured()) {
    std::vector<std::pair<std::string, double>> all;
    for (const auto& [key, value] : document.items()) {
      const auto own = numbers_of(value, prefix.empty() ? key : fmt::format("{}.{}", prefix, key));
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }
  if (document.is_number()) {
    return {{prefix, document.get<double>()}};
  }
  if (document.is_boolean()) {
    return {{prefix, document.get<bool>() ? 1.0 : 0.0}};
  }
  if (document.is_null()) {
    return {{prefix, std::numeric_limits<double>::quiet_NaN()}};
  }
  return {};
}

double quantile(const std::vector<double>& ordered, double share) {
  const double place = share * static_cast<double>(ordered.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ordered.size() - 1);
  return ordered[below] + (place - static_cast<double>(below)) * (ordered[above] - ordered[below]);
}

Statistics statistics_of(const std::vector<double>& values) {
  Statistics own;
  std::copy_if(values.begin(), values.end(), std::back_inserter(own.ordered),
               [](double value) { return std::isfinite(value); });
  std::sort(own.ordered.begin(), own.ordered.end());
  const auto count = static_cast<double>(own.ordered.size());
  own.mean = own.ordered.empty() ? std::numeric_limits<double>::quiet_NaN()
                                 : std::accumulate(own.ordered.begin(), own.ordered.end(), 0.0) / count;
  const double squares = std::accumulate(own.ordered.begin(), own.ordered.end(), 0.0, [&](double sum, double value) {
    return sum + (value - own.mean) * (value - own.mean);
  });
  own.standard_deviation = count > 1.0 ? std::sqrt(squares / (count - 1.0)) : 0.0;
  return own;
}

double rank_correlation(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> first;
  std::vector<double> second;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (std::isfinite(one[i]) && std::isfinite(other[i])) {
      first.push_back(one[i]);
      second.push_back(other[i]);
    }
  }
  const std::vector<double> x = mean_ranks(first);
  const std::vector<double> y = mean_ranks(second);
  const double middle = 0.5 * (static_cast<double>(x.size()) + 1.0);
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - middle) * (x[i] - middle);
    yy += (y[i] - middle) * (y[i] - middle);
    xy += (x[i] - middle) * (y[i] - middle);
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace hotfire::disperse
