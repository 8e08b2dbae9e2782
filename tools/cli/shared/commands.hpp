// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/disperse/dispersion.hpp"

namespace hotfire {

/// False for a command of the build or of a shell, which --help and the reference do not list.
inline bool is_listed(const CLI::App* command) { return !command->get_group().empty(); }

/// Each adds one command to the program. A command runs in its callback: it prints its result on standard output and nothing
/// else there, throws FileError or UsageError, or CLI::RuntimeError with an exit status when all is said.
void add_check(CLI::App& program);
void add_controller(CLI::App& program);
void add_convert(CLI::App& program);
/// `run` runs a command line of the program itself, and keeps what it prints.
void add_disperse(CLI::App& program, const disperse::CommandRunner& run);
void add_doctor(CLI::App& program);
void add_export(CLI::App& program);
void add_explain(CLI::App& program, const std::string& typed);  ///< `typed`: the command line, for its report
void add_findings(CLI::App& program);
void add_hammer(CLI::App& program);
void add_header(CLI::App& program);
void add_import(CLI::App& program);
void add_keys(CLI::App& program);
void add_nastran(CLI::App& program);
void add_new(CLI::App& program);
void add_quiescent(CLI::App& program);
void add_lab(CLI::App& program);
void add_linearise(CLI::App& program);
void add_loop(CLI::App& program);
void add_reduce(CLI::App& program);
void add_response(CLI::App& program);
void add_simulate(CLI::App& program);
void add_plant(CLI::App& program);
void add_reference(CLI::App& program);  ///< hidden: what makes the man pages and the completion of a shell
void add_replay(CLI::App& program);
void add_step(CLI::App& program);
void add_stiffness(CLI::App& program);
void add_strings(CLI::App& program);
void add_sweep(CLI::App& program);
void add_timing(CLI::App& program);
void add_watch(CLI::App& program);

}  // namespace hotfire
