// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// A model of one topology with effects, delays, sensors and strings, what drives it, and what `hotfire simulate` makes of
/// that.
struct Case {
  std::string topology;
  std::string text;                         ///< of the model file
  double period;                            ///< between readings [s]
  std::size_t periods_per_row = 1;          ///< of the record
  std::vector<std::string> inputs;          ///< names of those that are driven
  std::vector<std::vector<double>> driven;  ///< by input and period
  Record simulated;

  std::size_t periods() const { return driven.front().size(); }
  /// What `hotfire simulate` reads after so many periods, if that is a row of the record; in the order of the outputs.
  bool reads_at(std::size_t after) const { return after % periods_per_row == 0; }
  std::vector<double> readings_at(std::size_t after) const;
  std::vector<std::string> outputs() const;
};

/// Those whose derivatives and cost are tested.
inline constexpr std::array<const char*, 4> kTopologies{"simplex", "direct", "taos", "masv"};

/// One of them, over `rows` rows of 1 ms.
Case case_of(const std::string& topology, std::size_t rows);

/// Every topology, over `rows` rows of 1 ms.
std::vector<Case> cases(std::size_t rows);

}  // namespace hotfire::test
