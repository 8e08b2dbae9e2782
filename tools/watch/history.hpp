// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/watch/duration_histogram.hpp"
#include "tools/watch/live_source.hpp"

namespace hotfire::watch {

/// A channel of the strip charts.
struct Channel {
  std::string group;  ///< "actuator 1", or "loop"
  std::string name;
  std::string unit;
};

/// Least, greatest and last value of a channel in a row; NaN if there was none.
struct Span {
  float least;
  float greatest;
  float last;
};

/// The last minutes of a running program: 20 rows a second, of which each has the extremes of its cycles, so that no peak is
/// lost. Its memory is taken at the start and does not grow.
class History {
 public:
  static constexpr double kRowSeconds = 0.05;
  static constexpr std::size_t kMostRows = 6000;  ///< five minutes

  History() = default;
  explicit History(const hal::LiveDescription& description);

  void add(const LiveCycle& cycle);
  /// Ends the row that is being filled: no cycle follows.
  void end_row();

  const std::vector<Channel>& channels() const { return channels_; }
  /// Rows that have been filled; of these the last `kMostRows` are kept.
  std::uint64_t rows() const { return rows_; }
  std::uint64_t oldest_row() const { return rows_ > kMostRows ? rows_ - kMostRows : 0; }
  /// Of a row that is kept: its time since the program started [s], and the values of its channels.
  double time(std::uint64_t row) const { return times_[row % kMostRows]; }
  std::span<const Span> values(std::uint64_t row) const {
    return std::span(values_).subspan(row % kMostRows * channels_.size(), channels_.size());
  }

  bool has_cycle() const { return has_cycle_; }
  const hal::CycleHead& last_head() const { return last_; }
  std::span<const std::uint64_t> counters() const { return counters_; }
  const DurationHistogram& wake_up() const { return wake_up_; }
  const DurationHistogram& step() const { return step_; }

 private:
  void put(std::size_t channel, double value);

  std::int64_t period_ns_ = 1;
  std::size_t channels_of_actuator_ = 0;  ///< with its command
  std::vector<Channel> channels_;
  std::vector<double> times_;
  std::vector<Span> values_;
  std::vector<Span> filling_;
  std::int64_t filling_row_ = -1;  ///< number of the twentieth of a second that is being filled; below 0: none
  std::uint64_t rows_ = 0;
  std::int64_t start_ns_ = 0;
  bool has_cycle_ = false;
  hal::CycleHead last_;
  std::vector<std::uint64_t> counters_;
  DurationHistogram wake_up_;
  DurationHistogram step_;
};

}  // namespace hotfire::watch
