// SPDX-License-Identifier: Apache-2.0
#include "tests/model/cvode/reference_vehicle.hpp"

#include <cmath>
#include <numbers>

#include "tests/model/cvode/reference_parts.hpp"
#include "tools/study/reference/cvode_integrator.hpp"

namespace hotfire::test {
namespace {

using Vector = Eigen::Vector3d;
using Pair = Eigen::Vector2d;
using Six = Eigen::Matrix<double, 6, 1>;
using Five = Eigen::Matrix<double, 5, 1>;

// States: of every engine two axes, the bristle, the bearing and, where there is one, its block; then displacement and rate
// of every mode.
constexpr int kAxisStates = kReferenceStates;
constexpr int kBristle = 2 * kAxisStates;
constexpr int kBearing = kBristle + 2;
constexpr int kBlock = kBearing + 6;
constexpr int kBlockStates = 10;  ///< x, y, z against the vehicle, pitch and yaw in space; then their rates

bool has_block(const ReferenceVehicle& vehicle) { return vehicle.engines.front().block_mass > 0.0; }
std::size_t engine_states(const ReferenceVehicle& vehicle) { return kBlock + (has_block(vehicle) ? kBlockStates : 0); }

struct Problem {
  const ReferenceVehicle* vehicle = nullptr;
  const ReferenceVehicle::Inputs* inputs = nullptr;
  std::vector<std::array<ReferenceAxis, 2>>
      springs{};  ///< the axes with attach points as stiff as the inputs' thrust makes them
};

double thrust_of(const Problem& problem, std::size_t e) {
  const std::vector<double>& thrust = problem.inputs->thrust;
  return problem.vehicle->engines[e].thrust + (thrust.empty() ? 0.0 : thrust[e]);
}

/// Takes what drives the next sample: attach points are softer under less than rated thrust, their flexibility linear in it.
void drive(Problem& problem, const ReferenceVehicle::Inputs& inputs) {
  problem.inputs = &inputs;
  for (std::size_t e = 0; e < problem.springs.size(); ++e) {
    const ReferenceVehicle::Engine& engine = problem.vehicle->engines[e];
    const double rated = engine.rated_thrust;
    const double missing = rated > 0.0 ? std::max(0.0, 1.0 - thrust_of(problem, e) / rated) : 0.0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      problem.springs[e][axis].load_stiffness =
          engine.axes[axis].load_stiffness / (1.0 + (1.0 / engine.unloaded_structure - 1.0) * missing);
    }
  }
}

/// What drives one engine over a sample.
struct OnEngine {
  const double* commands = nullptr;
  const std::array<ReferenceAxis, 2>* springs = nullptr;
  double thrust = 0.0;
  Vector force = Vector::Zero();
  Pair torque = Pair::Zero();
};

OnEngine on_engine(const Problem& problem, std::size_t e) {
  const ReferenceVehicle::Inputs& inputs = *problem.inputs;
  OnEngine on;
  on.commands = &inputs.commands[2 * e];
  on.springs = &problem.springs[e];
  on.thrust = thrust_of(problem, e);
  if (!inputs.force.empty()) {
    on.force = inputs.force[e];
  }
  if (!inputs.torque.empty()) {
    on.torque = Pair(inputs.torque[2 * e], inputs.torque[2 * e + 1]);
  }
  return on;
}

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

/// How an actuator stands between vehicle and engine.
struct Actuator {
  double stroke;     ///< from zero angles [m]
  Vector direction;  ///< of its push on the engine
  Pair arms;         ///< torque about pitch and yaw per force [m]
};

Actuator actuator_of(const ReferenceVehicle::Engine& engine, int axis, const Turned& turned, double angle) {
  const auto i = static_cast<std::size_t>(axis);
  if (engine.declared_arms) {
    const double arm = engine.axes[i].arm;
    return {arm * angle, -Vector::UnitX(), arm * Pair::Unit(axis)};
  }
  const Vector at = turned.rotation * engine.on_engine[i];
  const Vector line = at - engine.on_vehicle[i];
  const Vector direction = line.normalized();
  return {line.norm() - (engine.on_engine[i] - engine.on_vehicle[i]).norm(), direction,
          Pair(direction.dot(turned.axes[0].cross(at)), direction.dot(turned.axes[1].cross(at)))};
}

struct Friction {
  Pair torque;
  Pair bristle_rate;
};

/// What the level of a bearing's friction follows.
struct Load {
  double size = 0.0;   ///< |N| [N]
  double rated = 1.0;  ///< thrust over the rated one
};

Load load_of(const ReferenceVehicle::Engine& engine, double thrust, const Vector& on_bearing) {
  return {on_bearing.norm(), engine.rated_thrust > 0.0 ? thrust / engine.rated_thrust : 1.0};
}

Friction bristle(const ReferenceVehicle::Friction& law, const Load& load, const Pair& slip, const Pair& z) {
  const double sliding = law.level + law.coefficient * law.radius * load.size;
  if (sliding == 0.0) {
    return {Pair::Zero(), Pair::Zero()};
  }
  const double speed = slip.norm();
  const double gamma2 = 1.0 - (1.0 - law.vibration_ratio) * load.rated;
  const double vibrated = sliding * (1.0 + (gamma2 - 1.0) * std::exp(-speed / law.vibration_velocity));
  const double level = study::stribeck(vibrated, law.static_ratio, law.stribeck, speed);
  Pair rate = slip - law.stiffness * speed / level * z;
  if (speed > 0.0 && law.exponent != 1.0) {
    rate *= std::pow(rate.norm() / speed, law.exponent - 1.0);
  }
  // Half of the bound of physics.md section 4, for the least level.
  const double dies_at = law.damping > 0.0 ? 2.0 * std::sqrt(2.0 * std::numbers::e) * sliding * gamma2 / law.damping : 1.0;
  const double fading = std::exp(-(speed / dies_at) * (speed / dies_at));
  return {law.stiffness * z + law.damping * fading * rate + law.viscous * slip, rate};
}

/// Where force and torque would bring the bearing, or its engine's half beside a block: softer in translation while the
/// force does not seat it.
Six seat(const ReferenceVehicle::Engine& engine, const Vector& force, const Pair& torque) {
  const auto& compliance = engine.bearing_compliance;
  Six wrench;
  wrench << force, 0.0, torque;
  Six moved = (engine.block_mass > 0.0 ? 1.0 - engine.vehicle_side : 1.0) * compliance * wrench;
  if (engine.unloaded_stiffness < 1.0) {
    const Vector under_load = compliance.topLeftCorner<3, 3>() * force;
    const double squared = force.dot(under_load) / compliance(0, 0);
    const double fading = std::exp(-squared / (engine.seat_scale * engine.seat_scale));
    moved.head<3>() += (1.0 / engine.unloaded_stiffness - 1.0) * fading * under_load;
  }
  return moved;
}

/// Friction and the rate of the bearing, which depend on each other: the torque turns the bearing, whose rate is part of the
/// slip. The bristle's damping is weak against the bearing's, so that the repetition contracts.
Friction friction_on_bearing(const ReferenceVehicle::Engine& engine, const Load& load, const Pair& rate_of_engine,
                             const Pair& z, const Six& bearing, const Vector& force, Six& bearing_rate) {
  Friction friction{Pair::Zero(), Pair::Zero()};
  for (int i = 0; i < 60; ++i) {
    bearing_rate = (seat(engine, force, friction.torque) - bearing) / engine.loss_time;
    const Friction next = bristle(engine.friction, load, rate_of_engine - bearing_rate.tail<2>(), z);
    const double change = (next.torque - friction.torque).norm();
    friction = next;
    if (change <= 1e-15 * friction.torque.norm()) {
      break;
    }
  }
  return friction;
}

/// What the structure does at one engine.
struct Base {
  Pair moved = Pair::Zero();  ///< attach points pulled together [m]
  Pair turned = Pair::Zero();
  Pair turned_rate = Pair::Zero();
};

/// What an engine does to the structure.
struct OnStructure {
  Pair forces;
  Pair torques;
};

/// Newton's law of the block under the force and the torque of the joint. Returns the torque that the vehicle's half hands
/// on.
Pair block_derivative(const ReferenceVehicle::Engine& engine, const Base& base, const Vector& force, const Pair& torque,
                      const double* y, double* d) {
  const Eigen::Map<const Five> place(y);
  const Eigen::Map<const Five> rate(y + 5);
  Five moved = place + engine.loss_time * rate;
  moved.tail<2>() -= base.turned + engine.loss_time * base.turned_rate;
  const Five held = engine.block_stiffness * moved;
  Five wrench;
  wrench << force, torque;
  Five inertia;
  inertia << Vector::Constant(engine.block_mass), Pair::Constant(engine.block_inertia);
  const Five faster = (wrench - held).cwiseQuotient(inertia);
  std::copy(rate.begin(), rate.end(), d);
  std::copy(faster.begin(), faster.end(), d + 5);
  return held.tail<2>();
}

/// The equations of one engine, its states and their rates from `y` and `d` on.
OnStructure engine_derivative(const ReferenceVehicle::Engine& engine, const OnEngine& on, const Base& base, const double* y,
                              double* d) {
  const auto of = [&](int axis, int i) { return y[axis * kAxisStates + i]; };
  const Turned turned(of(0, kReferenceAngle), of(1, kReferenceAngle));
  const Eigen::Map<const Six> bearing(y + kBearing);
  const bool blocked = engine.block_mass > 0.0;
  const Vector translation =
      blocked ? Vector(bearing.head<3>() + Vector(y[kBlock], y[kBlock + 1], y[kBlock + 2])) : Vector(bearing.head<3>());
  const Pair base_rate = blocked ? Pair(y[kBlock + 8], y[kBlock + 9]) : base.turned_rate;
  OnStructure result;
  Pair torque = on.torque - on.thrust * engine.misalignment;
  Vector on_bearing = (on.thrust + engine.dead_load) * (turned.rotation * Vector::UnitX()) + on.force;
  for (int axis = 0; axis < 2; ++axis) {
    const Actuator actuator = actuator_of(engine, axis, turned, of(axis, kReferenceAngle));
    const double deflection =
        of(axis, kReferencePiston) - actuator.stroke - base.moved(axis) - actuator.direction.dot(translation);
    const double force = study::spring_force((*on.springs)[static_cast<std::size_t>(axis)], deflection);
    result.forces(axis) = force;
    on_bearing += force * actuator.direction;
    torque += force * actuator.arms;
  }

  const Pair rates(of(0, kReferenceAngleRate), of(1, kReferenceAngleRate));
  Six bearing_rate;
  const Pair z(y[kBristle], y[kBristle + 1]);
  const Load load = load_of(engine, on.thrust, on_bearing);
  const Friction friction = friction_on_bearing(engine, load, rates - base_rate, z, bearing, on_bearing, bearing_rate);
  const Pair on_vehicle =
      blocked ? block_derivative(engine, base, on_bearing, friction.torque, y + kBlock, d + kBlock) : friction.torque;
  Eigen::Map<Six>(d + kBearing) = bearing_rate;
  d[kBristle] = friction.bristle_rate(0);
  d[kBristle + 1] = friction.bristle_rate(1);

  for (int axis = 0; axis < 2; ++axis) {
    const ReferenceAxis& a = engine.axes[static_cast<std::size_t>(axis)];
    const double* own = y + axis * kAxisStates;
    double* own_rate = d + axis * kAxisStates;
    const double torque_motor = a.position_gain * (a.arm * on.commands[axis] - own[kReferencePiston]) -
                                a.pressure_gain * (own[kReferencePressure] - own[kReferenceWashout]);
    reference_hydraulics(a, study::clamp_to(torque_motor, 1.0), own, own_rate);
    own_rate[kReferencePiston] = own[kReferencePistonRate];
    own_rate[kReferencePistonRate] =
        (a.area * own[kReferencePressure] - result.forces(axis) - a.piston_damping * own[kReferencePistonRate]) /
        a.piston_mass;
    own_rate[kReferenceAngle] = own[kReferenceAngleRate];
    const double beside = a.duct_stiffness * (own[kReferenceAngle] - base.turned(axis)) +
                          a.damping * (own[kReferenceAngleRate] - base.turned_rate(axis));
    result.torques(axis) = on_vehicle(axis) + beside;
    const double across = a.cross_stiffness * of(1 - axis, kReferenceAngle) + a.cross_damping * rates(1 - axis);
    own_rate[kReferenceAngleRate] = (torque(axis) - friction.torque(axis) - beside - across) / a.inertia;
  }
  return result;
}

int derivative(double, N_Vector state, N_Vector result, void* user) {
  const Problem& problem = *static_cast<Problem*>(user);
  const ReferenceVehicle& vehicle = *problem.vehicle;
  const std::size_t engines = vehicle.engines.size();
  const double* y = N_VGetArrayPointer(state);
  double* d = N_VGetArrayPointer(result);
  const std::size_t own = engine_states(vehicle);
  const double* modes = y + engines * own;
  double* mode_rates = d + engines * own;

  // The modes without force; what the engines do comes on top.
  for (std::size_t k = 0; k < vehicle.modes.size(); ++k) {
    const ReferenceVehicle::Mode& mode = vehicle.modes[k];
    const double w = 2.0 * std::numbers::pi * mode.frequency;
    mode_rates[2 * k] = modes[2 * k + 1];
    mode_rates[2 * k + 1] = -2.0 * mode.damping * w * modes[2 * k + 1] - w * w * modes[2 * k];
  }
  for (std::size_t e = 0; e < engines; ++e) {
    Base base;
    for (std::size_t k = 0; k < vehicle.modes.size(); ++k) {
      const Eigen::Map<const Pair> attach(&vehicle.modes[k].attach[2 * e]);
      const Eigen::Map<const Pair> rotation(&vehicle.modes[k].rotation[2 * e]);
      base.moved += attach * modes[2 * k];
      base.turned += rotation * modes[2 * k];
      base.turned_rate += rotation * modes[2 * k + 1];
    }
    const OnStructure on = engine_derivative(vehicle.engines[e], on_engine(problem, e), base, y + e * own, d + e * own);
    for (std::size_t k = 0; k < vehicle.modes.size(); ++k) {
      const Eigen::Map<const Pair> attach(&vehicle.modes[k].attach[2 * e]);
      const Eigen::Map<const Pair> rotation(&vehicle.modes[k].rotation[2 * e]);
      mode_rates[2 * k + 1] += attach.dot(on.forces) + rotation.dot(on.torques);
    }
  }
  return 0;
}

std::vector<double> scales(const ReferenceVehicle& vehicle) {
  constexpr std::array<double, kAxisStates> kAxis{0.01, 1.0, 1e6, 1e6, 0.01, 0.1, 0.01, 0.1};
  std::vector<double> scale;
  for (std::size_t e = 0; e < vehicle.engines.size(); ++e) {
    scale.insert(scale.end(), kAxis.begin(), kAxis.end());
    scale.insert(scale.end(), kAxis.begin(), kAxis.end());
    scale.insert(scale.end(), 8, 1e-4);
    if (has_block(vehicle)) {
      scale.insert(scale.end(), 5, 1e-4);
      scale.insert(scale.end(), 5, 1e-2);
    }
  }
  for (std::size_t k = 0; k < vehicle.modes.size(); ++k) {
    scale.insert(scale.end(), {0.1, 1.0});
  }
  return scale;
}

}  // namespace

std::vector<std::vector<double>> integrate_reference(const ReferenceVehicle& vehicle, const ReferenceVehicle::Start& start,
                                                     const std::vector<ReferenceVehicle::Inputs>& inputs, double sample,
                                                     double tolerance, long* evaluations) {
  Problem problem{&vehicle};
  for (const ReferenceVehicle::Engine& engine : vehicle.engines) {
    problem.springs.push_back(engine.axes);
  }
  study::CvodeIntegrator integrator(derivative, &problem, scales(vehicle), tolerance);
  double* y = integrator.state();
  for (const ReferenceVehicle::Start::Engine& engine : start.engines) {
    for (int axis = 0; axis < 2; ++axis) {
      const auto& own = engine.axes[static_cast<std::size_t>(axis)];
      std::copy(own.begin(), own.end(), y + axis * kAxisStates);
    }
    std::copy(engine.bearing.begin(), engine.bearing.end(), y + kBearing);
    if (has_block(vehicle)) {
      std::copy(engine.block.begin(), engine.block.end(), y + kBlock);
    }
    y += engine_states(vehicle);
  }
  for (std::size_t k = 0; k < start.modes.size(); ++k) {
    y[2 * k] = start.modes[k];
  }
  std::vector<std::vector<double>> rows;
  rows.reserve(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    drive(problem, inputs[i]);
    integrator.advance(static_cast<double>(i + 1) * sample);
    std::vector<double> row;
    for (std::size_t e = 0; e < vehicle.engines.size(); ++e) {
      const double* now = integrator.state() + e * engine_states(vehicle);
      row.insert(row.end(), {now[kReferencePiston], now[kReferenceAngle], now[kAxisStates + kReferencePiston],
                             now[kAxisStates + kReferenceAngle]});
    }
    rows.push_back(std::move(row));
  }
  if (evaluations != nullptr) {
    *evaluations += integrator.evaluations();
  }
  return rows;
}

}  // namespace hotfire::test
