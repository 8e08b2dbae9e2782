// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// Exit status of a program that could not be started, or whose ranks could not agree.
inline constexpr int kCannotStart = 127;

/// Another program that runs beside this one, with pipes to its standard input and from its standard output. It is ended if
/// this program dies.
class WorkerProcess {
 public:
  /// Ends this program with `kCannotStart` if there is no process or pipe left. A program that is not there ends by itself,
  /// with that status.
  explicit WorkerProcess(const std::vector<std::string>& words);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Text for its standard input. It is written while this program waits, as the other takes it.
  void give(std::string_view text) { pending_ += text; }

  /// No more text comes.
  void close_input() { closing_ = true; }

  /// Waits until it has printed something or takes text, at most so long. False if its output has ended.
  bool wait(int milliseconds);

  /// The next whole line that it has printed, with its end.
  std::optional<std::string> line();

  /// What it has printed besides, and forgets it.
  std::string rest();

  /// Waits for its end. Exit status, or 128 + the signal that ended it.
  int status();

 private:
  void write_pending();

  pid_t process_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::string pending_{};
  std::string printed_{};
  bool closing_ = false;
  bool ended_ = false;
};

}  // namespace hotfire
