// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/import.hpp"

#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/written_record.hpp"
#include "tools/files/import/guess.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

void add_import(CLI::App& program) {
  struct Options {
    std::string source;
    std::string map;
    std::string dbc;
    std::string output;
    std::vector<std::string> excluded;
    bool guess = false;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "import", "Convert a file with other names to a record: CSV, MATLAB, MDF 4, HDF5 or a candump log");
  command
      ->add_option("SOURCE", options->source,
                   "file to import (.mat, .mf4, .h5, with --dbc a candump log, else text with a header)")
      ->required();
  command->add_option("--map", options->map, "map: the column of each channel (.toml)");
  command->add_option("--dbc", options->dbc, "description of the frames of a candump log (.dbc)");
  command->add_option("--output", options->output, "record to write (.csv)");
  CLI::Option* guess = command->add_flag("--guess", options->guess, "print a first map of the file; no file is written");
  command
      ->add_option("--exclude", options->excluded,
                   "FROM-TO [s]: a drop-out, where values and rows may be missing; give it to explain too")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "print the result as JSON")->excludes(guess);
  command->footer(
      "Example: hotfire import daq.txt --guess > map.toml\nExample: hotfire import run17.mat --map map.toml --output "
      "run17.csv\nmap.toml: schema = 1, [time] column = \"t\", "
      "unit = \"ms\" (or period = \"2 ms\"),\n  [channels.command] column = \"BETA_CMD\", unit = \"deg\" ...\n"
      "Example: hotfire import rig.log --dbc rig.dbc --map map.toml --output rig.csv\nmap.toml: schema = 1, [can] rows = "
      "\"FEEDBACK\" (whose frames make the rows),\n  [channels.command] column = \"BETA_CMD\" (a signal, or "
      "\"MESSAGE.SIGNAL\") ...\nA log of Hotfire's own CAN map needs no map: hotfire convert.");
  command->callback([options] {
    if (options->guess) {
      std::cout << guessed_map(options->source);
      return;
    }
    if (options->map.empty() || options->output.empty()) {
      throw UsageError(fmt::format("missing: {}; 'hotfire import {} --guess > map.toml' begins a map",
                                   options->map.empty() ? options->output.empty() ? "--map, --output" : "--map" : "--output",
                                   options->source));
    }
    const ImportMap map = load_import_map(options->map, import_source(options->source, options->dbc));
    std::vector<DropOut> drop_outs;
    drop_outs.reserve(options->excluded.size());
    for (const std::string& text : options->excluded) {
      const auto drop_out = drop_out_from(text);
      if (!drop_out) {
        throw UsageError(fmt::format("--exclude {}: write FROM-TO with times in seconds, such as 3.0-3.5", text));
      }
      drop_outs.push_back(*drop_out);
    }
    std::vector<std::string> notes;
    const Record record = import_record(options->source, map, options->output, options->dbc, drop_outs, &notes);
    print_written(options->output, record, notes, options->json);
  });
}

}  // namespace hotfire
