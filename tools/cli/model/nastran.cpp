// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/analysis/chart.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/nastran/projection.hpp"
#include "tools/structure/port_response.hpp"

namespace hotfire {

namespace {

struct NastranOptions {
  std::string map;
  std::string output;
  std::string picture;
  bool json = false;
};

/// What each mode gives an attach point at rest, and what all up to a frequency do.
analysis::Chart chart_of(const ModeSet& modes, const std::string& title) {
  analysis::Panel alone{"flexibility of a mode [m/N]", {}};
  analysis::Panel together{"modal integral [m/N]", {}};
  const std::vector<std::string> ports = port_names(modes.engines);
  for (int axis = 0; axis < 2 * modes.engines; ++axis) {
    const ModalIntegral integral = modal_integral(modes, axis);
    analysis::Curve own{ports[static_cast<std::size_t>(axis)], integral.frequency, integral.flexibility, true};
    for (std::size_t k = own.y.size(); k-- > 1;) {
      own.y[k] -= own.y[k - 1];
    }
    alone.curves.push_back(std::move(own));
    together.curves.push_back({ports[static_cast<std::size_t>(axis)], integral.frequency, integral.flexibility});
  }
  return {title, "frequency [Hz]", true, {alone, together}};
}

void run_nastran(const NastranOptions& options) {
  const nastran::Projection projection = nastran::project(options.map);
  const ModeSet& modes = projection.modes;
  write_whole_file(options.output,
                   mode_table_text(modes, {fmt::format("Made by hotfire nastran of {}.",
                                                       std::filesystem::path(options.map).filename().string())}));
  if (!options.picture.empty()) {
    write_whole_file(options.picture, analysis::svg(chart_of(modes, "Modes of " + options.output)));
  }
  if (options.json) {
    const nlohmann::ordered_json result{{"output", options.output},
                                        {"engines", modes.engines},
                                        {"modes", modes.modes()},
                                        {"left_out", projection.left_out},
                                        {"hertz", std::vector<double>(modes.frequency.begin(), modes.frequency.end())},
                                        {"lines", projection.lines}};
    print_json(result);
    return;
  }
  std::cout << fmt::format("{}: {} modes from {:.4g} to {:.4g} Hz, {} at or below the least frequency left out\n",
                           options.output, modes.modes(), modes.frequency.minCoeff(), modes.frequency.maxCoeff(),
                           projection.left_out);
  for (const std::string& line : projection.lines) {
    std::cout << "  " << line << '\n';
  }
}

}  // namespace

void add_nastran(CLI::App& program) {
  const auto options = std::make_shared<NastranOptions>();
  CLI::App* command = program.add_subcommand(
      "nastran",
      "Write a mode table from Nastran's output, projected onto the lines of the actuators and the axes of the gimbals");
  command
      ->add_option("--map", options->map,
                   "map that names the output files and the grid points of attach points and gimbals (.toml)")
      ->required();
  command->add_option("--output", options->output, "mode table to write (.csv)")->required();
  command->add_option("--picture", options->picture, "draw the motion of the attach points in each mode (.svg)");
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer("Example: hotfire nastran --map vehicle.toml --output vehicle.csv --picture modes.svg");
  command->callback([options] { run_nastran(*options); });
}

}  // namespace hotfire
