// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace hotfire::firmware {

/// Durations counted in bins of equal width, without allocation; what lies beyond the last bin is counted as overflow.
/// Least, greatest and mean are exact.
class Histogram {
 public:
  static constexpr std::size_t kBins = 10'000;

  explicit Histogram(std::int64_t bin_ns) noexcept : bin_ns_(bin_ns) {}

  void add(std::int64_t duration_ns) noexcept {
    const auto bin = static_cast<std::size_t>(std::max<std::int64_t>(duration_ns, 0) / bin_ns_);
    if (bin < kBins) {
      ++counts_[bin];
    } else {
      ++overflow_;
    }
    ++count_;
    sum_ns_ += duration_ns;
    least_ns_ = std::min(least_ns_, duration_ns);
    greatest_ns_ = std::max(greatest_ns_, duration_ns);
  }

  /// The duration that a share of the counted ones does not exceed, rounded up to the end of its bin; 0 if none is counted.
  std::int64_t quantile_ns(double share) const noexcept {
    const double wanted = share * static_cast<double>(count_);
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      below += counts_[bin];
      if (below > 0 && static_cast<double>(below) >= wanted) {
        return std::min(static_cast<std::int64_t>(bin + 1) * bin_ns_, greatest_ns());
      }
    }
    return greatest_ns();
  }

  std::int64_t bin_ns() const noexcept { return bin_ns_; }
  std::uint64_t count() const noexcept { return count_; }
  std::uint64_t overflow() const noexcept { return overflow_; }
  std::int64_t least_ns() const noexcept { return count_ > 0 ? least_ns_ : 0; }
  std::int64_t greatest_ns() const noexcept { return count_ > 0 ? greatest_ns_ : 0; }
  double mean_ns() const noexcept { return count_ > 0 ? static_cast<double>(sum_ns_) / static_cast<double>(count_) : 0.0; }
  const std::array<std::uint64_t, kBins>& counts() const noexcept { return counts_; }

 private:
  std::int64_t bin_ns_;
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t overflow_ = 0;
  std::uint64_t count_ = 0;
  std::int64_t sum_ns_ = 0;
  std::int64_t least_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t greatest_ns_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace hotfire::firmware
