// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/files/record/axis_names.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/record/time_grid.hpp"

namespace hotfire {

namespace {

using Series = std::vector<double>;

constexpr double kSlowestSource = 0.1;  // 10 Hz
constexpr double kLargestGap = 2.5;     // median intervals
/// Relative rms of the intervals below which a grid is even: rounding of printed times.
constexpr double kEvenInterval = 1e-3;
constexpr double kCutOff = 0.45;  // of the lower rate
constexpr double kZeros = 32.0;
constexpr double kBeta = 8.0;

/// I_0(x) by its power series, which for x up to 8 has 30 terms above rounding.
double bessel(double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= 0.25 * x * x / (k * k);
    sum += term;
  }
  return sum;
}

/// The reconstruction kernel at `place` in periods of the lower rate.
double kernel(double place) {
  const double share = place / kZeros;
  if (std::abs(share) >= 1.0) {
    return 0.0;
  }
  const double phase = 2.0 * std::numbers::pi * kCutOff * place;
  const double sinc = std::abs(phase) < 1e-9 ? 1.0 : std::sin(phase) / phase;
  return sinc * bessel(kBeta * std::sqrt(1.0 - share * share));
}

/// Second derivatives of the natural cubic spline through the samples (tridiagonal elimination).
Series curvatures(const Series& times, const Series& values) {
  const std::size_t n = times.size();
  Series second(n, 0.0);
  Series upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = times[i] - times[i - 1];
    const double after = times[i + 1] - times[i];
    const double jump = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    second[i] = (6.0 * jump - before * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) {
    second[i] -= upper[i] * second[i + 1];
  }
  return second;
}

/// The spline on an even grid of as many rows from the first time on.
Series evened(const Series& times, const Series& values, double interval) {
  const Series second = curvatures(times, values);
  Series even(times.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < even.size(); ++i) {
    const double t = std::min(times.front() + static_cast<double>(i) * interval, times.back());
    while (k + 2 < times.size() && times[k + 1] < t) {
      ++k;
    }
    const double h = times[k + 1] - times[k];
    const double a = (times[k + 1] - t) / h;
    const double b = 1.0 - a;
    even[i] =
        a * values[k] + b * values[k + 1] + ((a * a * a - a) * second[k] + (b * b * b - b) * second[k + 1]) * h * h / 6.0;
  }
  return even;
}

Series reconstructed(const Series& even, double interval, double period, std::size_t rows) {
  const double slower = std::max(interval, period);
  Series result(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i) * period;
    const double reach = kZeros * slower;
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil((t - reach) / interval)));
    const auto last = std::min(even.size() - 1, static_cast<std::size_t>(std::max(0.0, std::floor((t + reach) / interval))));
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t k = first; k <= last; ++k) {
      const double weight = kernel((t - static_cast<double>(k) * interval) / slower);
      sum += weight * even[k];
      weights += weight;
    }
    result[i] = sum / weights;
  }
  return result;
}

/// Means of a held signal over each new period; the last value holds beyond the last row.
Series held_means(const Series& times, const Series& values, double period, std::size_t rows) {
  Series result(rows);
  std::size_t k = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    double from = times.front() + static_cast<double>(i) * period;
    const double to = from + period;
    double area = 0.0;
    while (k + 1 < times.size() && times[k + 1] <= from) {
      ++k;
    }
    for (std::size_t j = k; from < to; ++j) {
      const double until = j + 1 < times.size() ? std::min(times[j + 1], to) : to;
      area += values[j] * (until - from);
      from = until;
    }
    result[i] = area / period;
  }
  return result;
}

void require_good(const Series& times, const std::vector<Series>& columns) {
  if (times.size() < 4) {
    throw std::invalid_argument(fmt::format("{} rows; at least 4 are needed to resample", times.size()));
  }
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (!(times[row] > times[row - 1])) {
      throw std::invalid_argument(
          fmt::format("row {}: time {:.9g} s after {:.9g} s; every time has to be above the one before", row + 1, times[row],
                      times[row - 1]));
    }
  }
  const double usual = median_interval(times);
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (times[row] - times[row - 1] > kLargestGap * usual) {
      throw std::invalid_argument(fmt::format(
          "row {}: a gap of {:.4g} s where the usual interval is {:.4g} s; up to {:.3g} s is resampled: cut the log "
          "there",
          row + 1, times[row] - times[row - 1], usual, kLargestGap * usual));
    }
  }
  for (const Series& column : columns) {
    const auto bad = std::ranges::find_if(column, [](double value) { return !std::isfinite(value); });
    if (bad != column.end()) {
      throw std::invalid_argument(
          fmt::format("row {}: a cell without a number; a column with missing values is not resampled: cut the log there",
                      bad - column.begin() + 1));
    }
  }
}

}  // namespace

bool is_held_input(std::string_view channel) {
  const std::string_view own = own_name(channel);
  return own == "command" || own == "current" || own == "setpoint";
}

Resampled resampled(const Series& times, const std::vector<Series>& columns, const std::vector<bool>& held, double period) {
  require_good(times, columns);
  const double length = times.back() - times.front();
  const double interval = length / static_cast<double>(times.size() - 1);
  if (interval > kSlowestSource * (1.0 + kEvenInterval)) {
    throw std::invalid_argument(fmt::format("sampled every {:.4g} s; allowed: up to 0.1 s (10 Hz)", interval));
  }
  double square = 0.0;
  double widest = 0.0;
  for (std::size_t row = 1; row < times.size(); ++row) {
    const double apart = times[row] - times[row - 1];
    square += (apart - interval) * (apart - interval);
    widest = std::max(widest, apart);
  }
  const double jitter = std::sqrt(square / static_cast<double>(times.size() - 1));
  const bool is_even = jitter <= kEvenInterval * interval;
  const double last = std::floor(length / period * (1.0 + 1e-12));
  if (last + 1.0 > static_cast<double>(kMostRows)) {
    throw std::invalid_argument(fmt::format("{:.0f} rows of {:.4g} s; allowed: up to {}", last + 1.0, period, kMostRows));
  }
  const auto rows = static_cast<std::size_t>(last) + 1;
  const bool same_rate = std::abs(period - interval) <= kEvenInterval * interval;
  Resampled result{times.front(), period, {}, {}};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (held[c]) {
      result.values.push_back(held_means(times, columns[c], period, rows));
      continue;
    }
    const Series even = is_even ? columns[c] : evened(times, columns[c], interval);
    result.values.push_back(same_rate && std::abs(period - interval) * last < kEvenInterval * interval
                                ? Series(even.begin(), even.begin() + static_cast<std::ptrdiff_t>(rows))
                                : reconstructed(even, interval, period, rows));
  }
  result.note = fmt::format(
      "resampled: {} rows every {:.6g} s became {} rows every {:.6g} s. The intervals varied by {:.3g} s rms, the widest "
      "was "
      "{:.6g} s. {}Measured channels hold nothing above {:.4g} Hz{}",
      times.size(), interval, rows, period, jitter, widest, is_even ? "" : "Samples were joined by a cubic spline. ",
      kCutOff / std::max(interval, period),
      std::ranges::find(held, true) != held.end() ? ". A command is its mean over each period" : "");
  return result;
}

}  // namespace hotfire
