// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/project/project.hpp"

namespace hotfire {

namespace {

struct NewOptions {
  std::string name;
  std::string kind = "simplex";
  bool json = false;
};

void run_new(const NewOptions& options) {
  const Project project = make_project(options.name, options.kind);
  if (options.json) {
    const nlohmann::ordered_json result{
        {"folder", project.folder.string()}, {"files", project.files}, {"commands", project.commands}};
    print_json(result);
    return;
  }
  std::cout << fmt::format("{}: {}\n\nRun next:\n  cd {}\n  {}\n", options.name, fmt::join(project.files, ", "),
                           options.name, fmt::join(project.commands, "\n  "));
}

}  // namespace

void add_new(CLI::App& program) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App* command = program.add_subcommand(
      "new", "Make a project folder: a declared model, example records, a profile, and a README with the next commands");
  command->add_option("NAME", options->name, "folder to make; its last part is the name of the model")->required();
  command->add_option("--kind", options->kind, fmt::format("topology of the model: {}", fmt::join(project_kinds(), ", ")))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer("Example: hotfire new rig && cd rig && cat README.md");
  command->callback([options] { run_new(*options); });
}

}  // namespace hotfire
