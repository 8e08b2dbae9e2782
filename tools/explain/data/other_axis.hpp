// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/actuator/axis.hpp"
#include "model/engine/geometry.hpp"
#include "model/engine/gimbal.hpp"

namespace hotfire::explain {

/// Motion of an engine about its other axis during one record, a value a row: what an axis that is one of two is explained
/// beside. Empty for an axis alone.
struct OtherAxis {
  std::vector<double> angle;  ///< [rad]
  std::vector<double> rate;   ///< [rad/s]
  std::vector<double> force;  ///< of the other axis's load spring [N]

  bool is_there() const { return !angle.empty(); }
};

/// What the rest of its vehicle does to an axis during one record, a value a row. Empty where the vehicle is the springs of
/// its axes and nothing else.
struct RestOfVehicle {
  std::vector<double> motion;  ///< of the attach point beyond its own spring, by structure and bearing [m]
  std::vector<double> force;   ///< of the axis's own load spring, under which it moved so [N]
  std::vector<double> torque;  ///< against the engine, by what turns the vehicle and by a misaligned thrust [N m]
  double flexibility = 0.0;    ///< of that motion under the axis's own force, at rest [m/N]

  /// Of an engine's bearing that has friction: about the axis itself, then about the other one of the engine.
  struct Bearing {
    std::array<std::vector<double>, 2> turned;     ///< against the engine, beyond what the axis's own friction turns [rad]
    std::array<std::vector<double>, 2> vibrating;  ///< slip by a measured vibration [rad/s]
    std::vector<double> load;                      ///< size of the force through the bearing [N]
    std::vector<double> vibration;                 ///< size of the declared vibration over its own
    double flexibility = 0.0;                      ///< rotation of the bearing under a torque about the axis [rad/(N m)]
    double loss_time = 0.0;                        ///< of the bearing [s]
  };
  Bearing bearing;

  bool is_there() const { return !motion.empty(); }
  bool has_bearing() const { return !bearing.load.empty(); }

  /// Calls `f(values)` for every series.
  template <class F>
  void for_each_series(F&& f) {
    f(motion);
    f(force);
    f(torque);
    f(bearing.turned[0]);
    f(bearing.turned[1]);
    f(bearing.vibrating[0]);
    f(bearing.vibrating[1]);
    f(bearing.load);
    f(bearing.vibration);
  }
};

/// How an axis and the other one of its engine are attached, and what they turn on.
struct AxisGeometry {
  std::size_t own = 0;        ///< 0: pitch is explained, 1: yaw
  bool constant_arms = true;  ///< the declared arm at any angle; otherwise `attach`
  std::array<model::AttachPoints<double>, 2> attach{};
  model::BearingFriction<double> friction{};  ///< of the engine's bearing, as declared
};

/// What an axis meets at its own angle beside a given motion of the other one: stroke and arm of its actuator, the torque of
/// the other actuator about it, and that motion itself.
template <class S>
class Beside {
 public:
  /// `arm` is the axis's declared moment arm [m].
  Beside(const AxisGeometry& geometry, const S& arm)
      : own_(geometry.own),
        constant_arms_(geometry.constant_arms),
        arm_(arm),
        engine_(in_scalar(geometry.attach[0]), in_scalar(geometry.attach[1])) {}

  model::Coupling<S> operator()(const S& angle, double other_angle, double other_rate, double other_force) const {
    if (constant_arms_) {
      return {S(0.0), arm_, S(0.0), S(other_angle), S(other_rate)};
    }
    const S other(other_angle);
    const model::Pose<S> pose = own_ == 0 ? engine_.at(angle, other) : engine_.at(other, angle);
    return {pose.stroke[own_] - arm_ * angle, pose.arm[own_][own_], -pose.arm[1 - own_][own_] * other_force, other,
            S(other_rate)};
  }

 private:
  static model::AttachPoints<S> in_scalar(const model::AttachPoints<double>& from) {
    return {S(from.engine_x), S(from.engine_y), S(from.engine_z), S(from.vehicle_x), S(from.vehicle_y), S(from.vehicle_z)};
  }

  std::size_t own_;
  bool constant_arms_;
  S arm_;
  model::EngineGeometry<S> engine_;
};

}  // namespace hotfire::explain
