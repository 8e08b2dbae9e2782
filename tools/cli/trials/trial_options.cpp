// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/trials/trial_options.hpp"
#include "tools/cli/shared/any_record.hpp"

#include <filesystem>

#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire {

void add_trial_options(CLI::App& command, TrialOptions& options) {
  command.add_option("--model", options.model, "run the test on this model (.toml)");
  command.add_option("--record", options.record, "analyse this record (.csv) instead of running a model");
  command.add_option("--axis", options.axis,
                     "axis to test, if a record or model has several: pitch, yaw2 ...; channel names end with it");
  command.add_option("--output", options.output, "write the record of the test (.csv)");
  command.add_option("--picture", options.picture, "draw the result (.svg)");
  command.add_option("--thrust", options.thrust, "thrust of every engine [N], instead of that of the model; 0: ambient");
  command.add_flag("--json", options.json, "print the result as JSON");
}

Record record_of_trial(const TrialOptions& options, const std::function<Record()>& run) {
  if (options.model.empty() == options.record.empty()) {
    throw UsageError("give either --model, to run the test on it, or --record, to analyse a test that was recorded");
  }
  return recorded_or_run(options, run);
}

Record recorded_or_run(const TrialOptions& options, const std::function<Record()>& run) {
  Record record = options.record.empty() ? run() : load_any_record(options.record);
  if (!options.output.empty()) {
    write_record(record, options.output);
  }
  return record;
}

std::string name_of_trial(const TrialOptions& options) {
  return std::filesystem::path(options.record.empty() ? options.model : options.record).filename();
}

std::optional<VehicleFile> vehicle_of_trial(const TrialOptions& options) {
  if (!is_vehicle(options.model)) {
    if (options.thrust) {
      throw UsageError("--thrust: a model of one axis has no bearing; allowed with topology \"taos\" or \"masv\"");
    }
    return {};
  }
  if (options.axis.empty()) {
    throw UsageError("the model has several axes; --axis selects one: pitch or yaw, or pitch1, yaw1 ... of several engines");
  }
  VehicleFile vehicle = load_vehicle(options.model);
  return options.thrust ? with_thrust(std::move(vehicle), *options.thrust) : vehicle;
}

Record simulate_command(const TrialOptions& options, std::vector<double> command, double torque) {
  const std::optional<VehicleFile> vehicle = vehicle_of_trial(options);
  Record inputs = trials::command_record(std::move(command), trials::channel_of("command", options.axis));
  if (torque != 0.0) {
    inputs.channels.push_back({trials::channel_of("torque", options.axis), "N.m", std::vector<double>(inputs.rows, torque)});
  }
  return vehicle ? simulate(*vehicle, inputs) : simulate(load_model(options.model), inputs);
}

double moment_arm_of_trial(const TrialOptions& options) {
  return is_vehicle(options.model) ? moment_arm_of(load_vehicle(options.model), options.axis)
                                   : moment_arm_of(load_model(options.model));
}

void draw_if_wanted(const TrialOptions& options, const std::function<analysis::Chart()>& draw) {
  if (!options.picture.empty()) {
    trials::write_picture(draw(), options.picture);
  }
}

}  // namespace hotfire
