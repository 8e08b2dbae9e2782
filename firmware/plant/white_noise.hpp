// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hotfire::firmware {

/// White noise of mean 0 and variance 1. Each number is the sum of twelve uniform ones. This needs no function that C
/// libraries round differently, so the same seed gives the same bits. Uniform numbers by xorshift64* [Vigna 2016].
/// Real-time.
class WhiteNoise {
 public:
  /// `seed` is not 0.
  explicit WhiteNoise(std::uint64_t seed) noexcept : random_(seed) {}

  double operator()() noexcept {
    constexpr std::uint64_t kMultiplier = 0x2545f4914f6cdd1d;
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      random_ ^= random_ >> 12;
      random_ ^= random_ << 25;
      random_ ^= random_ >> 27;
      sum += static_cast<double>((random_ * kMultiplier) >> 11) * 0x1p-53;
    }
    return sum;
  }

 private:
  std::uint64_t random_;
};

}  // namespace hotfire::firmware
