// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/analysis/free_decay.hpp"
#include "tools/analysis/welch.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/cli/trials/trial_options.hpp"
#include "tools/files/text/error.hpp"
#include "tools/trials/disturbed.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire {

namespace {

/// The record that is given, or that of `run` on the model that is given: of a model and, with several axes, the name of
/// one.
template <class Run>
Record record_of_disturbed(const TrialOptions& trial, Run&& run) {
  return record_of_trial(trial, [&] {
    const std::optional<VehicleFile> vehicle = vehicle_of_trial(trial);
    return vehicle ? run(*vehicle, trial.axis) : run(load_model(trial.model));
  });
}

struct HammerOptions {
  TrialOptions trial;
  trials::Hammer blow;
};

void run_hammer(const HammerOptions& options) {
  const Record record = record_of_disturbed(
      options.trial, [&](const auto& model, const auto&... axis) { return trials::hammer(model, axis..., options.blow); });
  const std::string name = record.find("position") != nullptr ? "position" : "engine";
  const Channel& channel = trials::required_channel(record, name, options.trial.axis);
  // A simulated blow hits an engine at rest; a recorded one is about zero already.
  const auto decay =
      analysis::free_decay(options.trial.record.empty() ? trials::swing(record, channel.name) : channel.values,
                           record.period, options.blow.seconds);
  if (!decay) {
    throw FileError(fmt::format("{}: {} does not ring for three cycles in {:g} s", record.path.string(), channel.name,
                                options.blow.seconds));
  }
  draw_if_wanted(options.trial, [&] { return trials::time_chart("Hammer test", record, options.trial.axis); });
  if (options.trial.json) {
    const nlohmann::ordered_json json{
        {"hertz", decay->frequency}, {"damping_ratio", decay->damping_ratio}, {"cycles", decay->cycles}};
    print_json(json);
  } else {
    std::cout << fmt::format("{}: {:.3f} Hz, damping ratio {:.4f}, over {} cycles\n", channel.name, decay->frequency,
                             decay->damping_ratio, decay->cycles);
  }
}

struct QuiescentOptions {
  TrialOptions trial;
  trials::Quiescence ambient;
  double segment = 16.0;
  double lowest = 3.0;
  double highest = 12.0;
};

void run_quiescent(const QuiescentOptions& options) {
  const Record record = record_of_disturbed(options.trial, [&](const auto& model, const auto&... axis) {
    return trials::quiescent(model, axis..., options.ambient);
  });
  const Channel& piston = trials::required_channel(record, "piston", options.trial.axis);
  const auto rows = static_cast<std::size_t>(std::lround(options.segment / record.period));
  if (rows < 8 || rows > record.rows) {
    throw FileError(fmt::format("{}: shorter than a segment of {:g} s", record.path.string(), options.segment));
  }
  const analysis::Spectrum spectrum = analysis::welch_spectrum(piston.values, record.period, {rows});
  const auto peak = analysis::find_peak(spectrum, options.lowest, options.highest);
  draw_if_wanted(options.trial, [&] {
    return trials::spectrum_chart("Quiescent piston", {piston.name}, {spectrum}, options.lowest, options.highest);
  });
  if (options.trial.json) {
    const nlohmann::ordered_json json{{"peak_hertz", peak ? nlohmann::json(peak->frequency) : nlohmann::json(nullptr)}};
    print_json(json);
  } else if (peak) {
    std::cout << fmt::format("{}: largest peak at {:.2f} Hz\n", piston.name, peak->frequency);
  } else {
    std::cout << fmt::format("{}: no peak from {:g} to {:g} Hz\n", piston.name, options.lowest, options.highest);
  }
}

}  // namespace

void add_hammer(CLI::App& program) {
  const auto options = std::make_shared<HammerOptions>();
  CLI::App* command = program.add_subcommand(
      "hammer", "Run an impact hammer test with the actuator locked: frequency and damping ratio of the free oscillation");
  add_trial_options(*command, options->trial);
  command->add_option("--impulse", options->blow.impulse, "angular momentum of the blow [N.m.s]")->capture_default_str();
  command->add_option("--seconds", options->blow.seconds, "length of the decay that is analysed [s]")
      ->check(CLI::Range(0.05, 1000.0))
      ->capture_default_str();
  command->footer(
      "Example: hotfire hammer --model core-stage.toml --thrust 0 --axis pitch --impulse 168 --seconds 1 --picture "
      "decay.svg");
  command->callback([options] { run_hammer(*options); });
}

void add_quiescent(CLI::App& program) {
  const auto options = std::make_shared<QuiescentOptions>();
  CLI::App* command = program.add_subcommand(
      "quiescent", "Measure the spectrum of the piston under random torque, with the actuator powered and uncommanded");
  add_trial_options(*command, options->trial);
  command
      ->add_option("--torque-density", options->ambient.torque_density,
                   "one-sided power spectral density of the random torque on the engine [(N.m)^2/Hz]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options->ambient.seconds, "length of the test [s]")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command->add_option("--seed", options->ambient.seed, "seed of the random torque")->capture_default_str();
  command->add_option("--segment", options->segment, "segment length of Welch's method [s]")->capture_default_str();
  command->add_option("--lowest", options->lowest, "lower end of the search for the peak [Hz]")->capture_default_str();
  command->add_option("--highest", options->highest, "upper end of the search for the peak [Hz]")->capture_default_str();
  command->footer(
      "Example: hotfire quiescent --model core-stage.toml --thrust 0 --axis pitch --torque-density 1e4 --picture "
      "spectrum.svg");
  command->callback([options] { run_quiescent(*options); });
}

}  // namespace hotfire
