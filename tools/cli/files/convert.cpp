// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>

#include "tools/cli/shared/candump_options.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
  CandumpOptions candump;
};

void convert(const ConvertOptions& options) {
  const std::filesystem::path output(options.output);
  if (output.extension() != ".csv" && output.extension() != ".log") {
    throw UsageError(fmt::format("{}: the extension \"{}\" is unknown; allowed: .csv (a record), .log (a candump log)",
                                 options.output, output.extension().string()));
  }
  const Record record = load_record_or_log(options.input, options.candump);
  if (output.extension() == ".log") {
    write_candump(record, output, options.candump);
  } else {
    write_record(record, output);
  }
  std::cout << fmt::format("{}: {} rows, period {:.6g} s\n", options.output, record.rows, record.period);
}

}  // namespace

void add_convert(CLI::App& program) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand("convert", "Write a record as CSV (.csv) or as a candump log (.log)");
  command->add_option("INPUT", options->input, "record (.csv) or candump log (.log)")->required();
  command->add_option("OUTPUT", options->output, "file to write")->required();
  add_candump_options(*command, options->candump);
  command->footer(
      "Example: hotfire convert --command-per-current 5 run.log run.csv\nA log carries currents and positions in codes of 1 "
      "uA "
      "and 0.1 um; canplayer replays it.");
  command->callback([options] { convert(*options); });
}

}  // namespace hotfire
