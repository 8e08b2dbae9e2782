// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// Adds channels of `modelled` to a record, each with white noise of its rms.
inline void add_readings(Record& record, const Record& modelled, const std::vector<std::pair<std::string, double>>& noise,
                         std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (const auto& [name, rms] : noise) {
    record.channels.push_back(*modelled.find(name));
    for (double& value : record.channels.back().values) {
      value += rms * normal(random);
    }
  }
}

}  // namespace hotfire::test
