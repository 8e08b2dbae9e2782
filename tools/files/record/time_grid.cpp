// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/time_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr double kSlowest = 0.02;  // 50 Hz

struct Grid {
  const std::vector<double>& times;
  const PrintedDigits& digits;
  double unit;
  const std::filesystem::path& path;
  const RowLines& lines;

  double resolution(std::size_t row) const { return digits.resolution(std::abs(times[row]) / unit) * unit; }

  double tolerance(std::size_t row, double period) const {
    return std::max(0.01 * period, std::min(1.001 * resolution(row), 0.5 * period));
  }

  [[noreturn]] void refuse(std::size_t row, const std::string& problem) const {
    throw FileError(fmt::format("{}:{}: column time: {} s after {} s: {}", path.string(), lines.of(row), times[row],
                                times[row - 1], problem));
  }
};

void require_rising(const Grid& grid) {
  const std::vector<double>& times = grid.times;
  const auto found =
      std::adjacent_find(times.begin(), times.end(), [](double before, double after) { return !(after > before); });
  if (found == times.end()) {
    return;
  }
  const auto row = static_cast<std::size_t>(found - times.begin()) + 1;
  if (times[row] < times[row - 1]) {
    grid.refuse(row, "time runs backward; allowed: every time above the one before");
  }
  grid.refuse(row,
              fmt::format("repeated time; allowed: every time above the one before (here times are printed to {:.2g} s: if "
                          "that is too coarse, write more digits)",
                          grid.resolution(row)));
}

/// First row whose interval is off `period` by more than is allowed, 0 if there is none.
std::size_t first_uneven_row(const Grid& grid, double period) {
  for (std::size_t row = 1; row < grid.times.size(); ++row) {
    if (std::abs(grid.times[row] - grid.times[row - 1] - period) > grid.tolerance(row, period) &&
        !grid.lines.ends_lost_interval(row)) {
      return row;
    }
  }
  return 0;
}

[[noreturn]] void refuse_uneven(const Grid& grid, std::size_t row, double period) {
  // A gap stretches the mean interval, so that the first row would be blamed: the usual interval is the median.
  const double usual = median_interval(grid.times);
  const std::size_t uneven = first_uneven_row(grid, usual);
  const std::size_t blamed = uneven != 0 ? uneven : row;
  const double interval = grid.times[blamed] - grid.times[blamed - 1];
  if (interval > 1.5 * usual) {
    grid.refuse(blamed,
                fmt::format("a gap of {:.0f} rows, the period is {:.6g} s; allowed: uniform sampling (fill the gap or cut "
                            "the record there; explain bridges it with --exclude {}@{:.6g}-{:.6g})",
                            std::round(interval / usual) - 1.0, usual, grid.path.filename().string(), grid.times[blamed - 1],
                            grid.times[blamed]));
  }
  grid.refuse(blamed,
              fmt::format("interval {:.6g} s where the period is {:.6g} s; allowed: uniform sampling, within {:.2g} s",
                          interval, uneven != 0 ? usual : period, grid.tolerance(blamed, usual)));
}

}  // namespace

double median_interval(const std::vector<double>& times) {
  std::vector<double> intervals(times.size() - 1);
  std::transform(times.begin() + 1, times.end(), times.begin(), intervals.begin(), std::minus<>{});
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

void PrintedDigits::see(std::string_view cell) {
  const std::size_t exponent_at = cell.find_first_of("eE");
  int exponent = 0;
  if (exponent_at != std::string_view::npos) {
    std::string_view text = cell.substr(exponent_at + 1);
    text.remove_prefix(text.starts_with('+') ? 1 : 0);
    std::from_chars(text.data(), text.data() + text.size(), exponent);
  }
  int after_point = 0;
  int significant = 0;
  bool beyond_point = false;
  for (const char letter : cell.substr(0, exponent_at)) {
    beyond_point = beyond_point || letter == '.';
    if (letter >= '0' && letter <= '9') {
      after_point += beyond_point ? 1 : 0;
      significant += letter != '0' || significant > 0 ? 1 : 0;
    }
  }
  after_point_ = std::max(after_point_, after_point - exponent);
  significant_ = std::max(significant_, significant);
}

double PrintedDigits::resolution(double magnitude) const {
  const double fixed = std::pow(10.0, -after_point_);
  const double leading = magnitude > 0.0 ? std::floor(std::log10(magnitude)) + 1.0 : 0.0;
  return magnitude > 0.0 ? std::max(fixed, std::pow(10.0, leading - significant_)) : fixed;
}

TimeGrid uniform_grid(const std::vector<double>& times, const PrintedDigits& digits, double unit,
                      const std::filesystem::path& path, const RowLines& lines) {
  const Grid grid{times, digits, unit, path, lines};
  require_rising(grid);
  const double period = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  if (const std::size_t row = first_uneven_row(grid, period); row != 0) {
    refuse_uneven(grid, row, period);
  }
  if (period > kSlowest * (1.0 + kRateRounding) || period < kFastestPeriod * (1.0 - kRateRounding)) {
    throw FileError(fmt::format("{}:{}: column time: sampled at {:.6g} Hz (period {:.6g} s); allowed: 50 Hz to 20 kHz",
                                path.string(), lines.of(0), 1.0 / period, period));
  }
  return {times.front(), period};
}

TimeGrid stamped_grid(const std::vector<double>& times, const std::filesystem::path& path) {
  constexpr double kMicrosecond = 1e-6;
  const double start = times.front();
  const double mean = (times.back() - start) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double expected = start + static_cast<double>(i) * mean;
    if (!(std::abs(times[i] - expected) <= 0.5 * mean)) {
      throw FileError(
          fmt::format("{}: reading {} is stamped {:.6f} s, and {:.6f} s is expected of an even rate; allowed: "
                      "half a period off",
                      path.string(), i + 1, times[i], expected));
    }
  }
  const double period = std::round(mean / kMicrosecond) * kMicrosecond;
  if (!(period >= kFastestPeriod && period <= kSlowest)) {
    throw FileError(fmt::format("{}: readings every {:.6g} s; allowed: 50 Hz to 20 kHz", path.string(), mean));
  }
  return {start, period};
}

std::size_t first_reading_after_gap(const std::vector<double>& times) {
  constexpr double kFollowed = 0.1;
  const double period = median_interval(times);
  double expected = times.front();
  for (std::size_t i = 1; i < times.size(); ++i) {
    expected += period;
    const double off = times[i] - expected;
    if (off > 0.5 * period) {
      return i;
    }
    expected += kFollowed * off;
  }
  return 0;
}

}  // namespace hotfire
