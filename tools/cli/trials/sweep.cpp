// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/frequencies.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/cli/trials/trial_options.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/fine_sweep.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/results_json.hpp"

namespace hotfire {

namespace {

struct SweepOptions {
  TrialOptions trial;
  std::string profile = "green-run";
  std::vector<double> amplitudes{0.4};  ///< [deg]
  Frequencies frequencies{0.4, 14.0, 40};
  bool coarse = false;
  double moment_arm = 0.0;
  trials::SweepGoal goal;
};

std::vector<trials::SineBand> bands_of(const SweepOptions& options) {
  std::vector<trials::SineBand> bands;
  bands.reserve(options.amplitudes.size());
  for (const double amplitude : options.amplitudes) {
    bands.push_back({trials::radians(amplitude), options.frequencies.spaced()});
  }
  return bands;
}

std::vector<double> command_of(const SweepOptions& options) {
  if (options.profile == "green-run") {
    return trials::stepped_sines(trials::green_run_sines(options.trial.axis.starts_with("yaw")));
  }
  if (options.profile == "multisine") {
    options.frequencies.require_band();
    return trials::multisine(trials::radians(options.amplitudes.front()), options.frequencies.from, options.frequencies.to,
                             options.goal.segment, 8, 1);
  }
  return trials::stepped_sines(bands_of(options));
}

/// A sweep by sines that are held until they have settled, and once more with a fine grid around the notches that it found.
Record simulate_finely(const SweepOptions& options) {
  trials::SweepGoal goal = options.goal;
  goal.moment_arm = moment_arm_of_trial(options.trial);
  const std::optional<VehicleFile> vehicle = vehicle_of_trial(options.trial);
  const trials::LeastDwell dwell = vehicle
                                       ? trials::settled_dwell(*vehicle, options.frequencies.from, options.frequencies.to)
                                       : trials::settled_dwell(load_model(options.trial.model));
  const std::vector<trials::SineBand> bands = bands_of(options);
  const Record coarse = simulate_command(options.trial, trials::stepped_sines(bands, dwell));
  return simulate_command(options.trial, trials::fine_sines(bands, trials::analyse_sweep(coarse, goal), dwell));
}

Record simulate_both(const TrialOptions& options) {
  const std::optional<VehicleFile> vehicle = vehicle_of_trial(options);
  if (!vehicle || !std::holds_alternative<TaosParameters>(vehicle->parameters)) {
    throw UsageError("--profile green-run-both drives the two axes of one engine; allowed with topology \"taos\"");
  }
  return simulate(*vehicle, trials::green_run_record());
}

void print(const std::vector<trials::ChannelSweep>& sweeps) {
  for (const trials::ChannelSweep& sweep : sweeps) {
    const std::string amplitude =
        sweep.amplitude > 0.0 ? fmt::format("{:.3g} deg", trials::degrees(sweep.amplitude)) : std::string("broadband");
    std::cout << fmt::format("{} at {}: {} frequencies from {:.3g} to {:.3g} Hz", sweep.channel, amplitude,
                             sweep.response.size(), sweep.response.front().frequency, sweep.response.back().frequency);
    if (sweep.notch) {
      std::cout << fmt::format(", notch {:.2f} Hz, {:.1f} dB under its upper shoulder", sweep.notch->frequency,
                               sweep.notch->depth);
    }
    if (sweep.peak) {
      std::cout << fmt::format(", peak {:.2f} Hz, {:+.1f} dB", sweep.peak->frequency, sweep.peak->gain);
    }
    std::cout << '\n';
  }
}

void run_sweep(SweepOptions& options) {
  options.goal.axis = options.trial.axis;
  options.goal.moment_arm = options.moment_arm > 0.0 ? options.moment_arm : 1.0;
  const Record record = record_of_trial(options.trial, [&] {
    Record run = options.profile == "green-run-both"             ? simulate_both(options.trial)
                 : options.profile == "sines" && !options.coarse ? simulate_finely(options)
                                                                 : simulate_command(options.trial, command_of(options));
    if (options.moment_arm == 0.0) {
      options.goal.moment_arm = moment_arm_of_trial(options.trial);
    }
    return run;
  });
  const std::vector<trials::ChannelSweep> sweeps = trials::analyse_sweep(record, options.goal);
  draw_if_wanted(options.trial,
                 [&] { return trials::bode_chart(fmt::format("Sweep of {}", name_of_trial(options.trial)), sweeps); });
  if (options.trial.json) {
    print_json(trials::to_json(sweeps));
  } else {
    print(sweeps);
  }
}

}  // namespace

void add_sweep(CLI::App& program) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* command = program.add_subcommand("sweep", "Measure the frequency response of piston and engine to the command");
  add_trial_options(*command, options->trial);
  command
      ->add_option("--profile", options->profile,
                   "command: green-run (7 to 14 Hz at 0.8 deg, 0.4 to 6.25 Hz at 0.4 deg), green-run-both (both axes at "
                   "once, one in the upper band and one in the lower, then exchanged), sines, or multisine")
      ->check(CLI::IsMember({"green-run", "green-run-both", "sines", "multisine"}))
      ->capture_default_str();
  command->add_option("--amplitudes", options->amplitudes, "amplitude of each stepped sine, or peak of the multisine [deg]")
      ->delimiter(',')
      ->capture_default_str();
  add_frequencies(*command, options->frequencies, "sines and multisine", {0.01, 200.0, 1000});
  command->add_flag(
      "--coarse", options->coarse,
      "sines: these frequencies alone, each held for 2 s; without it they are held until the modes settle, with "
      "a fine grid around the notch");
  command->add_option("--lowest", options->goal.lowest, "lower end of the search for notch and peak [Hz]")
      ->capture_default_str();
  command->add_option("--highest", options->goal.highest, "upper end of the search for notch and peak [Hz]")
      ->capture_default_str();
  command->add_option("--segment", options->goal.segment, "segment length of Welch's method [s]")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--moment-arm", options->moment_arm,
                      "moment arm that normalises the piston gain [m]; default: that of the model, 1 for a record");
  command->footer(
      "Example: hotfire sweep --model lab.toml --profile sines --amplitudes 0.05,0.1,0.2,0.4 --from 4 --to 13 --picture "
      "bode.svg\n"
      "A record is analysed sine by sine where its command is a stepped sine, by Welch's method otherwise.");
  command->callback([options] { run_sweep(*options); });
}

}  // namespace hotfire
