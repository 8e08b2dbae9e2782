// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hal/schedule/frame_time.hpp"
#include "model/keys.hpp"
#include "tools/cli/shared/any_record.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/can/can_schedule.hpp"
#include "tools/files/can/candump.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/model/model_layout.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/record/recording.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/files/text/error.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

namespace {

using Json = nlohmann::ordered_json;

Json describe_model(const std::filesystem::path& path) {
  ModelFile model = load_model(path);
  const ModelLayout layout = layout_of(model);
  std::vector<std::string> effects;
  for (const KeyGroup& effect : layout.effects) {
    if (*effect.active) {
      effects.emplace_back(effect.name);
    }
  }
  std::vector<std::string> toleranced;
  for (const auto& [key, relative] : model.tolerance) {
    toleranced.push_back(key);
  }
  return {{"kind", "model"},    {"name", model.name},       {"topology", layout.topology},
          {"effects", effects}, {"tolerances", toleranced}, {"reference_values", model.left_out}};
}

Json describe_vehicle(const std::filesystem::path& path) {
  const VehicleFile vehicle = load_vehicle(path);
  return std::visit(
      [&vehicle]<class Parameters>(const Parameters& parameters) -> Json {
        const std::vector<std::string> names = axis_names(static_cast<int>(parameters.axes.size()) / 2);
        std::vector<std::string> effects;
        std::size_t toleranced = 0;
        for (std::size_t axis = 0; axis < names.size(); ++axis) {
          model::visit_effects(parameters.axes[axis], [&]<class E>(std::size_t index, const auto&) {
            if (parameters.axes[axis].effects.active[index]) {
              effects.push_back(fmt::format("{}.{}", E::name, names[axis]));
            }
          });
          toleranced += vehicle.axes[axis].tolerance.size();
        }
        return {{"kind", "vehicle"},
                {"name", vehicle.name},
                {"topology", std::is_same_v<Parameters, TaosParameters> ? "taos" : "masv"},
                {"axes", parameters.axes.size()},
                {"modes", parameters.modes.modes},
                {"compliant_gimbal", parameters.gimbals.front().compliant},
                {"effects", effects},
                {"tolerances", toleranced}};
      },
      vehicle.parameters);
}

Json describe_record(const std::filesystem::path& path) {
  const Record record = load_any_record(path);
  Json channels = Json::array();
  for (const Channel& channel : record.channels) {
    channels.push_back({{"name", channel.name}, {"unit", channel.unit}});
  }
  return {
      {"kind", "record"}, {"rows", record.rows}, {"start", record.start}, {"period", record.period}, {"channels", channels}};
}

Json describe_schedule(const std::filesystem::path& path) {
  const CanSchedule schedule = load_can_schedule(path);
  Json frames = Json::array();
  for (const ScheduledFrame& frame : schedule.frames) {
    frames.push_back(
        {{"message", frame.message}, {"period", frame.period}, {"longest", frame.longest}, {"load", frame.load()}});
  }
  return {{"kind", "schedule"},
          {"bit_rate", schedule.bit_rate},
          {"load", schedule.load()},
          {"largest_load", hal::kLargestBusLoad},
          {"frames", frames}};
}

Json describe_profile(const std::filesystem::path& path) {
  const LabProfile profile = load_profile(path);
  return {{"kind", "profile"},
          {"actuators", profile.actuators},
          {"duration", profile.duration},
          {"digest", fmt::format("{:016x}", profile.digest)}};
}

Json describe(const std::filesystem::path& path) {
  if (path.extension() == ".toml" && is_profile(path)) {
    return describe_profile(path);
  }
  if (path.extension() == ".toml") {
    return is_can_schedule(path) ? describe_schedule(path)
           : is_vehicle(path)    ? describe_vehicle(path)
                                 : describe_model(path);
  }
  if (path.extension() == ".csv" || path.extension() == ".log" || is_foreign(path) || is_recording(path)) {
    return describe_record(path);
  }
  throw FileError(
      fmt::format("{}: the extension \"{}\" is unknown; allowed: .toml (a model, a profile or a CAN schedule), .csv "
                  "(a record), .log "
                  "(a candump log), {} (a record of another program), a recording of 'hotfire plant --record'",
                  path.string(), path.extension().string(), fmt::join(foreign_extensions(), ", ")));
}

std::string joined(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::string line_of(const Json& result) {
  if (!result["good"].get<bool>()) {
    return "refused";
  }
  if (result["kind"] == "model") {
    const auto reference = result["reference_values"].get<std::vector<std::string>>();
    return fmt::format("model \"{}\", topology {}, effects: {}, values with a tolerance: {}{}",
                       result["name"].get<std::string>(), result["topology"].get<std::string>(),
                       joined(result["effects"].get<std::vector<std::string>>()), result["tolerances"].size(),
                       reference.empty() ? "" : ", left to their reference values: " + joined(reference));
  }
  if (result["kind"] == "vehicle") {
    return fmt::format("model \"{}\", topology {}, {} axes, {} modes, {} gimbal, effects: {}, values with a tolerance: {}",
                       result["name"].get<std::string>(), result["topology"].get<std::string>(), result["axes"].get<int>(),
                       result["modes"].get<int>(), result["compliant_gimbal"].get<bool>() ? "compliant" : "rigid",
                       joined(result["effects"].get<std::vector<std::string>>()), result["tolerances"].get<std::size_t>());
  }
  if (result["kind"] == "profile") {
    const auto actuators = result["actuators"].get<unsigned>();
    return fmt::format(
        "profile of {} {}, {:g} s long, digest {}; to run it: hotfire lab --profile {} --bus can0 --gpio CHIP "
        "--record run.hfr --confirm {}",
        actuators, actuators == 1 ? "actuator" : "actuators", result["duration"].get<double>(),
        result["digest"].get<std::string>(), result["file"].get<std::string>(), result["digest"].get<std::string>());
  }
  if (result["kind"] == "schedule") {
    return fmt::format("CAN schedule, {} frames, worst-case bus load {:.1f} % of {:g} Mbit/s, allowed {:.0f} %",
                       result["frames"].size(), 100.0 * result["load"].get<double>(),
                       1e-6 * result["bit_rate"].get<double>(), 100.0 * hal::kLargestBusLoad);
  }
  std::vector<std::string> channels;
  for (const Json& channel : result["channels"]) {
    channels.push_back(fmt::format("{}[{}]", channel["name"].get<std::string>(), channel["unit"].get<std::string>()));
  }
  const double period = result["period"].get<double>();
  const auto rows = result["rows"].get<std::size_t>();
  return fmt::format("record, {} rows, period {:.6g} s ({:.6g} Hz), {:.6g} s long, channels: {}", rows, period, 1.0 / period,
                     static_cast<double>(rows - 1) * period, joined(channels));
}

void check(const std::vector<std::string>& files, bool as_json) {
  Json results = Json::array();
  bool all_good = true;
  for (const std::string& file : files) {
    Json result{{"file", file}, {"good", true}};
    try {
      result.update(describe(file));
    } catch (const FileError& error) {
      result["good"] = all_good = false;
      result["error"] = error.what();
      std::cerr << "hotfire: " << error.what() << '\n';
    }
    if (!as_json) {
      std::cout << file << ": " << line_of(result) << std::endl;
    }
    results.push_back(std::move(result));
  }
  if (as_json) {
    print_json(results);
  }
  if (!all_good) {
    throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_data));
  }
}

}  // namespace

void add_check(CLI::App& program) {
  struct Options {
    std::vector<std::string> files;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "check",
      "Check model files, profiles, CAN schedules, records and recordings; print the place and the remedy of each problem");
  command
      ->add_option("FILE", options->files,
                   "model files, profiles and CAN schedules (.toml), records (.csv, candump .log, .mf4, .h5, .mat) and "
                   "recordings (.hfr)")
      ->required();
  command->add_flag("--json", options->json, "print the results as a JSON array");
  command->footer(
      "Example: hotfire check declared.toml steps.csv schedule.toml\nExit status: 0 all files are good, 6 a file is "
      "refused; the others are checked too.");
  command->callback([options] { check(options->files, options->json); });
}

}  // namespace hotfire
