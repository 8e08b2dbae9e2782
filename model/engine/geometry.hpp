// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string_view>

#include "model/declaration/field.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

template <class S>
S dot(const Vector3<S>& a, const Vector3<S>& b) noexcept {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}

/// Length of a vector; at zero it has no slope.
template <class S>
S norm(const Vector3<S>& a) noexcept {
  const S squared = dot<S>(a, a);
  return select(value_of(squared) > 0.0, S(sqrt(squared)), S{0.0});
}

/// Where one actuator holds on to its engine and to the vehicle, with the engine at zero angles. Origin at the gimbal's
/// centre; x along the thrust, forward; pitch turns about y and yaw about z. Extension must give a positive angle. The
/// defaults are a representative pitch actuator parallel to the thrust at an arm of 0.7544 m; `yaw_attach_points` its twin.
template <class S>
struct AttachPoints {
  using Scalar = S;
  static constexpr std::string_view name = "attach";
  S engine_x{-0.3};
  S engine_y{0.0};
  S engine_z{-0.7544};
  S vehicle_x{0.9};
  S vehicle_y{0.0};
  S vehicle_z{-0.7544};
  static constexpr auto fields() {
    using P = AttachPoints;
    return std::array{
        Field<P>{"engine_x", "m", -100.0, 100.0, -0.3, "attach point on the engine, along the thrust", &P::engine_x},
        Field<P>{"engine_y", "m", -100.0, 100.0, 0.0, "attach point on the engine, along the pitch axis", &P::engine_y},
        Field<P>{"engine_z", "m", -100.0, 100.0, -0.7544, "attach point on the engine, along the yaw axis", &P::engine_z},
        Field<P>{"vehicle_x", "m", -100.0, 100.0, 0.9, "attach point on the vehicle, along the thrust", &P::vehicle_x},
        Field<P>{"vehicle_y", "m", -100.0, 100.0, 0.0, "attach point on the vehicle, along the pitch axis", &P::vehicle_y},
        Field<P>{"vehicle_z", "m", -100.0, 100.0, -0.7544, "attach point on the vehicle, along the yaw axis",
                 &P::vehicle_z}};
  }

  Vector3<S> engine() const noexcept { return {engine_x, engine_y, engine_z}; }
  Vector3<S> vehicle() const noexcept { return {vehicle_x, vehicle_y, vehicle_z}; }
};

template <class S>
constexpr AttachPoints<S> yaw_attach_points() noexcept {
  return {S(-0.3), S(0.7544), S(0.0), S(0.9), S(0.7544), S(0.0)};
}

/// An engine and its two actuators at a pair of angles.
template <class S>
struct Pose {
  std::array<S, 2> stroke{};              ///< extension of each actuator from zero angles [m]
  std::array<std::array<S, 2>, 2> arm{};  ///< arm[actuator][angle]: derivative of the stroke [m]
  std::array<Vector3<S>, 2> direction;    ///< unit vector in which an actuator pushes the engine when it extends
  Vector3<S> thrust;                      ///< unit vector of the thrust
};

/// The engine turns by yaw about z, then by pitch about y. Stroke is the change of the distance between an actuator's attach
/// points, and the arms are its exact derivatives, so force and torque do the same work: torque[angle] = sum over actuators
/// of arm[actuator][angle] force[actuator]. Exact at any angle below 90 deg.
template <class S>
class EngineGeometry {
 public:
  EngineGeometry(const AttachPoints<S>& pitch, const AttachPoints<S>& yaw)
      : engine_{pitch.engine(), yaw.engine()},
        vehicle_{pitch.vehicle(), yaw.vehicle()},
        length_{norm<S>(pitch.engine() - pitch.vehicle()), norm<S>(yaw.engine() - yaw.vehicle())} {}

  /// Arms [m] that are the same at any angle, as physics.md section 1 has them: stroke = arm angle, and no actuator turns
  /// the engine about the other axis. Both push along the thrust.
  EngineGeometry(const S& pitch_arm, const S& yaw_arm)
      : engine_{Vector3<S>::Zero(), Vector3<S>::Zero()},
        vehicle_{Vector3<S>::Zero(), Vector3<S>::Zero()},
        length_{pitch_arm, yaw_arm},
        constant_arms_(true) {}

  Pose<S> at(const S& pitch, const S& yaw) const noexcept {
    using std::cos;
    using std::sin;
    const S cp = cos(pitch);
    const S sp = sin(pitch);
    const S cy = cos(yaw);
    const S sy = sin(yaw);
    Pose<S> pose;
    pose.thrust = {cp * cy, sy, -sp * cy};
    if (constant_arms_) {
      pose.stroke = {length_[0] * pitch, length_[1] * yaw};
      pose.arm = {{{length_[0], S(0.0)}, {S(0.0), length_[1]}}};
      pose.direction = {Vector3<S>{S(-1.0), S(0.0), S(0.0)}, Vector3<S>{S(-1.0), S(0.0), S(0.0)}};
      return pose;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const S x = cy * engine_[k](0) - sy * engine_[k](1);
      const S y = sy * engine_[k](0) + cy * engine_[k](1);
      const S z = engine_[k](2);
      const Vector3<S> turned{cp * x + sp * z, y, cp * z - sp * x};
      const Vector3<S> line = turned - vehicle_[k];
      const S length = norm<S>(line);
      pose.direction[k] = line / length;
      pose.stroke[k] = length - length_[k];
      const Vector3<S> by_pitch{turned(2), S(0.0), -turned(0)};
      const Vector3<S> by_yaw{-cp * y, x, sp * y};
      pose.arm[k] = {dot<S>(pose.direction[k], by_pitch), dot<S>(pose.direction[k], by_yaw)};
    }
    return pose;
  }

 private:
  std::array<Vector3<S>, 2> engine_;
  std::array<Vector3<S>, 2> vehicle_;
  std::array<S, 2> length_;  ///< between the attach points at zero angles; the arms where these are constant
  bool constant_arms_ = false;
};

/// What is wrong with the attach points of an engine's two actuators; empty if nothing.
template <class S>
std::string_view broken_relation(const AttachPoints<S>& pitch, const AttachPoints<S>& yaw) {
  constexpr double kClose = 1e-3;  // m: no actuator is shorter, and none two hold on to the same bolt
  const auto near = [](const Vector3<S>& a, const Vector3<S>& b) {
    const Vector3<S> gap = a - b;
    return !(value_of(dot<S>(gap, gap)) > kClose * kClose);
  };
  if (near(pitch.engine(), pitch.vehicle()) || near(yaw.engine(), yaw.vehicle())) {
    return "the attach points of an actuator on engine and vehicle coincide";
  }
  if (near(pitch.engine(), yaw.engine()) && near(pitch.vehicle(), yaw.vehicle())) {
    return "the attach points of the two actuators coincide";
  }
  const Pose<S> pose = EngineGeometry<S>(pitch, yaw).at(S(0.0), S(0.0));
  for (std::size_t k = 0; k < 2; ++k) {
    if (!(value_of(pose.arm[k][k]) > kClose)) {
      return k == 0 ? "the pitch actuator has no arm that turns the engine to positive pitch when it extends"
                    : "the yaw actuator has no arm that turns the engine to positive yaw when it extends";
    }
  }
  return {};
}

}  // namespace hotfire::model
