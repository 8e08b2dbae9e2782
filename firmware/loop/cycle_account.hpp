// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/loop/histogram.hpp"

namespace hotfire::firmware {

/// The cause of an overrun. `backlog`: the cycle began late only because the one before had not ended.
enum class Blame : std::uint8_t { wake_up, read, step, write, backlog };
inline constexpr std::array<std::string_view, 5> kBlameNames{"wake_up", "read", "step", "write", "backlog"};

/// The phases of a cycle.
inline constexpr std::array<std::string_view, 5> kPhaseNames{"wake_up", "read", "step", "write", "account"};

/// The times of one cycle, in their order [ns].
struct CycleTimes {
  std::int64_t release;  ///< when it was due
  std::int64_t woken;
  std::int64_t read;       ///< command taken
  std::int64_t stepped;    ///< model advanced
  std::int64_t written;    ///< reading sent
  std::int64_t accounted;  ///< hashed and recorded
  bool slept;              ///< false if it was already due when the cycle before had ended
};

/// Statistics of the cycles of a loop. A cycle overruns if its reading is sent after the next cycle is due.
class CycleAccount {
 public:
  /// The time of every phase [ns].
  using Phases = std::array<std::int64_t, kPhaseNames.size()>;

  /// The cycle whose reading came latest after its release.
  struct Worst {
    std::uint64_t cycle = 0;
    Phases phases_ns{};
    std::int64_t total_ns = -1;
    Blame blame = Blame::wake_up;  ///< its longest phase, or backlog
  };

  explicit CycleAccount(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  bool overran(const CycleTimes& times) const noexcept { return times.written > times.release + period_ns_; }

  void add(std::uint64_t cycle, const CycleTimes& times) noexcept {
    const Phases phases{times.woken - times.release, times.read - times.woken, times.stepped - times.read,
                        times.written - times.stepped, times.accounted - times.written};
    if (times.slept) {
      latency_.add(phases[0]);
    }
    step_time_.add(phases[2]);
    for (std::size_t i = 0; i < phases.size(); ++i) {
      longest_[i] = std::max(longest_[i], phases[i]);
    }
    const std::int64_t total = times.written - times.release;
    const Blame blame = blame_of(phases, times.slept);
    if (total > worst_.total_ns) {
      worst_ = {cycle, phases, total, blame};
    }
    if (overran(times)) {
      ++overruns_;
      ++blamed_[static_cast<std::size_t>(blame)];
    }
    first_ns_ = cycles_ == 0 ? times.woken : first_ns_;
    last_ns_ = times.woken;
    ++cycles_;
  }

  std::uint64_t cycles() const noexcept { return cycles_; }
  std::uint64_t overruns() const noexcept { return overruns_; }
  std::uint64_t blamed(Blame blame) const noexcept { return blamed_[static_cast<std::size_t>(blame)]; }
  const Worst& worst() const noexcept { return worst_; }
  /// The longest time of every phase, each in a cycle of its own.
  const Phases& longest() const noexcept { return longest_; }
  const Histogram& latency() const noexcept { return latency_; }
  const Histogram& step_time() const noexcept { return step_time_; }

  /// Cycles a second, from the first to the last wake-up.
  double rate() const noexcept {
    return cycles_ > 1 ? static_cast<double>(cycles_ - 1) * 1e9 / static_cast<double>(last_ns_ - first_ns_) : 0.0;
  }

 private:
  Blame blame_of(const Phases& phases, bool slept) const noexcept {
    const std::int64_t own_work = phases[1] + phases[2] + phases[3];
    if (!slept && own_work <= period_ns_) {
      return Blame::backlog;
    }
    // What comes after the reading is sent cannot make it late.
    const auto* const first = slept ? phases.begin() : phases.begin() + 1;
    return static_cast<Blame>(std::max_element(first, phases.end() - 1) - phases.begin());
  }

  std::int64_t period_ns_;
  std::uint64_t cycles_ = 0;
  std::uint64_t overruns_ = 0;
  std::array<std::uint64_t, kBlameNames.size()> blamed_{};
  Worst worst_;
  Phases longest_{};
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  Histogram latency_{1000};
  Histogram step_time_{100};
};

}  // namespace hotfire::firmware
