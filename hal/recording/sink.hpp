// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace hotfire::hal {

/// Why a recording goes no further.
struct SinkRefusal {
  std::string why;
  /// The disk did not do what was asked, and part of what it was given may be lost. Else a limit that was asked for.
  bool is_error = true;
};

/// Where a recording is written to. Called by a thread that is not real-time: both calls may block for as long as they like.
class RecordingSink {
 public:
  RecordingSink() = default;
  RecordingSink(const RecordingSink&) = delete;
  RecordingSink& operator=(const RecordingSink&) = delete;
  virtual ~RecordingSink() = default;

  /// Appends head and content as one: both are there afterwards, or neither and the reason is returned. What has been
  /// appended survives the death of the process.
  virtual std::optional<SinkRefusal> append(std::span<const std::byte> head, std::span<const std::byte> content) = 0;

  /// What has been appended survives the death of the machine, or the reason why it may not.
  virtual std::optional<SinkRefusal> sync() = 0;
};

}  // namespace hotfire::hal
