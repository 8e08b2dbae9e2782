// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>

namespace hotfire::study {

/// Random numbers that are the same on every machine: the standard fixes the generator and leaves the distributions open.
class Random {
 public:
  /// A stream of its own for every name, seed and part.
  Random(std::string_view name, std::uint64_t seed, std::uint64_t part = 0) {
    std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
    for (const char c : name) {
      hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    }
    std::seed_seq mixed{static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32U),
                        static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(part)};
    generator_.seed(mixed);
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11U) * 0x1p-53);
  }
  /// Every factor as likely as any other of its size.
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double sign() { return uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0; }

  /// Mean 0, variance 1 (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * std::numbers::pi));
  }
  /// The same without what lies beyond `limit`.
  double normal_within(double limit) {
    double value = normal();
    while (std::abs(value) > limit) {
      value = normal();
    }
    return value;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace hotfire::study
