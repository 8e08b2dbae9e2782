// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tools/cli/shared/any_record.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/string_angles.hpp"

namespace hotfire {

namespace {

struct StringOptions {
  std::string settled;
  std::string record;
  std::string output;
  std::string picture;
  std::string engine;
  double hold = 2.0;
  bool json = false;
};

analysis::AngleCalibration calibration_of(const StringOptions& options, std::size_t& poses) {
  const auto settled = trials::settled_poses(load_any_record(options.settled), options.engine, options.hold);
  poses = settled.size();
  try {
    return analysis::AngleCalibration(settled);
  } catch (const std::invalid_argument& problem) {
    throw FileError(fmt::format("{}: {} poses are held for {:g} s; {}; --hold sets the time for which a pose is held",
                                options.settled, poses, options.hold, problem.what()));
  }
}

/// An angle in thousandths of a degree.
double millidegrees(double angle) { return 1e3 * trials::degrees(angle); }

void run_strings(const StringOptions& options) {
  std::size_t poses = 0;
  const analysis::AngleCalibration calibration = calibration_of(options, poses);
  const trials::StringAngles angles = trials::string_angles(load_any_record(options.record), calibration, options.engine);
  write_record(angles.record, options.output);
  if (!options.picture.empty()) {
    analysis::Chart chart = trials::time_chart("Engine by its strings, pitch", angles.record, "pitch" + options.engine);
    const analysis::Chart yaw = trials::time_chart("", angles.record, "yaw" + options.engine);
    chart.panels.resize(1);
    chart.panels.front().ordinate = "pitch [deg]";
    chart.panels.push_back(yaw.panels.front());
    chart.panels.back().ordinate = "yaw [deg]";
    trials::write_picture(chart, options.picture);
  }
  if (options.json) {
    const auto known = [&](double rms) { return angles.known ? nlohmann::json(rms) : nlohmann::json(nullptr); };
    const nlohmann::ordered_json result{{"output", options.output},
                                        {"poses", poses},
                                        {"residual_rad", calibration.residual()},
                                        {"pitch_error_rad", known(angles.pitch)},
                                        {"yaw_error_rad", known(angles.yaw)}};
    print_json(result);
    return;
  }
  std::cout << fmt::format("{}: calibrated on {} settled poses, which the fit leaves {:.3g} mdeg rms", options.output, poses,
                           millidegrees(calibration.residual()));
  if (angles.known) {
    std::cout << fmt::format("; from the record's own angles: pitch {:.3g}, yaw {:.3g} mdeg rms", millidegrees(angles.pitch),
                             millidegrees(angles.yaw));
  }
  std::cout << '\n';
}

}  // namespace

void add_strings(CLI::App& program) {
  const auto options = std::make_shared<StringOptions>();
  CLI::App* command = program.add_subcommand(
      "strings", "Compute engine angles from four string potentiometers, calibrated on settled poses");
  command
      ->add_option("--settled", options->settled,
                   "record (.csv) with string1 .. string4 in which the commands of both angles are held at several poses")
      ->required();
  command
      ->add_option("--record", options->record, "record (.csv) with string1 .. string4, from which the angles are computed")
      ->required();
  command
      ->add_option("--output", options->output,
                   "record to write (.csv): the one of --record, with engine.pitch and engine.yaw from its strings")
      ->required();
  command->add_option("--engine", options->engine, "number of the engine, if a record has several engines")
      ->check(CLI::Range(1, 9));
  command->add_option("--hold", options->hold, "shortest duration of a pose [s]; its last quarter is used")
      ->check(CLI::Range(0.1, 1e4))
      ->capture_default_str();
  command->add_option("--picture", options->picture, "draw the angles (.svg)");
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Example: hotfire strings --settled poses.csv --record sweep.csv --output angles.csv --picture angles.svg");
  command->callback([options] { run_strings(*options); });
}

}  // namespace hotfire
