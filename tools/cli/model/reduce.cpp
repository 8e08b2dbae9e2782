// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/structure/reduction.hpp"

namespace hotfire {

namespace {

struct ReduceOptions {
  std::string modes;
  std::string output;
  ReductionGoal goal;
  bool json = false;
};

void print(const ReduceOptions& options, const ModeSet& full, const Reduction& reduction) {
  const std::vector<std::string> names = port_names(full.engines);
  if (options.json) {
    nlohmann::ordered_json errors;
    for (std::size_t i = 0; i < reduction.error.size(); ++i) {
      errors[names[i]] = reduction.error[i];
    }
    const nlohmann::ordered_json result{{"output", options.output},
                                        {"modes", full.modes()},
                                        {"kept", reduction.modes.modes()},
                                        {"band_hertz", {options.goal.lowest, options.goal.highest}},
                                        {"error", errors},
                                        {"static_error", reduction.static_error},
                                        {"reached", reduction.reaches(options.goal)}};
    print_json(result);
    return;
  }
  std::cout << fmt::format("{}: {} of {} modes kept for {:g} to {:g} Hz; static flexibility differs by {:.1e}\n",
                           options.output, reduction.modes.modes(), full.modes(), options.goal.lowest, options.goal.highest,
                           reduction.static_error);
  for (std::size_t i = 0; i < reduction.error.size(); ++i) {
    std::cout << fmt::format("  {:<14} in-band error {:.3f} %\n", names[i], 100.0 * reduction.error[i]);
  }
}

void run_reduction(const ReduceOptions& options) {
  const ModeSet full = load_modes(options.modes);
  const Reduction reduction = reduce(full, options.goal);
  WholeFile file(options.output);
  file.write(mode_table_text(
      reduction.modes,
      {fmt::format("{} of the {} modes of {}, reduced for {:g} to {:g} Hz; the others are in the residual.",
                   reduction.modes.modes(), full.modes(), std::filesystem::path(options.modes).filename().string(),
                   options.goal.lowest, options.goal.highest)}));
  file.commit();
  print(options, full, reduction);
  if (!reduction.reaches(options.goal)) {
    throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_verdict));
  }
}

}  // namespace

void add_reduce(CLI::App& program) {
  const auto options = std::make_shared<ReduceOptions>();
  CLI::App* command = program.add_subcommand("reduce", "Reduce a mode table to the modes that matter in a frequency band");
  command->add_option("--modes", options->modes, "mode table (.csv)")->required();
  command
      ->add_option("--output", options->output,
                   "mode table to write (.csv); the flexibility of removed modes becomes residual flexibility")
      ->required();
  command->add_option("--lowest", options->goal.lowest, "lower end of the band [Hz]")->capture_default_str();
  command->add_option("--highest", options->goal.highest, "upper end of the band [Hz]")->capture_default_str();
  command->add_option("--error", options->goal.error, "allowed relative error of the response in the band")
      ->capture_default_str();
  command->add_option("--most", options->goal.most, "largest number of modes to keep")->capture_default_str();
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Example: hotfire reduce --modes vehicle.csv --output reduced.csv --lowest 1 --highest 20\nExit status: 1 if the "
      "error is above --error with the modes that --most allows; the table is written in any case.");
  command->callback([options] { run_reduction(*options); });
}

}  // namespace hotfire
