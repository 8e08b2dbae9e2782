// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hotfire {

/// What may be at the place of the last of these words, which are those behind `hotfire` on a command line that is being
/// typed: commands, options, or the values of an option. `*.toml` is for files with that ending, `*` for any file.
std::vector<std::string> completions(const CLI::App& program, const std::vector<std::string>& words);

}  // namespace hotfire
