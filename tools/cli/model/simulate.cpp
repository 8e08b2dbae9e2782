// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulate.hpp"

#include <fmt/format.h>

#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/shared/any_record.hpp"
#include "tools/cli/shared/candump_options.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

namespace hotfire {

namespace {

struct SimulateOptions {
  std::string model;
  std::string input;
  std::string output;
  std::size_t fit_start = 0;
  unsigned seed = 1;
  bool json = false;
  CandumpOptions candump;
};

/// Reads the model, of one axis or several, and says how it is run.
std::function<Record(const Record&)> simulation_of(const SimulateOptions& options) {
  if (!is_vehicle(options.model)) {
    return [model = load_model(options.model), rows = options.fit_start](const Record& inputs) {
      return simulate(model, inputs, rows);
    };
  }
  if (options.fit_start > 0) {
    throw UsageError(
        "--fit-start is for a direct model; hydraulic axes start in the steady state under their first commands");
  }
  return [model = load_vehicle(options.model), seed = options.seed](const Record& inputs) {
    return simulate(model, inputs, {.seed = seed});
  };
}

void run_simulation(const SimulateOptions& options) {
  const std::function<Record(const Record&)> run = simulation_of(options);
  const Record inputs = load_any_record(options.input, options.candump);

  const explain::Stopwatch stopwatch;
  const Record outputs = run(inputs);
  const double processor_took = stopwatch.processor_seconds();
  const double took = stopwatch.seconds();
  write_record(outputs, options.output);

  const double simulated = static_cast<double>(outputs.rows) * outputs.period;
  if (options.json) {
    const nlohmann::ordered_json result{{"output", options.output},
                                        {"rows", outputs.rows},
                                        {"simulated_seconds", simulated},
                                        {"seconds", took},
                                        {"processor_seconds", processor_took},
                                        {"times_real_time", simulated / took}};
    print_json(result);
  } else {
    std::cout << fmt::format("{}: {} rows, {:.6g} s simulated in {:.3g} s, {:.0f} times faster than real time\n",
                             options.output, outputs.rows, simulated, took, simulated / took);
  }
}

}  // namespace

void add_simulate(CLI::App& program) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = program.add_subcommand(
      "simulate", "Simulate a model with its position loop closed, under the commands or forces of a record");
  command->add_option("--model", options->model, "model file (.toml)")->required();
  command
      ->add_option(
          "--input", options->input,
          "record with the input channel: command, or force for a direct model (.csv, candump .log, .hfr, .mf4, .h5, .mat)")
      ->required();
  command->add_option("--output", options->output, "record to write: time, input and every model channel")->required();
  command
      ->add_option("--fit-start", options->fit_start,
                   "fit the initial state of a direct mass on this many rows (0: start at rest)")
      ->check(CLI::Range(std::size_t{0}, kMostRows));
  command
      ->add_option("--seed", options->seed,
                   "seed of the sensor noise and of the strings' placement errors in a model of several axes")
      ->capture_default_str();
  add_candump_options(*command, options->candump);
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer("Example: hotfire simulate --model declared.toml --input steps.csv --output model.csv");
  command->callback([options] { run_simulation(*options); });
}

}  // namespace hotfire
