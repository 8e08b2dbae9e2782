// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace hotfire::hal {

/// The reason why a recording ends.
struct SinkRefusal {
  std::string why;
  /// True: the disk refused a request, and a part of the data may be lost. False: a limit was reached that the options set.
  bool is_error = true;
};

/// The destination of a recording. A thread that is not real-time calls it: both calls may block for any time.
class RecordingSink {
 public:
  RecordingSink() = default;
  RecordingSink(const RecordingSink&) = delete;
  RecordingSink& operator=(const RecordingSink&) = delete;
  virtual ~RecordingSink() = default;

  /// Appends head and content together: both are in the file afterwards, or neither and the reason is returned. Appended
  /// data survive the end of the process.
  virtual std::optional<SinkRefusal> append(std::span<const std::byte> head, std::span<const std::byte> content) = 0;

  /// Makes appended data safe from a loss of power. Returns the reason if this fails.
  virtual std::optional<SinkRefusal> sync() = 0;
};

}  // namespace hotfire::hal
