// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/live/description.hpp"
#include "hal/live/ring.hpp"

namespace hotfire::watch {

/// One cycle of a running program. The spans hold until the next one is read.
struct LiveCycle {
  hal::CycleHead head;
  std::span<const double> commands;
  std::span<const double> readings;
  std::span<const std::uint64_t> counters;
};

/// A program's live view, under the name that its option `--watch` has. The program need not run yet, and may end and start
/// again: the name is then that of another file. It is mapped for reading only.
class LiveSource {
 public:
  /// `absent`: no file has been there yet. `died`: the program is gone and has not said why.
  enum class State { absent, refused, running, died, ended };

  explicit LiveSource(std::string path) : path_(std::move(path)) {}
  ~LiveSource() { close_view(); }
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;

  /// Looks at the name. True if another program is there now, whose description is new and whose cycles begin.
  bool refresh();

  State state() const { return state_; }
  /// Why the file is refused, or why the program has ended.
  const std::string& why() const { return why_; }
  /// Of the program that is there, or was last. Before the first one it is empty.
  const hal::LiveDescription& description() const { return description_; }

  /// The next cycle; false if there is none yet.
  bool next(LiveCycle& cycle);
  /// Cycles that were overwritten before they were read.
  std::uint64_t missed() const { return missed_; }

 private:
  bool open_view();
  bool refuse(const std::string& why);
  bool map(std::size_t bytes);
  void close_view();

  std::string path_;
  State state_ = State::absent;
  std::string why_;
  int file_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
  std::span<const hal::LiveWord> memory_;
  hal::LiveReader reader_;
  hal::LiveDescription description_;
  std::vector<std::uint64_t> words_;
  std::vector<double> values_;
  std::uint64_t next_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace hotfire::watch
