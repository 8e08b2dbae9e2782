// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace hotfire::watch {

/// Durations in bins of equal ratio, 16 a decade from 100 ns to 100 ms; what is shorter or longer is counted in the
/// outermost ones.
class DurationHistogram {
 public:
  static constexpr std::size_t kBinsOfDecade = 16;
  static constexpr std::size_t kBins = 6 * kBinsOfDecade;
  static constexpr double kLeastNs = 100.0;

  void add(std::int64_t duration_ns) {
    const double bin = std::log10(std::max(static_cast<double>(duration_ns), kLeastNs) / kLeastNs) * kBinsOfDecade;
    ++counts_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
    ++count_;
    greatest_ns_ = std::max(greatest_ns_, duration_ns);
  }

  /// Upper end of the bin that the share of the durations reaches, or the greatest one if that is less; 0 if there is none.
  double quantile_ns(double share) const {
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      below += counts_[bin];
      if (below > 0 && static_cast<double>(below) >= share * static_cast<double>(count_)) {
        const double end = kLeastNs * std::pow(10.0, static_cast<double>(bin + 1) / kBinsOfDecade);
        return std::min(end, static_cast<double>(greatest_ns_));
      }
    }
    return 0.0;
  }

  const std::array<std::uint64_t, kBins>& counts() const { return counts_; }
  std::uint64_t count() const { return count_; }
  std::int64_t greatest_ns() const { return greatest_ns_; }

 private:
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t greatest_ns_ = 0;
};

}  // namespace hotfire::watch
