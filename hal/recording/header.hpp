#pragma once

#include <string>
#include <string_view>

#include "hal/recording/format.hpp"

namespace hotfire::hal {

/// A header, the bytes it takes, and what is wrong with it; no error: it is whole.
struct ParsedHeader {
  RecordingHeader header;
  std::size_t bytes = 0;
  std::string error;
};

/// Reads the header at the beginning of a recording. A header is below 256 KiB.
ParsedHeader parse_header(std::string_view text);

}  // namespace hotfire::hal
