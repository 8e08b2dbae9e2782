// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

/// One column of a record as its header names it.
struct Column {
  std::string name;  ///< "piston"
  std::string unit;  ///< unit after conversion, "m"
  UnitConverter convert;
};

/// Whether a record can have a channel of this name.
bool is_record_channel(std::string_view name);

/// Reads the header line, `time[s],command[rad],...`, which `lines` gave last. Throws FileError for a channel that is not
/// known or named twice, a unit that is not known or of another dimension, and a header without time.
std::vector<Column> read_header(const CsvLines& lines, std::string_view header);

}  // namespace hotfire
