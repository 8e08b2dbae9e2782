// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "hal/recording/format.hpp"

namespace hotfire::hal {

/// A header, its length in bytes, and its error; no error: it is complete.
struct ParsedHeader {
  RecordingHeader header;
  std::size_t bytes = 0;
  std::string error;
};

/// The largest header [bytes]: a profile of half a million rows. A reader does not search further.
inline constexpr std::size_t kLongestHeader = std::size_t{64} << 20;

/// The largest number of values of recorded disturbances in the image of a plant, which is part of the header: each takes up
/// to 26 bytes.
inline constexpr std::size_t kMostPlayedValues = 2'000'000;

/// The last line of a header, with the end of the line before it.
inline constexpr std::string_view kLastHeaderLine = "\ncycles\n";

/// Reads the header at the beginning of a recording.
ParsedHeader parse_header(std::string_view text);

}  // namespace hotfire::hal
