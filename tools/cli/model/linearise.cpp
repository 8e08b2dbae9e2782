// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/frequencies.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/library/declared_plant.hpp"
#include "tools/linear/linear_model.hpp"
#include "tools/linear/write_model.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/results_json.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire {

namespace {

using Json = nlohmann::ordered_json;

struct LineariseOptions {
  std::string model;
  std::string axis;
  std::string output;
  std::string picture;
  double angle = 0.0;  ///< [deg]
  double load = 0.0;   ///< [N m]
  std::optional<double> thrust;
  std::vector<double> amplitudes;  ///< [deg]
  double frequency = 1.0;          ///< of the quasi-linear model [Hz]
  double period = 1e-3;            ///< [s]
  Frequencies frequencies{0.4, 14.0, 60};
  bool json = false;
};

/// The plant that is linearised, and which of its axes the responses are of.
struct Linearised {
  std::unique_ptr<linear::Plant> plant;
  int axis = 0;
};

Linearised open(const LineariseOptions& options) {
  DeclaredPlant declared;
  Linearised opened;
  std::size_t axes = 1;
  if (is_vehicle(options.model)) {
    VehicleFile vehicle = load_vehicle(options.model);
    if (options.thrust) {
      vehicle = with_thrust(std::move(vehicle), *options.thrust);
    }
    axes = vehicle.axes.size();
    opened.axis = options.axis.empty() ? 0 : static_cast<int>(axis_index(vehicle, options.axis));
    declared = declared_plant(vehicle, options.period, 1);
  } else {
    if (!options.axis.empty() || options.thrust) {
      throw UsageError("--axis and --thrust are for several axes; allowed with topology \"taos\" or \"masv\"");
    }
    declared = declared_plant(options.model, options.period, 1);
  }
  linear::OperatingPoint point;
  point.commands.assign(axes, 0.0);
  point.loads.assign(axes, 0.0);
  point.commands[static_cast<std::size_t>(opened.axis)] = trials::radians(options.angle);
  point.loads[static_cast<std::size_t>(opened.axis)] = options.load;
  try {
    opened.plant = linear::make_plant(declared.parameters, options.period, point);
  } catch (const UsageError& error) {
    throw FileError(fmt::format("{}: {}", options.model, error.what()));
  }
  return opened;
}

/// The responses of the axis's piston and engine, the piston's as that of x_a / (R beta_c), as a sweep has them.
class Responses {
 public:
  Responses(const linear::Plant& plant, int axis, const std::string& suffix)
      : arm_(plant.moment_arm(axis)), suffix_(suffix) {}

  std::vector<std::string> names() const { return {"piston" + suffix_, "engine" + suffix_}; }

  void add(const std::string& name, double amplitude, analysis::FrequencyResponse response) {
    const bool is_piston = name.starts_with("piston");
    for (analysis::ResponsePoint& point : response) {
      point.gain /= is_piston ? arm_ : 1.0;
    }
    if (!response.empty()) {
      all_.push_back({is_piston ? "piston" : "engine", amplitude, std::move(response), {}, {}});
    }
  }

  const std::vector<trials::ChannelSweep>& all() const { return all_; }

 private:
  double arm_;
  std::string suffix_;
  std::vector<trials::ChannelSweep> all_{};
};

Json to_json(const std::vector<linear::Complex>& poles) {
  Json list = Json::array();
  for (const linear::Complex pole : poles) {
    const double size = std::abs(pole);
    list.push_back({{"real", pole.real()},
                    {"imaginary", pole.imag()},
                    {"hertz", size / (2.0 * std::numbers::pi)},
                    {"damping_ratio", size > 0.0 ? Json(-pole.real() / size) : Json(nullptr)}});
  }
  return list;
}

void print_pole(linear::Complex pole) {
  const double size = std::abs(pole);
  if (pole.imag() == 0.0) {
    std::cout << fmt::format("  real {:.6g} 1/s\n", pole.real());
  } else if (pole.imag() > 0.0) {
    std::cout << fmt::format("  {:.4f} Hz, damping ratio {:.4f}\n", size / (2.0 * std::numbers::pi), -pole.real() / size);
  }
}

void print(const linear::LinearModel& model, const std::vector<double>& without) {
  std::cout << fmt::format("{}: {} states, {} inputs, {} outputs; A and B by {}\npoles:\n", model.topology,
                           model.states.size(), model.inputs.size(), model.outputs.size(),
                           model.by_logarithm ? "the logarithm of the step, exact" : "the bilinear rule");
  for (const linear::Complex pole : linear::poles(model)) {
    print_pole(pole);
  }
  for (const linear::Delay& delay : model.delays) {
    std::cout << fmt::format("delay that is not in the matrices: {}, {:.6g} s\n", delay.name, delay.seconds);
  }
  if (!without.empty()) {
    std::cout << fmt::format("no balance of sines at {:.4g} Hz: left out of the responses\n", fmt::join(without, ", "));
  }
}

/// The model about an amplitude: of its own balance at the chosen frequency.
linear::LinearModel model_about(const LineariseOptions& options, const linear::HarmonicBalance& system, int axis) {
  const auto at = linear::described_response(system, axis, trials::radians(options.amplitudes.front()), options.period,
                                             {options.frequency}, {});
  if (at.balances.empty()) {
    throw FileError(fmt::format(
        "{}: no balance of sines at {:g} Hz and {:g} deg, so there is no model about them; remedy: another amplitude or "
        "--frequency",
        options.model, options.frequency, options.amplitudes.front()));
  }
  return linear::quasi_linear_model(system, options.period, at.balances.front());
}

void linearise(const LineariseOptions& options) {
  if (!options.output.empty() && options.amplitudes.size() > 1) {
    throw UsageError("--output holds one model; give one of --amplitudes, or none for small deviations");
  }
  const std::vector<double> frequencies = options.frequencies.spaced();
  const Linearised opened = open(options);
  const linear::Plant& plant = *opened.plant;
  const std::string command = plant.inputs()[static_cast<std::size_t>(opened.axis)].name;
  Responses responses(plant, opened.axis, command.substr(std::string("command").size()));
  std::vector<double> without;
  linear::LinearModel model;
  if (options.amplitudes.empty()) {
    model = linear::small_signal_model(plant, options.period);
    for (const std::string& name : responses.names()) {
      responses.add(
          name, 0.0,
          linear::response(model, linear::place_of(model.outputs, name, "output"), opened.axis, frequencies, true));
    }
  } else {
    const linear::HarmonicBalance system(plant);
    for (const double amplitude : options.amplitudes) {
      const auto described = linear::described_response(system, opened.axis, trials::radians(amplitude), options.period,
                                                        frequencies, responses.names());
      without.insert(without.end(), described.without.begin(), described.without.end());
      for (const auto& [name, response] : described.outputs) {
        responses.add(name, trials::radians(amplitude), response);
      }
    }
    model = model_about(options, system, opened.axis);
  }
  if (!options.output.empty()) {
    linear::write_model(model, options.output);
  }
  if (!options.picture.empty()) {
    trials::write_picture(
        trials::bode_chart(fmt::format("Linear model of {}", std::filesystem::path(options.model).filename().string()),
                           responses.all()),
        options.picture);
  }
  if (options.json) {
    Json result = linear::to_json(model);
    for (const char* matrix : {"A", "B", "C", "D", "step_A", "step_B"}) {
      result.erase(matrix);
    }
    result["poles"] = to_json(linear::poles(model));
    result["responses"] = trials::to_json(responses.all());
    result["without_balance_hertz"] = without;
    print_json(result);
  } else {
    print(model, without);
  }
}

}  // namespace

void add_linearise(CLI::App& program) {
  const auto options = std::make_shared<LineariseOptions>();
  CLI::App* command = program.add_subcommand(
      "linearise",
      "Compute the linear model A, B, C, D about a load, an angle and an amplitude, with poles and frequency response");
  command->add_option("MODEL", options->model, "model file (.toml): simplex, taos or masv")->required();
  command->add_option("--axis", options->axis,
                      "axis of several that is commanded and loaded: pitch, yaw2 ...; default: the first");
  command->add_option("--angle", options->angle, "commanded angle of the axis at rest [deg]")->capture_default_str();
  command->add_option("--load", options->load, "constant torque on the engine towards positive angles [N.m]")
      ->capture_default_str();
  command->add_option("--thrust", options->thrust, "thrust of every engine [N], instead of that of the model; 0: ambient");
  command
      ->add_option("--amplitudes", options->amplitudes,
                   "amplitudes of a sine command [deg]: the responses by describing functions; left out: small deviations")
      ->delimiter(',')
      ->check(CLI::Range(1e-6, 90.0));
  command
      ->add_option("--frequency", options->frequency,
                   "with an amplitude: frequency at which the model of --output has the laws' equivalent gains [Hz]")
      ->check(CLI::Range(0.01, 200.0))
      ->capture_default_str();
  command->add_option("--period", options->period, "period of the sampled system, over which a command is held [s]")
      ->check(CLI::Range(1e-4, 0.1))
      ->capture_default_str();
  add_frequencies(*command, options->frequencies, "the responses", {0.01, 200.0, 10'000});
  command->add_option("--output", options->output, "write the model (.mat, .json or .csv)");
  command->add_option("--picture", options->picture, "draw the responses (.svg)");
  command->add_flag("--json", options->json, "print names, poles and responses as JSON");
  command->footer(
      "Example: hotfire linearise explained.toml --load 20000 --amplitudes 0.05,0.2,0.8 --picture bode.svg\n"
      "The responses include the hold of the command over a period, as a sweep measures them; A and B do not.");
  command->callback([options] { linearise(*options); });
}

}  // namespace hotfire
