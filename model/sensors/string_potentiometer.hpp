// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "model/declaration/field.hpp"
#include "model/effects/sensor/sensor_lag.hpp"
#include "model/engine/geometry.hpp"

namespace hotfire::model {

/// Processing between a potentiometer's motion and its reading: a first-order lag, noise, quantisation, in this order.
///     r' = (x - r) / lag,   reading = step * round((r + noise) / step)
template <class S>
struct PotentiometerReadout {
  using Scalar = S;
  static constexpr std::string_view name = "readout";
  S lag{0.0};
  S noise{0.0};
  S step{0.0};
  static constexpr auto fields() {
    using P = PotentiometerReadout;
    return std::array{Field<P>{"lag", "s", 0.0, 1.0, 1e-3, "time constant of the reading; 0: none", &P::lag},
                      Field<P>{"noise", "m", 0.0, 0.1, 1e-5, "rms noise of a sample", &P::noise},
                      Field<P>{"step", "m", 0.0, 0.1, 1e-5, "least difference of two readings; 0: none", &P::step}};
  }

  using State = SensorLag::State<S>;

  /// Brings the lag to rest at a length.
  static void settle(State& state, const S& length) noexcept { state = {length, length}; }

  /// Reading after a sampling period of `h` [s] at whose end the length is `length`: exact for a length that moves linearly
  /// over the period (`SensorLag`). `draw` is a sample of a distribution of variance 1, from the caller's random numbers.
  S read(State& state, const S& length, const S& draw, double h) const noexcept {
    using std::floor;
    const S noisy = SensorLag::step(SensorLag::Params<S>{0, lag}, state, Signal<S>{length, h}) + noise * draw;
    return value_of(step) > 0.0 ? step * floor(noisy / step + 0.5) : noisy;
  }
};

/// The four string potentiometers of one engine [SD 2.3]: each measures the distance between a point on the engine and an
/// anchor on the vehicle. A string is an `AttachPoints` like an actuator: same frame, same angles, same exact geometry.
template <class S>
class StringPotentiometers {
 public:
  static constexpr std::size_t kStrings = 4;
  using Anchors = std::array<AttachPoints<S>, kStrings>;

  explicit StringPotentiometers(const Anchors& anchors) : first_(anchors[0], anchors[1]), second_(anchors[2], anchors[3]) {}

  /// Representative: two strings along each axis, at either side of the engine, one metre below the gimbal.
  static constexpr Anchors representative() noexcept {
    constexpr double kDown = -1.0;  // x of the points on the engine
    constexpr double kUp = 0.2;     // x of the anchors, on the engine section's floor
    return {AttachPoints<S>{S(kDown), S(0.0), S(-0.6), S(kUp), S(0.1), S(-1.3)},
            AttachPoints<S>{S(kDown), S(0.0), S(0.6), S(kUp), S(-0.1), S(1.3)},
            AttachPoints<S>{S(kDown), S(0.6), S(0.0), S(kUp), S(1.3), S(0.1)},
            AttachPoints<S>{S(kDown), S(-0.6), S(0.0), S(kUp), S(-1.3), S(-0.1)}};
  }

  /// Change of each length from zero angles [m], with the anchors moved by `moved` [m]: the structure's own motion, which a
  /// string cannot distinguish from the engine's. To first order in `moved`, which is small against any string.
  std::array<S, kStrings> lengths(const S& pitch, const S& yaw, const Vector3<S>& moved) const noexcept {
    const Pose<S> first = first_.at(pitch, yaw);
    const Pose<S> second = second_.at(pitch, yaw);
    return {first.stroke[0] - dot<S>(first.direction[0], moved), first.stroke[1] - dot<S>(first.direction[1], moved),
            second.stroke[0] - dot<S>(second.direction[0], moved), second.stroke[1] - dot<S>(second.direction[1], moved)};
  }

  /// The error in an engine's strings; empty if there is none.
  static std::string_view broken_relation(const Anchors& anchors) {
    for (const AttachPoints<S>& string : anchors) {
      if (!(value_of(dot<S>(string.engine() - string.vehicle(), string.engine() - string.vehicle())) > 1e-6)) {
        return "the two ends of a string coincide";
      }
    }
    // What a length changes by under pitch and yaw: two strings must distinguish the two.
    constexpr double kLeast = 1e-6;  // of the determinant, over what perpendicular arms of these sizes would give
    const StringPotentiometers strings(anchors);
    const Pose<S> first = strings.first_.at(S(0.0), S(0.0));
    const Pose<S> second = strings.second_.at(S(0.0), S(0.0));
    double pitch = 0.0;
    double yaw = 0.0;
    double both = 0.0;
    for (const auto& arm : {first.arm[0], first.arm[1], second.arm[0], second.arm[1]}) {
      pitch += value_of(arm[0] * arm[0]);
      yaw += value_of(arm[1] * arm[1]);
      both += value_of(arm[0] * arm[1]);
    }
    if (!(pitch * yaw - both * both > kLeast * pitch * yaw) || !(pitch > kLeast) || !(yaw > kLeast)) {
      return "the strings cannot distinguish pitch from yaw";
    }
    return {};
  }

 private:
  EngineGeometry<S> first_;
  EngineGeometry<S> second_;
};

}  // namespace hotfire::model
