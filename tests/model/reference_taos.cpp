#include "tests/model/reference_taos.hpp"

#include <cmath>
#include <numbers>

#include "tests/model/cvode_integrator.hpp"
#include "tests/model/reference_parts.hpp"

namespace hotfire::test {
namespace {

using Vector = Eigen::Vector3d;
using Pair = Eigen::Vector2d;
using Six = Eigen::Matrix<double, 6, 1>;

constexpr int kAxisStates = kReferenceStates;
constexpr int kBristle = 2 * kAxisStates;
constexpr int kBearing = kBristle + 2;
constexpr int kModes = kBearing + 6;

struct Problem {
  const ReferenceTaos* taos = nullptr;
  std::array<double, 2> commands{};
};

/// The engine turned: first by yaw about its own z, then with it by pitch about the vehicle's y.
struct Turned {
  Eigen::Matrix3d rotation;
  std::array<Vector, 2> axes;  ///< about which a change of pitch, of yaw turns it

  Turned(double pitch, double yaw) {
    const Eigen::Matrix3d about_y = Eigen::AngleAxisd(pitch, Vector::UnitY()).toRotationMatrix();
    rotation = about_y * Eigen::AngleAxisd(yaw, Vector::UnitZ()).toRotationMatrix();
    axes = {Vector::UnitY(), about_y * Vector::UnitZ()};
  }
};

struct Friction {
  Pair torque;
  Pair bristle_rate;
};

Friction lugre(const ReferenceTaos& taos, const Pair& slip, const Pair& z) {
  const auto& law = taos.friction;
  if (law.level == 0.0) {
    return {Pair::Zero(), Pair::Zero()};
  }
  const double speed = slip.norm();
  const double sliding = law.level * (1.0 + (taos.vibration_ratio - 1.0) * std::exp(-speed / taos.vibration_velocity));
  const double level = study::stribeck(sliding, law.static_ratio, law.stribeck, speed);
  const Pair rate = slip - law.stiffness * speed / level * z;
  const double fading = std::exp(-(speed / law.damping_dies_at) * (speed / law.damping_dies_at));
  return {law.stiffness * z + law.damping * fading * rate, rate};
}

/// Friction and the rate of the bearing, which depend on each other: the torque turns the bearing, whose rate is part of the
/// slip. The bristle's damping is weak against the bearing's, so that the repetition contracts.
Friction friction_on_bearing(const ReferenceTaos& taos, const Pair& rate_of_engine, const Pair& z, const Six& bearing,
                             const Vector& force, Six& bearing_rate) {
  Friction friction{Pair::Zero(), Pair::Zero()};
  for (int i = 0; i < 60; ++i) {
    Six wrench;
    wrench << force, 0.0, friction.torque;
    bearing_rate = (taos.bearing_compliance * wrench - bearing) / taos.loss_time;
    const Friction next = lugre(taos, rate_of_engine - bearing_rate.tail<2>(), z);
    const double change = (next.torque - friction.torque).norm();
    friction = next;
    if (change <= 1e-15 * friction.torque.norm()) {
      break;
    }
  }
  return friction;
}

int derivative(double, N_Vector state, N_Vector result, void* user) {
  const Problem& problem = *static_cast<Problem*>(user);
  const ReferenceTaos& taos = *problem.taos;
  const double* y = N_VGetArrayPointer(state);
  double* d = N_VGetArrayPointer(result);
  const auto of = [&](int axis, int i) { return y[axis * kAxisStates + i]; };

  const Turned turned(of(0, kReferenceAngle), of(1, kReferenceAngle));
  const Eigen::Map<const Six> bearing(y + kBearing);
  std::array<double, 2> moved{};
  std::array<double, 2> base{};
  std::array<double, 2> base_rate{};
  for (std::size_t k = 0; k < taos.modes.size(); ++k) {
    const double eta = y[kModes + 2 * k];
    const double eta_rate = y[kModes + 2 * k + 1];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      moved[axis] += taos.modes[k].attach[axis] * eta;
      base[axis] += taos.modes[k].rotation[axis] * eta;
      base_rate[axis] += taos.modes[k].rotation[axis] * eta_rate;
    }
  }

  std::array<double, 2> forces{};
  Pair torque = Pair::Zero();
  Vector on_bearing = taos.thrust * (turned.rotation * Vector::UnitX());
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const Vector at = turned.rotation * taos.on_engine[i];
    const Vector line = at - taos.on_vehicle[i];
    const Vector direction = line.normalized();
    const double stroke = line.norm() - (taos.on_engine[i] - taos.on_vehicle[i]).norm();
    const double deflection = of(axis, kReferencePiston) - stroke - moved[i] - direction.dot(bearing.head<3>());
    forces[i] = study::spring_force(taos.axes[i], deflection);
    on_bearing += forces[i] * direction;
    for (int about = 0; about < 2; ++about) {
      torque(about) += forces[i] * direction.dot(turned.axes[static_cast<std::size_t>(about)].cross(at));
    }
  }

  const Pair rates(of(0, kReferenceAngleRate), of(1, kReferenceAngleRate));
  Six bearing_rate;
  const Friction friction = friction_on_bearing(taos, rates - Pair(base_rate[0], base_rate[1]),
                                                Pair(y[kBristle], y[kBristle + 1]), bearing, on_bearing, bearing_rate);
  Eigen::Map<Six>(d + kBearing) = bearing_rate;
  d[kBristle] = friction.bristle_rate(0);
  d[kBristle + 1] = friction.bristle_rate(1);

  std::array<double, 2> on_vehicle{};
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const ReferenceAxis& a = taos.axes[i];
    const double* own = y + axis * kAxisStates;
    double* own_rate = d + axis * kAxisStates;
    const double torque_motor = a.position_gain * (a.arm * problem.commands[i] - own[kReferencePiston]) -
                                a.pressure_gain * (own[kReferencePressure] - own[kReferenceWashout]);
    reference_hydraulics(a, study::clamp_to(torque_motor, 1.0), own, own_rate);
    own_rate[kReferencePiston] = own[kReferencePistonRate];
    own_rate[kReferencePistonRate] =
        (a.area * own[kReferencePressure] - forces[i] - a.piston_damping * own[kReferencePistonRate]) / a.piston_mass;
    own_rate[kReferenceAngle] = own[kReferenceAngleRate];
    on_vehicle[i] = friction.torque(axis) + a.duct_stiffness * (own[kReferenceAngle] - base[i]) +
                    a.damping * (own[kReferenceAngleRate] - base_rate[i]);
    own_rate[kReferenceAngleRate] = (torque(axis) - on_vehicle[i]) / a.inertia;
  }
  for (std::size_t k = 0; k < taos.modes.size(); ++k) {
    const ReferenceTaos::Mode& mode = taos.modes[k];
    const double w = 2.0 * std::numbers::pi * mode.frequency;
    double force = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      force += mode.attach[i] * forces[i] + mode.rotation[i] * on_vehicle[i];
    }
    d[kModes + 2 * k] = y[kModes + 2 * k + 1];
    d[kModes + 2 * k + 1] = force - 2.0 * mode.damping * w * y[kModes + 2 * k + 1] - w * w * y[kModes + 2 * k];
  }
  return 0;
}

std::vector<double> scales(const ReferenceTaos& taos) {
  constexpr std::array<double, kAxisStates> kAxis{0.01, 1.0, 1e6, 1e6, 0.01, 0.1, 0.01, 0.1};
  std::vector<double> scale(kAxis.begin(), kAxis.end());
  scale.insert(scale.end(), kAxis.begin(), kAxis.end());
  scale.insert(scale.end(), 2, 1e-4);
  scale.insert(scale.end(), 6, 1e-4);
  for (std::size_t k = 0; k < taos.modes.size(); ++k) {
    scale.insert(scale.end(), {0.1, 1.0});
  }
  return scale;
}

}  // namespace

std::vector<std::array<double, 4>> integrate_reference(const ReferenceTaos& taos, const ReferenceTaos::Start& start,
                                                       const std::vector<std::array<double, 2>>& commands, double sample,
                                                       double tolerance) {
  Problem problem{&taos};
  CvodeIntegrator integrator(derivative, &problem, scales(taos), tolerance);
  double* y = integrator.state();
  for (int axis = 0; axis < 2; ++axis) {
    std::copy(start.axes[static_cast<std::size_t>(axis)].begin(), start.axes[static_cast<std::size_t>(axis)].end(),
              y + axis * kAxisStates);
  }
  std::copy(start.bearing.begin(), start.bearing.end(), y + kBearing);
  for (std::size_t k = 0; k < start.modes.size(); ++k) {
    y[kModes + 2 * k] = start.modes[k];
  }
  std::vector<std::array<double, 4>> rows;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    problem.commands = commands[i];
    integrator.advance(static_cast<double>(i + 1) * sample);
    const double* now = integrator.state();
    rows.push_back({now[kReferencePiston], now[kReferenceAngle], now[kAxisStates + kReferencePiston],
                    now[kAxisStates + kReferenceAngle]});
  }
  return rows;
}

}  // namespace hotfire::test
