// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "hal/failure.hpp"
#include "hal/live/ring.hpp"

namespace hotfire::hal {

/// The memory of a live view, under a name that other programs open. It is a file of a file system in memory, because a
/// store to any other file may have to wait for a disk.
///
/// The file can only be read, by its user and group (mode 0440): a process that shortens it would end the program that fills
/// it. It gets its name when its description is complete. A file of that name whose program still runs is refused; another
/// one is replaced. The destructor removes the name. No symbolic link is followed.
class LiveFile {
 public:
  explicit LiveFile(std::string path) : path_(std::move(path)) {}
  ~LiveFile();
  LiveFile(const LiveFile&) = delete;
  LiveFile& operator=(const LiveFile&) = delete;

  /// Makes the file and all its pages. Call it before the real-time set-up, which locks them.
  std::optional<Failure> create(const std::string& description, std::size_t slot_words, std::size_t slots);

  LiveWriter writer() const noexcept { return {memory_, shape_}; }

 private:
  std::optional<Failure> refuse_what_is_there() const;
  bool map() noexcept;

  std::string path_;
  LiveShape shape_;
  std::span<LiveWord> memory_;
  int file_ = -1;
  bool is_named_ = false;
};

}  // namespace hotfire::hal
