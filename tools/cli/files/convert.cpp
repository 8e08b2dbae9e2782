// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>

#include "tools/cli/shared/any_record.hpp"
#include "tools/cli/shared/candump_options.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/written_record.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
  CandumpOptions candump;
  bool json = false;
};

void convert(const ConvertOptions& options) {
  const std::filesystem::path output(options.output);
  if (output.extension() != ".csv" && output.extension() != ".log" && !is_foreign(output)) {
    throw UsageError(fmt::format("{}: the extension \"{}\" is unknown; allowed: .csv (a record), .log (a candump log), {}",
                                 options.output, output.extension().string(), fmt::join(foreign_extensions(), ", ")));
  }
  const Record record = load_any_record(options.input, options.candump);
  if (output.extension() == ".log") {
    write_candump(record, output, options.candump);
  } else if (is_foreign(output)) {
    write_foreign(record, output);
  } else {
    write_record(record, output);
  }
  print_written(options.output, record, {}, options.json);
}

}  // namespace

void add_convert(CLI::App& program) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand(
      "convert", "Write a record in another format: CSV (.csv), candump (.log), MDF 4 (.mf4), HDF5 (.h5), MATLAB (.mat)");
  command->add_option("INPUT", options->input, "record (.csv, .mf4, .h5, .mat), recording (.hfr) or candump log (.log)")
      ->required();
  command->add_option("OUTPUT", options->output, "file to write")->required();
  add_candump_options(*command, options->candump);
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Example: hotfire convert run.hfr run.mf4\nExample: hotfire convert --command-per-current 5 run.log run.csv\nA log "
      "has currents and positions in codes of 1 uA and 0.1 um; canplayer replays it.");
  command->callback([options] { convert(*options); });
}

}  // namespace hotfire
