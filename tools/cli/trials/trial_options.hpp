// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/files/record/record.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

/// The options of every test on a model, and of the analysis of a recorded one.
struct TrialOptions {
  std::string model;
  std::string record;
  std::string axis;
  std::string output;
  std::string picture;
  std::optional<double> thrust;  ///< of every engine, in place of the model's [N]
  bool json = false;
};

void add_trial_options(CLI::App& command, TrialOptions& options);

/// The record to analyse: the one that is given, or what `run` makes of the model that is given. It is written where it is
/// wanted. Throws UsageError unless exactly one of the two is given.
Record record_of_trial(const TrialOptions& options, const std::function<Record()>& run);

/// The same where a model may be given beside the record, for what only a model knows: without a record it is run.
Record recorded_or_run(const TrialOptions& options, const std::function<Record()>& run);

/// The file that a test is of, record or model, without folder: what a picture is called.
std::string name_of_trial(const TrialOptions& options);

/// The options' model if it is of several axes, nothing otherwise. Throws UsageError for one and no axis that is named.
std::optional<VehicleFile> vehicle_of_trial(const TrialOptions& options);

/// Runs the model of the options, of one axis or several, on a command to its axis. Throws UsageError for a model of several
/// axes and none that is named. `torque` is a constant one on the engine beside the command [N m].
Record simulate_command(const TrialOptions& options, std::vector<double> command, double torque = 0.0);

/// The moment arm of the model's axis [m].
double moment_arm_of_trial(const TrialOptions& options);

/// Writes the picture if one is wanted; `draw` is called only then.
void draw_if_wanted(const TrialOptions& options, const std::function<analysis::Chart()>& draw);

}  // namespace hotfire
