// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/frequencies.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/library/declared_plant.hpp"
#include "tools/loop/flight.hpp"
#include "tools/loop/loop_report.hpp"
#include "tools/loop/vehicle_loop.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire {

namespace {

struct LoopOptions {
  std::string model;
  std::string controller;
  std::string picture;
  std::optional<double> thrust;
  std::vector<double> amplitudes;  ///< [deg]
  std::vector<double> attitudes;   ///< [deg]
  double seconds = 120.0;
  Frequencies frequencies{0.05, 10.0, 40};
  bool no_check = false;
  bool json = false;
};

/// What the loop is made of.
struct Parts {
  loop::Controller controller;
  DeclaredPlant declared;
  std::optional<loop::Stage> stage;
  std::unique_ptr<linear::Plant> plant;
};

Parts open(const LoopOptions& options) {
  Parts parts;
  parts.controller = loop::load_controller(options.controller);
  const bool several = is_vehicle(options.model);
  VehicleFile vehicle = several ? load_vehicle(options.model) : VehicleFile{};
  if (options.thrust && several) {
    vehicle = with_thrust(std::move(vehicle), *options.thrust);
  }
  const auto* masv = several ? std::get_if<MasvParameters>(&vehicle.parameters) : nullptr;
  if (masv == nullptr) {
    throw FileError(fmt::format("{}: no vehicle of four engines; allowed: topology = \"masv\"", options.model));
  }
  if (vehicle.modes_table.empty()) {
    throw FileError(
        fmt::format("{}: no mode table, so the stage has no attitude; remedy: [modes] with table = \"...\"", options.model));
  }
  try {
    parts.stage.emplace(*masv, load_modes(vehicle.modes_table).flight, parts.controller.axis);
  } catch (const UsageError& error) {
    throw FileError(fmt::format("{}: {}", vehicle.modes_table.string(), error.what()));
  }
  parts.declared = declared_plant(vehicle, parts.controller.period, 1);
  try {
    parts.plant = linear::make_plant(parts.declared.parameters, parts.controller.period, {});
  } catch (const UsageError& error) {
    throw FileError(fmt::format("{}: {}", options.model, error.what()));
  }
  return parts;
}

loop::LoopResult result_of(const LoopOptions& options, const Parts& parts) {
  Frequencies below_nyquist = options.frequencies;
  below_nyquist.to = std::min(below_nyquist.to, 0.499 / parts.controller.period);
  const std::vector<double> frequencies = below_nyquist.spaced();
  loop::VehicleLoop loop(*parts.plant, *parts.stage, parts.controller);
  loop::LoopResult result;
  result.controller = parts.controller.name;
  result.axis = parts.controller.axis;
  result.stable = loop.is_stable();
  const auto add = [&](double amplitude, double accuracy, const loop::OpenLoop& open_loop) {
    loop::LoopCurve curve{amplitude, {}, {}};
    for (const double frequency : frequencies) {
      if (const auto own = open_loop(frequency)) {
        curve.points.emplace_back(frequency, *own);
      } else {
        curve.without.push_back(frequency);
      }
    }
    result.curves.push_back(std::move(curve));
    result.margins.push_back({amplitude, loop::margins_of(open_loop, frequencies, accuracy)});
  };
  add(0.0, 1e-12, [&](double frequency) { return std::optional(loop.small_signal(frequency)); });
  std::vector<double> amplitudes = options.amplitudes;
  std::sort(amplitudes.begin(), amplitudes.end());
  constexpr double kAccuracy = 1e-4;  // of a frequency: as a balance is
  for (const double amplitude : amplitudes) {
    add(trials::radians(amplitude), kAccuracy,
        [&](double frequency) { return loop.described(frequency, trials::radians(amplitude)); });
  }
  const auto end_of = [&](const loop::FlightPlan& plan) {
    constexpr double kFloor = 1e-6;  // rad of command: a fiftieth of what a potentiometer of an actuator tells apart
    const auto record = loop::fly(parts.declared.parameters, *parts.stage, parts.controller, plan);
    return record.ran_away ? loop::Oscillation{loop::Outcome::grows}
                           : loop::oscillation_of(record.command, parts.controller.period, kFloor);
  };
  loop::CycleFlight from_cycle;
  if (!options.no_check && !parts.controller.is_measured()) {
    from_cycle = [&](const loop::LimitCycle& cycle) { return end_of({0.0, loop::kCheckedCycles / cycle.frequency, cycle}); };
  }
  result.predicted = loop::checked(
      loop::predicted_limit_cycles([&](double f, double a) { return loop.described(f, a); }, result.margins), from_cycle);
  for (const double attitude : options.attitudes) {
    result.flown.push_back({trials::radians(attitude), end_of({trials::radians(attitude), options.seconds, {}})});
  }
  return result;
}

void run_loop(const LoopOptions& options) {
  const Parts parts = open(options);
  const loop::LoopResult result = result_of(options, parts);
  if (!options.picture.empty()) {
    trials::write_picture(loop::bode_chart(result), options.picture);
  }
  if (options.json) {
    print_json(loop::to_json(result));
  } else {
    std::cout << loop::text_of(result);
  }
}

}  // namespace

void add_loop(CLI::App& program) {
  const auto options = std::make_shared<LoopOptions>();
  CLI::App* command = program.add_subcommand(
      "loop", "Analyse a flight-control loop around a stage of four engines: margins by amplitude, limit cycles");
  command->add_option("MODEL", options->model, "model file (.toml): masv with a mode table that has rigid-body modes")
      ->required();
  command->add_option("--controller", options->controller, "file of the controller (.toml)")->required();
  command->add_option("--thrust", options->thrust, "thrust of every engine [N], instead of that of the model");
  command
      ->add_option("--amplitudes", options->amplitudes,
                   "amplitudes of the command [deg]: margins and limit cycles by describing functions; left out: small "
                   "deviations alone")
      ->delimiter(',')
      ->check(CLI::Range(1e-6, 90.0));
  command
      ->add_option("--attitudes", options->attitudes,
                   "attitudes at the start of simulations of the closed loop [deg]; left out: no simulation")
      ->delimiter(',')
      ->check(CLI::Range(1e-6, 90.0));
  command->add_flag("--no-check", options->no_check,
                    "list limit cycles as they are predicted, without the simulation that starts on each stable one");
  command->add_option("--seconds", options->seconds, "length of a simulation [s]")
      ->check(CLI::Range(1.0, 1e5))
      ->capture_default_str();
  add_frequencies(*command, options->frequencies, "the responses", {1e-3, 200.0, 10'000});
  command->add_option("--picture", options->picture, "draw the open loop (.svg)");
  command->add_flag("--json", options->json, "print margins, limit cycles and responses as JSON");
  command->footer(
      "Example: hotfire loop stage.toml --controller pitch.toml --amplitudes 0.05,0.1,0.2,0.4,0.8 --attitudes 0.1,2\n"
      "The loop is cut at the command. Frequencies end at half of the sampling rate. A gain margin above 0 dB is the "
      "allowed "
      "rise of the gain, one below 0 dB the allowed fall.");
  command->callback([options] { run_loop(*options); });
}

}  // namespace hotfire
