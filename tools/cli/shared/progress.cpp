// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

#include "tools/explain/refine/watch.hpp"

namespace hotfire {

namespace {

/// Time between two lines of a log, and before the first [s]: a command that takes less adds nothing to its log.
constexpr double kLogPeriod = 10.0;
/// Characters of the bar.
constexpr int kBarWidth = 20;
/// Share of the work from which the time left is reported.
constexpr double kLeastShare = 0.02;

std::string bar(double done) {
  const int filled = static_cast<int>(std::lround(std::clamp(done, 0.0, 1.0) * kBarWidth));
  return std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
}

std::string in_words(double seconds) {
  const auto whole = std::lround(std::max(0.0, seconds));
  return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {} s", whole / 60, whole % 60);
}

/// The time that the rest takes if `done` took `seconds` [s].
double time_left(double seconds, double done) {
  return done < kLeastShare ? std::numeric_limits<double>::infinity() : seconds * (1.0 - done) / done;
}

}  // namespace

std::function<double()> stopwatch() {
  return [watch = explain::Stopwatch()] { return watch.seconds(); };
}

Progress::Progress(std::optional<double> limit) : Progress(std::cerr, isatty(STDERR_FILENO) != 0, limit, stopwatch()) {}

Progress::Progress(std::ostream& to, bool is_terminal, std::optional<double> limit, std::function<double()> clock)
    : to_(to), is_terminal_(is_terminal), limit_(limit), clock_(std::move(clock)), next_(kLogPeriod) {}

Progress::~Progress() {
  if (is_terminal_) {
    to_ << "\r\x1b[K" << std::flush;
  }
}

std::string Progress::line(double seconds, const std::string& what, std::optional<double> done,
                           std::optional<double> least_done) const {
  if (done) {
    const double expected = time_left(seconds, *done);
    const double longest = time_left(seconds, least_done.value_or(*done));
    std::string left;
    if (limit_ && *limit_ - seconds < expected) {
      left = fmt::format(", at most {} left", in_words(*limit_ - seconds));
    } else if (std::isfinite(expected)) {
      const double most = std::min(longest, limit_ ? *limit_ - seconds : longest);
      const std::string to = std::isfinite(most) && in_words(most) != in_words(expected) ? " to " + in_words(most) : "";
      left = fmt::format(", about {}{} left", in_words(expected), to);
    }
    return fmt::format("[{}] {:.0f} %{}: {}", bar(*done), 100.0 * *done, left, what);
  }
  if (limit_) {
    return fmt::format("[{}] {}, at most {} left: {}", bar(seconds / *limit_), in_words(seconds),
                       in_words(*limit_ - seconds), what);
  }
  return fmt::format("[{:5.1f} s] {}", seconds, what);
}

void Progress::say(const std::string& what, std::optional<double> done, std::optional<double> least_done) {
  const std::lock_guard guard(mutex_);
  const double seconds = clock_();
  if (is_terminal_) {
    to_ << "\r\x1b[K" << line(seconds, what, done, least_done) << std::flush;
  } else if (seconds >= next_) {
    next_ = seconds + kLogPeriod;
    to_ << line(seconds, what, done, least_done) << std::endl;
  }
}

}  // namespace hotfire
