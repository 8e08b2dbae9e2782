#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace hotfire::hal {

/// Where a recording is written to. Called by a thread that is not real-time: both calls may block for as long as they like.
class RecordingSink {
 public:
  RecordingSink() = default;
  RecordingSink(const RecordingSink&) = delete;
  RecordingSink& operator=(const RecordingSink&) = delete;
  virtual ~RecordingSink() = default;

  /// Appends head and content as one: both are there afterwards, or neither and the reason is returned. What has been
  /// appended survives the death of the process.
  virtual std::string append(std::span<const std::byte> head, std::span<const std::byte> content) = 0;

  /// What has been appended survives the death of the machine.
  virtual void sync() = 0;
};

}  // namespace hotfire::hal
