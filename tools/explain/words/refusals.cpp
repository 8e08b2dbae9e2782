// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/words/refusals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>

namespace hotfire::explain::words {

std::string turned_mass(const std::string& record, double left_turned, double left) {
  return fmt::format(
      "{}: the mass moves against its force. With one sign inverted, the rms error of position on held-out data is {:.3g}; "
      "as recorded it is {:.3g}. Position or force is probably inverted. Invert it in the record. Nothing was fitted",
      record, left_turned, left);
}

std::string inverted_channel(const std::string& record, const std::string& moving, double correlation,
                             const std::string& culprit) {
  return fmt::format(
      "{}: {} runs against the declared model (correlation {:.2f}), so {} looks inverted. Invert its sign in the "
      "record, or the sign that the model declares. Nothing is fitted to it",
      record, moving, correlation, culprit);
}

std::string mis_scaled_channel(const std::string& record, const std::string& moving, double ratio, double correlation,
                               const std::string& culprit, const std::string& hint) {
  return fmt::format(
      "{}: {} follows the declared model at {:.4g} times its size (correlation {:.3f}), so {} looks mis-scaled{}. Correct "
      "its unit in the record's first line, or its calibration. Nothing is fitted to it",
      record, moving, ratio, correlation, culprit, hint);
}

std::string diverges_held_out(const std::string& record) {
  return fmt::format("{}: a model diverges on this record, which is held out", record);
}

std::string diverges_declared(const std::string& model) {
  return fmt::format("{}: the declared model diverges on these records: its parameters make it unstable", model);
}

std::string malformed_exclusion(const std::string& text) {
  return fmt::format("--exclude {}: write RECORD@FROM-TO with times in seconds, such as steps.csv@3.0-3.5", text);
}

std::string unknown_record(const std::string& record, const std::vector<std::string>& known) {
  return fmt::format("--exclude {}: there is no record of that name; there are: {}", record, fmt::join(known, ", "));
}

std::string no_such_rows(const std::string& record, double from, double to, double first, double last) {
  return fmt::format("--exclude {}@{:g}-{:g}: no row of the record is there; the record is from {:g} to {:g} s", record,
                     from, to, first, last);
}

std::string nothing_to_fit(const std::string& record) {
  return fmt::format("--exclude leaves no row of {} to fit; exclude less", record);
}

std::string missing_value(const std::string& record, const std::string& channel, double time) {
  return fmt::format("{}: channel {} has no value at {:.6g} s, and no --exclude covers that time; exclude it too", record,
                     channel, time);
}

std::string missing_start(const std::string& record, const std::string& channel) {
  return fmt::format(
      "{}: channel {} is missing from the start, so the initial state of the axis is unknown. Cut the record to begin after "
      "the gap",
      record, channel);
}

std::string drives_the_model() { return "it drives the model, so rename the column that drives the rig to it"; }
std::string drives_axes(const std::vector<std::string>& axes) {
  return fmt::format("the model is driven by the commands of its axes: {}", fmt::join(axes, ", "));
}
std::string nothing_to_explain() { return "without a measured channel there is nothing to explain"; }

std::string unsupported(const std::string& model, Unsupported part) {
  constexpr std::array<std::string_view, kUnsupported> texts{
      "gimbal.vibration: 'explain' does not take a simulated vibration, whose phase in a record is unknown. Remove it. Give "
      "the measured vibration as a channel, or declare [gimbal.friction] with law = \"vibrated_lugre\"",
      "sensors.piston.lag: 'explain' does not simulate the pistons' potentiometers. Remove it, and declare a lag that the "
      "records have as [effects.sensor_lag] with channel = \"piston\"",
      "strings.lag: 'explain' does not simulate the strings' potentiometers. Remove it, and declare a lag that the records "
      "have as [effects.sensor_lag] with channel = \"engine\"",
      "tolerance of actuator.moment_arm: has no meaning with [attach], which determines the arms. Remove it, or remove "
      "[attach]"};
  return fmt::format("{}: {}", model, texts[static_cast<std::size_t>(part)]);
}

std::string axis_not_measured(const std::string& record, const std::string& axis) {
  return fmt::format(
      "{}: there is no measured channel of the {} axis, which other records have. Add piston.{} or engine.{}, or explain "
      "this record in a run of its own",
      record, axis, axis, axis);
}

}  // namespace hotfire::explain::words
