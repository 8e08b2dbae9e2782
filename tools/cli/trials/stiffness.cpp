// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/cli/trials/trial_options.hpp"
#include "tools/files/text/error.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/results_json.hpp"

namespace hotfire {

namespace {

struct StiffnessOptions {
  TrialOptions trial;
  std::vector<double> amplitudes{0.02, 0.05, 0.1, 0.2, 0.4};  ///< [deg]
  double from = 0.0;                                          ///< [Hz]; 0: by the model
  double to = 0.0;
  int count = 60;
  double bias = 0.0;  ///< load of the actuator that the sines swing about [N]
};

trials::LoadSpring spring_of_trial(const TrialOptions& options) {
  const std::optional<VehicleFile> vehicle = vehicle_of_trial(options);
  return vehicle ? trials::load_spring_of(*vehicle, options.axis) : trials::load_spring_of(load_model(options.model));
}

/// The band of sines and notch. Where the user leaves an end to the model, it is a third and a quarter beyond what the model
/// can expect, from no load to a large one.
trials::SweepGoal goal_of(const StiffnessOptions& options, const trials::LoadSpring& spring) {
  trials::SweepGoal goal{.axis = options.trial.axis, .moment_arm = spring.load.moment_arm};
  goal.lowest = options.from > 0.0 ? options.from : 0.75 * trials::expected_stiffness(spring, 0.0, options.bias).frequency;
  goal.highest = options.to > 0.0 ? options.to : 1.35 * trials::asymptote(spring);
  if (goal.lowest >= goal.highest) {
    throw UsageError(
        fmt::format("--from {:.3g} --to {:.3g}: no band; allowed: --from below --to", goal.lowest, goal.highest));
  }
  return goal;
}

/// Throws FileError for a record that no stiffness can be read from, and says the remedy.
std::vector<trials::SineStiffness> stiffnesses_of(const Record& record, const std::string& name,
                                                  const trials::SweepGoal& goal, const trials::LoadSpring& spring,
                                                  double bias) {
  trials::required_channel(record, "piston", goal.axis);
  auto stiffnesses = trials::sine_stiffnesses(trials::analyse_sweep(record, goal), spring, bias);
  if (stiffnesses.empty()) {
    throw FileError(fmt::format(
        "{}: {} is not a stepped sine, and an equivalent stiffness is that of one amplitude; allowed: sines of three "
        "periods or more for most of the record, as 'hotfire sweep --profile sines' has them",
        name, trials::channel_of("command", goal.axis)));
  }
  if (std::none_of(stiffnesses.begin(), stiffnesses.end(), [](const auto& own) { return own.test.has_value(); })) {
    throw FileError(fmt::format(
        "{}: {} has no notch from {:.3g} to {:.3g} Hz at any amplitude; --from and --to set the band of the load resonance",
        name, trials::channel_of("piston", goal.axis), goal.lowest, goal.highest));
  }
  return stiffnesses;
}

std::string actuator_text(double stiffness) {
  return std::isfinite(stiffness) ? fmt::format("actuator {:.3g} N/m", stiffness)
                                  : std::string("actuator unknown: the model's load stiffness alone is softer");
}

void print(const std::vector<trials::SineStiffness>& stiffnesses, const trials::LoadSpring& spring) {
  for (const trials::SineStiffness& own : stiffnesses) {
    std::cout << fmt::format("{:.3g} deg: ", trials::degrees(own.amplitude));
    if (own.test) {
      std::cout << fmt::format("notch {:.2f} Hz, peak force {:.3g} N, total {:.3g} N/m, {}", own.test->frequency,
                               own.test->peak_force, own.test->total, actuator_text(own.test->actuator));
    } else {
      std::cout << "no notch";
    }
    std::cout << fmt::format("; eq. 4-7: {:.2f} Hz, {}\n", own.expected.frequency, actuator_text(own.expected.actuator));
  }
  std::cout << fmt::format("asymptote: {:.2f} Hz, {}\n", trials::asymptote(spring), actuator_text(spring.loaded));
}

void run_stiffness(const StiffnessOptions& options) {
  const trials::LoadSpring spring = spring_of_trial(options.trial);
  const trials::SweepGoal goal = goal_of(options, spring);
  const Record record = recorded_or_run(options.trial, [&] {
    std::vector<trials::SineBand> bands;
    bands.reserve(options.amplitudes.size());
    for (const double amplitude : options.amplitudes) {
      bands.push_back({trials::radians(amplitude), trials::spaced(goal.lowest, goal.highest, options.count)});
    }
    return simulate_command(options.trial, trials::stepped_sines(bands), options.bias * spring.load.moment_arm);
  });
  const std::vector<trials::SineStiffness> stiffnesses =
      stiffnesses_of(record, name_of_trial(options.trial), goal, spring, options.bias);
  draw_if_wanted(options.trial, [&] {
    return trials::stiffness_chart(fmt::format("Equivalent stiffness of {}", name_of_trial(options.trial)), stiffnesses,
                                   spring, options.bias);
  });
  if (options.trial.json) {
    nlohmann::ordered_json json = trials::to_json(stiffnesses, spring);
    json["bias"] = options.bias;
    print_json(json);
  } else {
    print(stiffnesses, spring);
  }
}

}  // namespace

void add_stiffness(CLI::App& program) {
  const auto options = std::make_shared<StiffnessOptions>();
  CLI::App* command = program.add_subcommand(
      "stiffness",
      "Determine equivalent stiffness and load resonance by amplitude, from the piston's notch and from the force curve");
  add_trial_options(*command, options->trial);
  command->get_option("--model")->required()->description(
      "model file (.toml) with inertia, arm and springs; without --record the test is run on it");
  command->get_option("--record")->description("analyse this record (.csv) of stepped sines instead of running the model");
  command->add_option("--amplitudes", options->amplitudes, "amplitudes of the sines [deg], one sweep each")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--from", options->from,
                   "lowest frequency of the sines, and lower end of the search for the notch [Hz]; default: from the model")
      ->check(CLI::Range(0.01, 200.0));
  command
      ->add_option("--to", options->to,
                   "highest frequency of the sines, and upper end of the search for the notch [Hz]; default: from the model")
      ->check(CLI::Range(0.01, 200.0));
  command->add_option("--count", options->count, "number of frequencies of a sweep")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  command
      ->add_option("--bias", options->bias,
                   "constant load of the actuator [N], about which the sines swing; a test on a model runs under the torque "
                   "of this load")
      ->capture_default_str();
  command->footer(
      "Example: hotfire stiffness --model lab.toml --picture stiffness.svg\n         hotfire stiffness --model lab.toml "
      "--record sines.csv --axis pitch\n         hotfire stiffness --model lab.toml --bias 20000\nThe notch is at the load "
      "resonance, which gives the total stiffness. Without the model's load stiffness, this is the stiffness of the "
      "actuator. The next column is the value of the model's force curve at that amplitude.");
  command->callback([options] { run_stiffness(*options); });
}

}  // namespace hotfire
