// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "tools/linear/linear_model.hpp"

namespace hotfire::linear {

/// A linear model as JSON: names, units, matrices (rows of numbers), delays, the sampled system.
nlohmann::ordered_json to_json(const LinearModel& model);

/// Writes a linear model, whole or not at all, in the format that the name ends with:
/// - `.mat` (MATLAB 5): A, B, C, D, step_A, step_B, period, and cell arrays state_names, state_units, input_names ...
/// - `.json`: as `to_json`;
/// - `.csv`: a row for every entry of a matrix that is not zero, with the names and units of its row and its column.
/// Throws UsageError for another ending and FileError for what cannot be written.
void write_model(const LinearModel& model, const std::filesystem::path& path);

}  // namespace hotfire::linear
