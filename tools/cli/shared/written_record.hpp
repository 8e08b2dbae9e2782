// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire {

/// Prints what a command has written to the file `output`, and `notes` about it: in lines, or as JSON.
void print_written(const std::string& output, const Record& record, const std::vector<std::string>& notes, bool json);

}  // namespace hotfire
