// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/benchmark/counted.hpp"

namespace hotfire::test {

/// What one step of a plant is made of.
struct StepContents {
  std::string name;
  Operations operations;  ///< of the step, in the mean over a run
  std::size_t bytes = 0;  ///< of constants and state, which a step reads
};

/// Of one axis as declared and with three effects, counted by a scalar that counts. A law that iterates in plain numbers
/// before its last iteration is counted with the last one only.
std::vector<StepContents> contents_of_steps();

}  // namespace hotfire::test
