// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/interpolation.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hotfire::test {
namespace {

constexpr std::size_t kRows = 40;

double signal_at(double row) { return 2.0 + 3.0 * row - 0.4 * row * row; }

/// Integral of the parabola from row 0.
double integral_to(double row) { return 2.0 * row + 1.5 * row * row - 0.4 / 3.0 * row * row * row; }

}  // namespace

TEST_GROUP(Interpolation){};

TEST(Interpolation, KeepsTheBitsOfAConstantSignalInEveryPartOfARow) {
  for (const double value : {0.1, -2.3e3, 1e-7}) {
    const std::vector<double> signal(kRows, value);
    const model::Interpolation interpolation(signal);
    for (const int parts : {1, 2, 3, 7}) {
      for (int part = 0; part < parts; ++part) {
        const auto weights =
            interpolation.mean_weights(static_cast<double>(part) / parts, static_cast<double>(part + 1) / parts);
        for (std::size_t row = 0; row < kRows; ++row) {
          CHECK(interpolation.mean(signal, row, weights) == value);
        }
      }
    }
  }
}

TEST(Interpolation, GivesTheMeanOfAParabolaOverEachPartOfARow) {
  std::vector<double> signal;
  for (std::size_t row = 0; row < kRows; ++row) {
    signal.push_back(signal_at(static_cast<double>(row)));
  }
  const model::Interpolation interpolation(signal);
  constexpr std::size_t kReach = 8;  // beside the ends, where the first and the last value continue
  for (const auto& [from, to] : {std::array{0.0, 1.0}, std::array{0.25, 0.5}, std::array{0.9, 1.0}}) {
    const auto weights = interpolation.mean_weights(from, to);
    for (std::size_t row = kReach; row + kReach < kRows; ++row) {
      const auto at = static_cast<double>(row);
      const double mean = (integral_to(at + to) - integral_to(at + from)) / (to - from);
      DOUBLES_EQUAL(mean, interpolation.mean(signal, row, weights), 1e-11 * std::abs(signal_at(kRows)));
    }
  }
}

TEST(Interpolation, TakesMoreRowsForASignalNearItsSamplingRate) {
  // A quarter of the sampling rate: six rows are wrong by some percent half-way between rows.
  std::vector<double> signal;
  for (std::size_t row = 0; row < kRows; ++row) {
    signal.push_back(std::sin(1.5707963 * static_cast<double>(row)));
  }
  const model::Interpolation interpolation(signal);
  const auto weights = interpolation.mean_weights(0.4999, 0.5001);
  constexpr std::size_t kRow = kRows / 2;
  DOUBLES_EQUAL(std::sin(1.5707963 * (kRow + 0.5)), interpolation.mean(signal, kRow, weights), 0.01);
}

}  // namespace hotfire::test
