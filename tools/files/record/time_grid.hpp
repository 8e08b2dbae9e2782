// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "tools/files/record/drop_out.hpp"

namespace hotfire {

/// The fastest sampling that a record may have [s], 20 kHz, and what a printed rate may be off, relative.
inline constexpr double kFastestPeriod = 5e-5;
inline constexpr double kRateRounding = 1e-6;

/// Watches how a time column is printed, to separate rounding from uneven sampling. A printer keeps either the digits after
/// the point (%.4f) or all digits (%.6g); the largest count seen of each bounds the rounding of any time.
class PrintedDigits {
 public:
  void see(std::string_view cell);

  /// Largest step between two numbers printed like those seen, at that magnitude.
  double resolution(double magnitude) const;

 private:
  int after_point_ = 0;
  int significant_ = 1;
};

struct TimeGrid {
  double start;
  double period;
};

/// The uniform grid that a time column [s] lies on: period = (last - first) / (rows - 1).
///
/// Every interval must lie within 1 % of the period, or within what the rounding of two printed times does to it (`unit` is
/// the printed unit in seconds), half a period at most. Throws FileError with line and both times, one message each for
/// repeated times, backward times, gaps and uneven sampling, or with the rate if it is outside 50 Hz to 20 kHz.
/// `lines` says where the rows are in the file.
TimeGrid uniform_grid(const std::vector<double>& times, const PrintedDigits& digits, double unit,
                      const std::filesystem::path& path, const RowLines& lines);

/// The uniform grid of readings that were stamped [s] as they came: it begins with the first stamp, its period is the mean
/// interval, to the microsecond. Throws FileError for a stamp more than half a period off the grid, or with the mean
/// interval if the rate is outside 50 Hz to 20 kHz. Lost readings it does not find where they are lost evenly.
TimeGrid stamped_grid(const std::vector<double>& times, const std::filesystem::path& path);

/// Median interval of at least two times.
double median_interval(const std::vector<double>& times);

/// The first reading before which others are missing, 0 if there is none. Stamps come late by up to half a period, so that
/// the grid is followed from stamp to stamp, by a tenth of what each is off: a late one leaves it where it is, a lost one is
/// a period off.
std::size_t first_reading_after_gap(const std::vector<double>& times);

}  // namespace hotfire
