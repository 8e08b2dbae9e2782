// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace hotfire {

/// Whether a real-time command takes a model.
enum class TakesModel { never, optionally, always };

/// What `run_realtime_program` came to.
struct ProgramOutput {
  int status = 0;      ///< exit status; 127 if the program could not be started
  std::string text{};  ///< standard output
};

/// Runs hotfire-rt with these arguments and waits for it. Throws UsageError if no process can be made.
ProgramOutput run_realtime_program(const std::vector<std::string>& arguments);

/// What is done with the arguments of a command; returns or throws as its caller needs it.
using RealtimeRun = std::function<void(const std::vector<std::string>&)>;

/// Adds a command that is carried out by hotfire-rt, the small executable for the real-time target beside this one. A
/// command with a model has `--model`, `--faults` and `--disturbances` of its own: the model and what its plant plays are
/// read and checked here, and handed over as a plant image in memory. Every other argument is passed on as it is, so that
/// hotfire-rt's own table of options is the only one.
///
/// Throws FileError for a model that is refused, UsageError if there is none where there always is one, or if hotfire-rt
/// cannot be started. Else it does not return: the process becomes hotfire-rt, whose exit status is the command's. With a
/// `run` that is called instead. Returns the command, which may get options of its own.
CLI::App* add_realtime_command(CLI::App& program, const std::string& name, const std::string& description, TakesModel model,
                               const RealtimeRun& run = {});

/// Puts an image into memory that the next program inherits, and returns the path under which it finds it. Throws
/// UsageError.
std::string share_image(const std::string& image);

/// Whether only help or version is asked for, which needs no file.
bool asks_for_text_only(const std::vector<std::string>& arguments);

/// Becomes hotfire-rt with these arguments; does not return. Throws UsageError if it cannot be started.
[[noreturn]] void become_realtime_program(const std::vector<std::string>& arguments);

}  // namespace hotfire
