// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/text/csv_lines.hpp"

namespace hotfire {

/// One line of a candump log.
struct CandumpFrame {
  double time = 0.0;  ///< [s]
  std::string interface;
  std::uint32_t id = 0;  ///< 11 bits, or 29 bits with kExtendedId
  bool is_data = false;  ///< a data frame; the others (remote, error) carry nothing that is read
  bool fd = false;
  std::vector<std::uint8_t> data;
};

/// Reads the next line that is not blank; none at the end. Refuses what candump does not write.
std::optional<CandumpFrame> next_candump_frame(CsvLines& lines);

/// The line of a data frame, with its end.
std::string candump_line(const CandumpFrame& frame);

}  // namespace hotfire
