// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire::explain::words {

/// What `explain` refuses, with the remedy. `record` and `model` are the names or paths of the files.
std::string turned_mass(const std::string& record, double left_turned, double left);
std::string inverted_channel(const std::string& record, const std::string& moving, double correlation,
                             const std::string& culprit);
/// `hint` begins with a blank, or is empty.
std::string mis_scaled_channel(const std::string& record, const std::string& moving, double ratio, double correlation,
                               const std::string& culprit, const std::string& hint);
std::string diverges_held_out(const std::string& record);
std::string diverges_declared(const std::string& model);

std::string malformed_exclusion(const std::string& text);
std::string unknown_record(const std::string& record, const std::vector<std::string>& known);
std::string no_such_rows(const std::string& record, double from, double to, double first, double last);
std::string nothing_to_fit(const std::string& record);
std::string missing_value(const std::string& record, const std::string& channel, double time);
std::string missing_start(const std::string& record, const std::string& channel);
/// Parts of the message for a missing column.
std::string drives_the_model();
/// `axes` as their names end channels.
std::string drives_axes(const std::vector<std::string>& axes);
std::string nothing_to_explain();

/// Parts of a model of several axes that `explain` does not take.
enum class Unsupported { vibration, piston_lag, string_lag, arm_tolerance };
inline constexpr std::size_t kUnsupported = 4;
std::string unsupported(const std::string& model, Unsupported part);
std::string axis_not_measured(const std::string& record, const std::string& axis);

}  // namespace hotfire::explain::words
