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

/// The last line of a header, with the end of the line before it.
inline constexpr std::string_view kLastHeaderLine = "\ncycles\n";

/// Reads the header at the beginning of a recording.
ParsedHeader parse_header(std::string_view text);

}  // namespace hotfire::hal
