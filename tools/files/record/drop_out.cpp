// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/drop_out.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "tools/files/record/time_grid.hpp"

namespace hotfire {

namespace {

/// Mean of the intervals that are no gap: of rounded times the median may be a tenth off.
double period_between_gaps(const std::vector<double>& times) {
  const double usual = median_interval(times);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t row = 1; row < times.size(); ++row) {
    const double interval = times[row] - times[row - 1];
    if (interval < 1.5 * usual) {
      sum += interval;
      count += 1.0;
    }
  }
  return sum / count;
}

/// The stretches in their order, those that touch or overlap as one.
std::vector<DropOut> merged(std::vector<DropOut> drop_outs) {
  std::sort(drop_outs.begin(), drop_outs.end(), [](const DropOut& a, const DropOut& b) { return a.from < b.from; });
  std::vector<DropOut> merged;
  for (const DropOut& out : drop_outs) {
    if (!merged.empty() && out.from <= merged.back().to) {
      merged.back().to = std::max(merged.back().to, out.to);
    } else {
      merged.push_back(out);
    }
  }
  return merged;
}

/// Rows that are missing before a row, all within one drop-out; 0 if there is no gap, or not all of it is declared.
std::size_t lost_before(const std::vector<DropOut>& drop_outs, const std::vector<double>& times, std::size_t row,
                        double period) {
  const double before = times[row - 1];
  const double periods = std::round((times[row] - before) / period);
  if (!(periods >= 2.0 && periods <= static_cast<double>(kMostLostRows))) {
    return 0;
  }
  const bool declared = std::any_of(drop_outs.begin(), drop_outs.end(), [&](const DropOut& out) {
    return before + 1.5 * period >= out.from && times[row] - 1.5 * period < out.to;
  });
  return declared ? static_cast<std::size_t>(periods) - 1 : 0;
}

std::optional<double> number_from(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return whole ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<DropOut> drop_out_from(std::string_view text) {
  // The first may be negative: a record may begin before its trigger.
  const std::size_t dash = text.find('-', 1);
  if (text.empty() || dash == std::string_view::npos) {
    return std::nullopt;
  }
  const auto from = number_from(text.substr(0, dash));
  const auto to = number_from(text.substr(dash + 1));
  return from && to && *to > *from ? std::optional(DropOut{*from, *to}) : std::nullopt;
}

std::size_t RowLines::of(std::size_t row) const {
  std::size_t lost = 0;
  for (const Lost& stretch : lost_) {
    lost += stretch.first < row ? stretch.count : 0;
  }
  return first_line_ + row - lost;
}

bool RowLines::ends_lost_interval(std::size_t row) const {
  return std::any_of(lost_.begin(), lost_.end(),
                     [&](const Lost& stretch) { return row >= stretch.first && row <= stretch.first + stretch.count; });
}

void put_lost_rows(const std::vector<DropOut>& drop_outs, std::size_t time_column, std::vector<std::vector<double>>& columns,
                   RowLines& lines) {
  const std::vector<double>& times = columns[time_column];
  if (drop_outs.empty() || times.size() < 2) {
    return;
  }
  const double period = period_between_gaps(times);
  // The grid refuses such a rate; rows that fill its gaps would take all the memory there is before.
  if (!(period >= kFastestPeriod * (1.0 - kRateRounding))) {
    return;
  }
  const std::vector<DropOut> stretches = merged(drop_outs);
  std::vector<std::vector<double>> whole(columns.size());
  for (std::size_t row = 0; row < times.size(); ++row) {
    const std::size_t lost = row > 0 ? lost_before(stretches, times, row, period) : 0;
    for (std::size_t k = 1; k <= lost; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(lost + 1);
      for (std::size_t c = 0; c < columns.size(); ++c) {
        whole[c].push_back(c == time_column ? times[row - 1] + share * (times[row] - times[row - 1])
                                            : std::numeric_limits<double>::quiet_NaN());
      }
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      whole[c].push_back(columns[c][row]);
    }
    if (lost > 0) {
      lines.skip(whole.front().size() - 1, lost);
    }
  }
  columns = std::move(whole);
}

}  // namespace hotfire
