#include "tools/files/import.hpp"

#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>

#include "tools/cli/commands.hpp"

namespace hotfire {

void add_import(CLI::App& program) {
  struct Options {
    std::string source;
    std::string map;
    std::string output;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("import", "Make a record of a CSV file with other names, or of a MATLAB file");
  command->add_option("SOURCE", options->source, "what there is (.mat, else text with a header)")->required();
  command->add_option("--map", options->map, "which channel is where (.toml)")->required();
  command->add_option("--output", options->output, "record to write (.csv)")->required();
  command->footer(
      "Example: hotfire import run17.mat --map map.toml --output run17.csv\nmap.toml: schema = 1, [time] column = \"t\", "
      "unit = \"ms\" (or period = \"2 ms\"),\n  [channels.command] column = \"BETA_CMD\", unit = \"deg\" ... A candump log "
      "needs no map: hotfire convert.");
  command->callback([options] {
    const Record record = import_record(options->source, load_import_map(options->map), options->output);
    std::cout << fmt::format("{}: {} rows, period {:.6g} s,", options->output, record.rows, record.period);
    for (const Channel& channel : record.channels) {
      std::cout << ' ' << channel.name;
    }
    std::cout << '\n';
  });
}

}  // namespace hotfire
