// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <mutex>
#include <optional>
#include <string>

namespace hotfire {

/// Seconds since it was made, by the steady clock.
std::function<double()> stopwatch();

/// What a long command reports on standard error while it works: on a terminal one line that is written over, in a log
/// lines of their own, so few that they hide nothing else. Each has the time so far, what is done now, and the time left
/// if it is known: from the share of the work that is done, else from the time limit of the command. Of a work whose extent
/// nobody knows before, the time left is from the shortest to the longest.
class Progress {
 public:
  /// On standard error.
  explicit Progress(std::optional<double> limit = std::nullopt);
  Progress(std::ostream& to, bool is_terminal, std::optional<double> limit, std::function<double()> clock);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// From any thread. `done`: share of the work behind it, 0 to 1; `least_done`: this share if the work is the longest that
  /// it can be.
  void say(const std::string& what, std::optional<double> done = std::nullopt,
           std::optional<double> least_done = std::nullopt);
  double seconds() const { return clock_(); }

 private:
  std::string line(double seconds, const std::string& what, std::optional<double> done,
                   std::optional<double> least_done) const;

  std::ostream& to_;
  bool is_terminal_;
  std::optional<double> limit_;  ///< of the whole command [s]
  std::function<double()> clock_;
  std::mutex mutex_;
  double next_ = 0.0;  ///< time of the next line of a log [s]
};

}  // namespace hotfire
