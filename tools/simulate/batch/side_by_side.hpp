// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// A model and the record that drives it. Both must outlive the run.
struct OpenLoopRun {
  const ModelFile* model;
  const Record* inputs;
};

/// Hydraulic axes that run side by side in the registers of one core.
inline constexpr int kSideBySide = 8;

/// The runs in groups of up to `kSideBySide`, by their place, every run in one group. A group of several is one for
/// `simulate_side_by_side`. About `threads` groups, so that every thread has work, where the groups are then large enough to
/// gain from it.
std::vector<std::vector<std::size_t>> groups_side_by_side(std::span<const OpenLoopRun> runs, unsigned threads);

/// What one of several runs gives: its record, or why it failed.
struct RunOutcome {
  Record record;
  std::exception_ptr failure;
};

/// `simulate` of up to `kSideBySide` runs at once, with the bits that each run has alone. The models are hydraulic axes with
/// the same effects, laws and step, and no effect of unknown law; the records have the same period and number of rows.
std::vector<RunOutcome> simulate_side_by_side(std::span<const OpenLoopRun> runs);

}  // namespace hotfire
