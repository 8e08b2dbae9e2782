// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cli/shared/commands.hpp"
#include "tools/export/export_fmu.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// share/hotfire/fmu beside the folder of this program, in a build as in an installation.
std::filesystem::path materials_of_this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/hotfire/fmu";
}

void run_export(FmuOptions options, bool json) {
  options.materials = materials_of_this_program();
  const ExportedFmu written = export_fmu(options);
  if (json) {
    std::cout << nlohmann::ordered_json{{"fmu", options.fmu.string()},
                                        {"fmi", options.version == 3 ? "3.0" : "2.0"},
                                        {"model_identifier", written.identifier},
                                        {"step", options.period},
                                        {"inputs", written.inputs},
                                        {"outputs", written.outputs},
                                        {"parameters", written.parameters}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << fmt::format("{}: FMI {} co-simulation, internal step {} s, {} inputs, {} outputs, {} parameters\n",
                           options.fmu.string(), options.version == 3 ? "3.0" : "2.0", options.period, written.inputs,
                           written.outputs, written.parameters);
}

}  // namespace

void add_export(CLI::App& program) {
  const auto options = std::make_shared<FmuOptions>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand("export", "Write a model as an FMU for other simulation programs");
  command->add_option("model", options->model, "model file (.toml)")->required();
  command->add_option("--fmu", options->fmu, "FMU to write (.fmu)")->required();
  command->add_option("--fmi", options->version, "version of FMI: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  command->add_option("--step", options->period, "fixed internal step [s], over which inputs are held")
      ->capture_default_str();
  command
      ->add_option("--seed", options->seed,
                   "of what sensors and strings of a model of several axes have of noise and placement errors")
      ->capture_default_str();
  command->add_flag("--json", *json, "print the result as JSON");
  command->footer("Example: hotfire export --fmu axis.fmu explained.toml");
  command->callback([options, json] { run_export(*options, *json); });
}

}  // namespace hotfire
