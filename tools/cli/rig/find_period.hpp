// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire {

/// How `hotfire timing --find` searches.
struct PeriodSearch {
  double seconds = 5.0;  ///< of each trial
  bool json = false;
  std::vector<std::string> arguments{};  ///< of hotfire-rt timing, beyond period, number of cycles and report
};

/// Runs `hotfire-rt timing` at one period after the other and prints the shortest one at which no cycle was late in the
/// given time and the limits of --max-latency-us and --max-step-us held, to 5 %, and what made the next shorter one fail.
/// Exit status: 0, or 4 if no period is long enough. Throws UsageError if the program cannot be run or refuses its options.
int find_shortest_period(const PeriodSearch& search);

}  // namespace hotfire
