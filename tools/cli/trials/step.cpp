// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/step_response.hpp"

#include <fmt/format.h>

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
#include "tools/trials/sweep.hpp"

namespace hotfire {

namespace {

struct StepOptions {
  TrialOptions trial;
  std::vector<double> amplitudes{0.6, 0.4, 0.2};  ///< [deg]
  double hold = 2.0;                              ///< [s]
};

void print(const std::string& channel, const std::vector<analysis::StepResponse>& steps, double period) {
  for (const analysis::StepResponse& step : steps) {
    std::cout << fmt::format(
        "{} at {:.3f} s, {:+.2f} to {:+.2f} deg: rise {:.3f} s, overshoot {:.1f} %, settles in {:.3f} s, hesitates {:.3f} "
        "s\n",
        channel, static_cast<double>(step.row) * period, trials::degrees(step.from), trials::degrees(step.to),
        step.rise_time, 100.0 * step.overshoot, step.settling_time, step.hesitation);
  }
}

void run_steps(const StepOptions& options) {
  const Record record = record_of_trial(options.trial, [&] {
    std::vector<double> amplitudes;
    amplitudes.reserve(options.amplitudes.size());
    for (const double amplitude : options.amplitudes) {
      amplitudes.push_back(trials::radians(amplitude));
    }
    return simulate_command(options.trial, trials::steps(amplitudes, options.hold));
  });
  const Channel& command = trials::required_channel(record, "command", options.trial.axis);
  nlohmann::ordered_json json;
  for (const std::string name : {"piston", "engine"}) {
    const Channel* channel = record.find(trials::channel_of(name, options.trial.axis));
    if (channel == nullptr) {
      continue;
    }
    const auto steps = analysis::step_responses(command.values, channel->values, record.period, 0.5 * options.hold);
    if (steps.empty()) {
      throw FileError(fmt::format("{}: its command has no step that is held for {:g} s; --hold sets the length of the steps",
                                  record.path.string(), 0.5 * options.hold));
    }
    if (options.trial.json) {
      json[name] = trials::to_json(steps, record.period);
    } else {
      print(name, steps, record.period);
    }
  }
  draw_if_wanted(options.trial, [&] { return trials::time_chart("Steps", record, options.trial.axis); });
  if (options.trial.json) {
    print_json(json);
  }
}

}  // namespace

void add_step(CLI::App& program) {
  const auto options = std::make_shared<StepOptions>();
  CLI::App* command = program.add_subcommand(
      "step", "Measure rise, overshoot, settling and hesitation of piston and engine after steps of the command");
  add_trial_options(*command, options->trial);
  command->add_option("--amplitudes", options->amplitudes, "step amplitudes, each to both sides and back to zero [deg]")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--hold", options->hold, "duration of each step [s]; in a record, steps of at least half of it count")
      ->check(CLI::Range(0.05, 100.0))
      ->capture_default_str();
  command->footer("Example: hotfire step --model core-stage.toml --axis pitch --amplitudes 0.6,0.4,0.2 --picture steps.svg");
  command->callback([options] { run_steps(*options); });
}

}  // namespace hotfire
