// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "hal/plant_bus.hpp"

namespace hotfire::firmware {

/// A value for each actuator.
using PerActuator = std::array<double, hal::kMaxActuators>;

/// A part of a profile: for each actuator a straight line with a sine on it. The sine is the same for all except for its
/// amplitude. Its frequency rises or falls by the same factor in equal times.
struct Segment {
  double duration = 0.0;  ///< [s]
  PerActuator from{};     ///< of the line, at both ends [rad]
  PerActuator to{};
  PerActuator amplitude{};  ///< of the sine, which begins at phase 0 [rad]
  double frequency = 0.0;   ///< at both ends [Hz]
  double last_frequency = 0.0;

  /// The commands at a time since its beginning.
  PerActuator at(double time) const noexcept {
    const double sine = std::sin(2.0 * std::numbers::pi * periods(time));
    PerActuator commands{};
    for (std::size_t i = 0; i < commands.size(); ++i) {
      commands[i] = from[i] + (to[i] - from[i]) * time / duration + amplitude[i] * sine;
    }
    return commands;
  }

 private:
  double periods(double time) const noexcept {
    const double growth = frequency == last_frequency ? 0.0 : std::log(last_frequency / frequency) / duration;
    return growth == 0.0 ? frequency * time : frequency * std::expm1(growth * time) / growth;
  }
};

/// The commands of a lab: segments one after the other. At the border of two segments the later one applies.
class Profile {
 public:
  explicit Profile(std::vector<Segment> segments) : segments_(std::move(segments)) {
    for (const Segment& segment : segments_) {
      starts_.push_back(duration_);
      duration_ += segment.duration;
    }
  }

  double duration() const noexcept { return duration_; }

  /// The commands [rad] at a time since the start [s]; after the end, those of the end. Takes the logarithm of the number of
  /// segments.
  PerActuator at(double time) const noexcept {
    if (segments_.empty()) {
      return {};
    }
    const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), time);
    const auto place = static_cast<std::size_t>(after - starts_.begin()) - 1;
    return segments_[place].at(std::min(time, duration_) - starts_[place]);
  }

 private:
  std::vector<Segment> segments_;
  std::vector<double> starts_;
  double duration_ = 0.0;
};

}  // namespace hotfire::firmware
