// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/cycle_check.hpp"

#include <algorithm>
#include <cmath>

namespace hotfire::loop {

namespace {

/// How far an oscillation is from a cycle: the larger difference of the logarithms of amplitude and frequency.
double distance(const Oscillation& end, const LimitCycle& cycle) {
  return std::max(std::abs(std::log(end.amplitude / cycle.amplitude)), std::abs(std::log(end.frequency / cycle.frequency)));
}

}  // namespace

std::vector<CheckedCycle> checked(const std::vector<LimitCycle>& predicted, const CycleFlight& flight) {
  std::vector<CheckedCycle> all;
  for (const LimitCycle& cycle : predicted) {
    CheckedCycle own{cycle};
    if (cycle.stable && flight) {
      own.end = flight(cycle);
      own.check = own.end.outcome == Outcome::unsettled ? Check::unsettled : Check::leaves;
      if (own.end.outcome == Outcome::oscillates) {
        const double far = distance(own.end, cycle);
        const bool is_nearest = std::none_of(predicted.begin(), predicted.end(),
                                             [&](const LimitCycle& other) { return distance(own.end, other) < far; });
        own.check = is_nearest && far < std::log1p(kStays) ? Check::stays : Check::leaves;
      }
    }
    all.push_back(own);
  }
  return all;
}

}  // namespace hotfire::loop
