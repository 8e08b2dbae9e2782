// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>

namespace hotfire::explain {

/// Time since it was made [s]: on the wall, and of the processor by all threads of the program.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }
  double processor_seconds() const { return static_cast<double>(std::clock() - processor_began_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::clock_t processor_began_ = std::clock();
};

}  // namespace hotfire::explain
