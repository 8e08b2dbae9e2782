// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/interlock/faults.hpp"

namespace hotfire::test {

/// How a fault ended driving, as the recording of a lab has it. Counted in cycles of the loop, because the periods of an
/// emulated machine are as long as its host lets them be.
struct Stop {
  firmware::Fault fault{};
  std::uint64_t seen = 0;             ///< first cycle that was given what the fault is found from; 0: nothing shows it
  std::uint64_t safe = 0;             ///< first cycle in which nothing was driven
  std::vector<std::int64_t> drove{};  ///< when the last cycles before it began, CLOCK_MONOTONIC [ns]
};

/// What a recording says of a lab.
struct LabRecord {
  std::vector<Stop> stops{};
  std::uint64_t commands = 0;  ///< that were handed to the bus
};

/// Of the limits that it was run with, those that the usual image of `LabProgram` has otherwise.
struct LabLimits {
  std::int64_t age_ns = 0;                  ///< of a command and a reading
  std::uint64_t position_error_cycles = 0;  ///< in a row that are no fault
};
LabRecord read_lab_record(const std::string& path, const LabLimits& limits);

}  // namespace hotfire::test
