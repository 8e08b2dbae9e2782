// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/frequencies.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/response/response_report.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire {

namespace {

struct ResponseOptions {
  std::vector<std::string> conditions;
  std::string measured;
  std::string out;
  response::Loading loading;
  double amplitude = 0.4;  ///< [deg]
  Frequencies frequencies{0.5, 40.0, 800};
  bool json = false;
};

response::Comparison comparison_of(const ResponseOptions& options) {
  response::Comparison comparison;
  comparison.frequencies = options.frequencies.spaced();
  std::set<std::string> names;
  response::Loading loading = options.loading;
  loading.amplitude = trials::radians(options.amplitude);
  for (const std::string& path : options.conditions) {
    comparison.conditions.push_back(response::load_condition(path, loading));
    if (!names.insert(comparison.conditions.back().name).second) {
      throw UsageError(fmt::format("{}: a second condition \"{}\"; name the files of the conditions differently", path,
                                   comparison.conditions.back().name));
    }
  }
  if (!options.measured.empty()) {
    comparison.measured = response::load_measured(options.measured);
    response::require_known(comparison);
  }
  return comparison;
}

void run_response(const ResponseOptions& options) {
  const response::Comparison comparison = comparison_of(options);
  if (!options.out.empty()) {
    const std::filesystem::path out(options.out);
    std::error_code failed;
    std::filesystem::create_directories(out, failed);
    if (failed) {
      throw UsageError(fmt::format("--out {}: {}; give a folder that can be written", options.out, failed.message()));
    }
    write_whole_file(out / "responses.csv", response::table_of(comparison));
    write_whole_file(out / "conditions.json", response::to_json(comparison, true).dump(1) + "\n");
    for (const auto& [name, chart] : response::pictures_of(comparison)) {
      write_whole_file(out / name, analysis::svg(chart));
    }
  }
  if (options.json) {
    print_json(response::to_json(comparison, false));
  } else {
    std::cout << response::text_of(comparison);
  }
}

}  // namespace

void add_response(CLI::App& program) {
  const auto options = std::make_shared<ResponseOptions>();
  CLI::App* command = program.add_subcommand(
      "response",
      "Compute structural frequency responses, modal integral and load resonance of one condition, or compare several");
  command
      ->add_option("conditions", options->conditions,
                   "models of several axes (.toml), one for each condition; or mode tables (.csv), without engines")
      ->required();
  command->add_option("--out", options->out, "folder for pictures, responses.csv and conditions.json");
  command->add_option("--measured", options->measured,
                      "measured load resonances (.csv) to compare: condition,axis,resonance[Hz]");
  command
      ->add_option("--bias", options->loading.bias,
                   "constant load of every actuator, about which its stiffness is taken [N]")
      ->capture_default_str();
  command
      ->add_option("--amplitude", options->amplitude,
                   "amplitude of the engine at which the equivalent stiffness of each actuator is taken [deg]")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  add_frequencies(*command, options->frequencies, "the responses", {1e-3, 1000.0, 100'000});
  command->add_flag("--json", options->json, "print the figures as JSON");
  command->footer(
      "Example: hotfire response ambient.toml hot-fire.toml --measured measured.csv --out compared\n"
      "         hotfire response vehicle.csv --out structure");
  command->callback([options] { run_response(*options); });
}

}  // namespace hotfire
