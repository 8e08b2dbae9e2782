#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/faults.hpp"

namespace hotfire::test {

/// How a fault ended driving, as the recording of a lab has it. Counted in cycles of the loop, because the periods of an
/// emulated machine are as long as its host lets them be.
struct Stop {
  firmware::Fault fault{};
  std::uint64_t seen = 0;             ///< first cycle that was given what the fault is found from; 0: nothing shows it
  std::uint64_t safe = 0;             ///< first cycle in which nothing was driven
  std::vector<std::int64_t> drove{};  ///< when the last cycles before it began, CLOCK_MONOTONIC [ns]
};

/// What a recording says of a lab that was run with the limits of `LabProgram`, but for `age_limit_ns` of what can be stale.
struct LabRecord {
  std::vector<Stop> stops{};
  std::uint64_t commands = 0;  ///< that were handed to the bus
};
LabRecord read_lab_record(const std::string& path, std::int64_t age_limit_ns);

}  // namespace hotfire::test
