// SPDX-License-Identifier: Apache-2.0
#include "tests/report/sample_residual.hpp"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace hotfire::test {

using nlohmann::json;

namespace {

/// Values over a lag, before and after: `values(index, noise)` gives both.
template <class Values>
json over_lags(unsigned seed, Values&& values) {
  std::vector<double> lag;
  std::vector<double> before;
  std::vector<double> after;
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int index = 0; index <= 120; ++index) {
    const auto [one, other] = values(index, [&] { return noise(generator); });
    lag.push_back(0.004 * index);
    before.push_back(one);
    after.push_back(other);
  }
  return {{"lag_s", lag}, {"before", before}, {"after", after}, {"bound99", 0.052}};
}

}  // namespace

json autocorrelation() {
  return over_lags(7, [](int index, auto&& noise) {
    return std::pair(std::exp(-0.01 * index) * std::cos(0.07 * index), index == 0 ? 1.0 : noise());
  });
}

json input_correlation(bool independent) {
  json result = over_lags(8, [independent](int index, auto&& noise) {
    const double response = std::exp(-0.02 * index) * std::sin(0.06 * index);
    return std::pair(0.7 * response, (independent ? 0.0 : 0.25 * response) + noise());
  });
  result["independent"] = independent;
  return result;
}

json by_frequency(double noise, double declared_error) {
  json bands;
  double from = 0.0;
  for (double to = 1.0; to <= 256.0; to *= 2.0) {
    const double share = noise * std::sqrt((to - from) / 256.0);
    bands["from_hz"].push_back(from);
    bands["to_hz"].push_back(to);
    bands["before"].push_back(std::hypot(declared_error / (1.0 + to * to / 16.0), share));
    bands["after"].push_back(from == 0.0 ? json() : json(1.1 * share));
    bands["noise"].push_back(share);
    from = to;
  }
  return bands;
}

json by_amplitude(double largest, double noise, double declared_error) {
  return {{"from", {0.0, 0.1 * largest, 0.4 * largest}},
          {"to", {0.1 * largest, 0.4 * largest, largest}},
          {"before", {0.5 * declared_error, 0.7 * declared_error, declared_error}},
          {"after", {noise, 1.02 * noise, 1.4 * noise}},
          {"seconds", {3.2, 8.0, 12.8}}};
}

}  // namespace hotfire::test
