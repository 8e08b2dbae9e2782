// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <string>

#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/record/recording.hpp"

namespace hotfire {

void add_replay(CLI::App& program) {
  struct Options {
    std::string recording;
    std::string csv;
    RecordingPart part{0, 0, true};
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "replay", "Repeat a recording and compare every bit with the recorded one, or write the recording as a record");
  command
      ->add_option("RECORDING", options->recording,
                   "recording (.hfr) that `hotfire plant --record` or `hotfire lab --record` has written")
      ->required();
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "write one actuator, or all axes of a vehicle, as a record (.csv) instead");
  command->add_option("--actuator", options->part.actuator, "actuator to write, from 1")->needs(csv);
  command->add_option("--from", options->part.from, "first cycle to write; the record ends where cycles were dropped")
      ->needs(csv);
  command->add_flag("--json", options->json, "print the result as JSON")->excludes(csv);
  command->footer(
      "Example: hotfire replay run.hfr\n         hotfire replay run.hfr --actuator 2 --csv second.csv\n"
      "The model of a plant, or the logic of a lab, runs again with the recorded inputs.\n"
      "Exit status: 0 every cycle has the recorded bits, 1 a cycle differs or follows a gap, 6 the file is refused.");
  command->callback([options] {
    if (options->csv.empty()) {
      become_realtime_program(options->json ? std::vector<std::string>{"replay", options->recording, "--json"}
                                            : std::vector<std::string>{"replay", options->recording});
    }
    const Record record = load_recording(options->recording, options->part);
    write_record(record, options->csv);
    std::cout << fmt::format("{}: {} rows from {:.6g} s on\n", options->csv, record.rows, record.start);
  });
}

}  // namespace hotfire
