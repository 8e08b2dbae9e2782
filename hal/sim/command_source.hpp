// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace hotfire::hal::sim {

/// A small open-loop reference controller, to test a plant without any other. `rest`: zero. `steps`: +amplitude, zero,
/// -amplitude, zero, a quarter of the period each. `sine`: amplitude sin(2 pi f t).
struct CommandSource {
  enum class Shape : std::uint8_t { rest, steps, sine };
  static constexpr std::array<std::string_view, 3> kShapes{"rest", "steps", "sine"};

  Shape shape = Shape::steps;
  double amplitude = 0.01;  ///< in the plant's input unit; 0.01 rad is 0.57 deg
  double frequency = 0.5;   ///< [Hz]

  /// The command at a time since the start [s].
  double at(double time) const noexcept {
    const double cycles = frequency * time;
    switch (shape) {
      case Shape::steps: {
        constexpr std::array<double, 4> kLevels{1.0, 0.0, -1.0, 0.0};
        return amplitude * kLevels[static_cast<std::size_t>(4.0 * (cycles - std::floor(cycles))) % kLevels.size()];
      }
      case Shape::sine:
        return amplitude * std::sin(2.0 * std::numbers::pi * cycles);
      case Shape::rest:
        break;
    }
    return 0.0;
  }
};

}  // namespace hotfire::hal::sim
