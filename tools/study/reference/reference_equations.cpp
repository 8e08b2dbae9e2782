// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/reference_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hotfire::study {
namespace {

/// Rate at which a play gives way beyond its width [1/s].
constexpr double kPlayGivesWay = 1e7;

struct Friction {
  double force = 0.0;
  double rate = 0.0;  ///< of the bristle
};

Friction lugre(const ReferenceAxis::Bristle& law, double growth, double velocity, double z) {
  if (law.level == 0.0) {
    return {};
  }
  const double vibrated = 1.0 + (law.vibration_ratio - 1.0) * std::exp(-std::abs(velocity) / law.vibration_velocity);
  const double level = growth * vibrated * stribeck(law.level, law.static_ratio, law.stribeck, velocity);
  const double rate = velocity - law.stiffness * std::abs(velocity) * z / level;
  const double fading = std::exp(-(velocity / law.damping_dies_at) * (velocity / law.damping_dies_at));
  return {law.stiffness * z + law.damping * fading * rate, rate};
}

/// Dahl's bristle behind a spring. Both carry the same torque, sigma0 z = k twist, so that the bristle's own velocity v
/// solves sigma0 (v - sigma0 |v| z / level) = k (w - v); v has the sign of w, and the factor of v is at least k in stick and
/// in slip.
Friction sprung_dahl(const ReferenceAxis::Bristle& law, double spring, double velocity, double z) {
  const double stuck = 1.0 - law.stiffness * z * sign(velocity) / law.level;
  const double own = spring * velocity / (spring + law.stiffness * stuck);
  return {law.stiffness * z, own * stuck};
}

Friction gimbal_friction(const ReferenceAxis& axis, double elapsed, double velocity, double angle, double z) {
  if (axis.gimbal_stiffness > 0.0) {
    return sprung_dahl(axis.bristle, axis.gimbal_stiffness, velocity, z);
  }
  const double growth = 1.0 + axis.unlisted.friction_growth * angle * angle;
  return lugre(axis.bristle, growth * (1.0 + axis.unlisted.friction_drift * elapsed), velocity, z);
}

Friction elastic_slip(const ReferenceAxis::Slip& law, double growth, double velocity, double stretch) {
  if (law.stiffness == 0.0) {
    return {};
  }
  const double level = growth * stribeck(law.level, law.static_ratio, law.stribeck, velocity);
  return {law.stiffness * stretch, velocity - law.gives_way * beyond(stretch, level / law.stiffness)};
}

/// Deflection of actuator and load in series under a force F >= 0.
double soft_deflection(const ReferenceAxis& axis, double force) {
  const double k = axis.actuator_stiffness;
  const double low = axis.low_stiffness;
  const double scale = axis.load_scale;
  double own = 0.0;
  if (axis.soft == ReferenceAxis::Soft::compliance) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * -std::expm1(-force / scale);
  } else if (axis.soft == ReferenceAxis::Soft::stiffness) {
    own = scale / k * std::log((k * std::exp(force / scale) - (k - low)) / low);
  } else if (axis.soft == ReferenceAxis::Soft::saturation) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * std::tanh(force / scale);
  } else {
    for (std::size_t i = 0; i < axis.stiffness_table.size(); ++i) {
      const bool last = i + 1 == axis.stiffness_table.size();
      const double from = axis.stiffness_table[i][0];
      const double to = last ? std::numeric_limits<double>::infinity() : axis.stiffness_table[i + 1][0];
      const double here = 1.0 / axis.stiffness_table[i][1];
      const double next = last ? here : 1.0 / axis.stiffness_table[i + 1][1];
      own += std::clamp(force - from, 0.0, to - from) * 0.5 * (here + next);
    }
  }
  return own + force / axis.load_stiffness;
}

}  // namespace

double spring_force(const ReferenceAxis& axis, double deflection) {
  const double total = 1.0 / (1.0 / axis.actuator_stiffness + 1.0 / axis.load_stiffness);
  const double played = beyond(deflection, axis.backlash);
  if (axis.soft == ReferenceAxis::Soft::none) {
    return total * played;
  }
  // Bisection: the force lies between none and that of the stiff branch.
  const double wanted = std::abs(played);
  double low = 0.0;
  double high = total * wanted;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) {
      break;
    }
    (soft_deflection(axis, middle) < wanted ? low : high) = middle;
  }
  return sign(played) * high;
}

namespace {

struct Lever {
  double stroke = 0.0;  ///< of the actuator [m]
  double arm = 0.0;     ///< its derivative [m]
};

/// With p the product of the two distances from the pivot, length^2 = const - 2 p cos(angle + beta).
Lever lever_of(const ReferenceAxis& a, double beta) {
  if (a.linkage.length == 0.0) {
    return {a.arm * beta * (1.0 + beta * (a.arm_linear / 2.0 + a.arm_quadratic * beta / 3.0)),
            a.arm * (1.0 + beta * (a.arm_linear + a.arm_quadratic * beta))};
  }
  const double product = a.arm * a.linkage.length / std::sin(a.linkage.angle);
  const double length = std::sqrt(a.linkage.length * a.linkage.length +
                                  2.0 * product * (std::cos(a.linkage.angle) - std::cos(a.linkage.angle + beta)));
  return {length - a.linkage.length, product * std::sin(a.linkage.angle + beta) / length};
}

double reading_without_lag(const ReferenceAxis::Sensor& sensor, double x) {
  double y = x * (1.0 + x * (sensor.quadratic + sensor.cubic * x));
  for (const ReferenceAxis::Bump& bump : sensor.bumps) {
    const double distance = (x - bump.at) / bump.width;
    y += bump.height * std::exp(-distance * distance);
  }
  return y;
}

/// What a drawn law adds at each site.
using WildSums = std::array<double, kWildSites>;

double at_site(const WildSums& sums, WildSite site) { return sums[static_cast<std::size_t>(site)]; }

double valve_flow(const ReferenceAxis& a, double elapsed, const StateVector& y, double further_opening) {
  const double lapped = beyond(y[kSpool], a.deadband);
  const double opening = lapped * (1.0 + a.asymmetry * sign(lapped)) * (1.0 + a.unlisted.flow_curvature * lapped * lapped) *
                             (1.0 + a.unlisted.gain_drift * elapsed) +
                         further_opening;
  const double supply = a.supply - y[kSupplyDroop];
  // Rated flow is the flow at the declared supply pressure.
  return a.rated_flow * opening * std::sqrt(std::max(0.0, (supply - sign(opening) * y[kPressure]) / a.supply));
}

/// Opening, flow and pressure; `d` gets their rates.
void oil(const ReferenceAxis& a, double elapsed, const StateVector& y, const WildSums& wild, StateVector& d) {
  const double p = y[kPressure];
  const double turbulent = a.orifice_leak * p * std::sqrt(a.supply / (std::abs(p) + 1e-3 * a.supply));
  const double flow = valve_flow(a, elapsed, y, at_site(wild, WildSite::valve)) + at_site(wild, WildSite::flow);
  const double modulus =
      a.bulk_modulus * (1.0 - a.unlisted.aeration * std::exp(-std::abs(p) / a.unlisted.aeration_pressure));
  d[kPressure] = 4.0 * modulus / a.volume *
                     (flow - a.area * y[kPistonRate] - (a.leakage + a.laminar_leak) * p - turbulent -
                      a.unlisted.relief * beyond(p, a.unlisted.relief_from)) +
                 at_site(wild, WildSite::pressure);
  d[kWashout] = a.pressure_corner * (p - y[kWashout]);
  if (a.unlisted.supply_droop > 0.0) {
    d[kSupplyDroop] = (a.unlisted.supply_droop * std::abs(flow) - y[kSupplyDroop]) / a.unlisted.supply_recovery;
  }
}

}  // namespace

std::vector<ReferenceState> states_of(const ReferenceAxis& axis) {
  std::vector<ReferenceState> states;
  const auto add = [&](ReferenceState state, bool there) {
    if (there) {
      states.push_back(state);
    }
  };
  for (int s = kSpool; s <= kAngleRate; ++s) {
    add(static_cast<ReferenceState>(s), true);
  }
  add(kPlay, axis.play > 0.0);
  add(kSeal, axis.seal.stiffness > 0.0);
  add(kBristle, axis.bristle.level > 0.0);
  add(kSealBristle, axis.seal_bristle.level > 0.0);
  add(kMode, axis.mode_shape > 0.0);
  add(kModeRate, axis.mode_shape > 0.0);
  add(kPistonReading, axis.piston_sensor.lag > 0.0);
  add(kEngineReading, axis.engine_sensor.lag > 0.0);
  add(kSupplyDroop, axis.unlisted.supply_droop > 0.0);
  add(kCreep, axis.unlisted.creep_stiffness > 0.0);
  add(kJoint, axis.unlisted.joint.stiffness > 0.0);
  add(kWiper, axis.unlisted.wiper_play > 0.0);
  add(kCommand, axis.unlisted.command_lag > 0.0);
  const std::size_t remembered = axis.wild ? axis.wild->memory.states() : 0;
  for (std::size_t i = 0; i < remembered; ++i) {
    add(static_cast<ReferenceState>(kWild0 + i), true);
  }
  return states;
}

double command_at(const ReferenceProblem& problem, double t) {
  const double reach = problem.axis.rate_limit * (t - problem.start_time);
  return t > problem.start_time ? problem.command_start + clamp_to(problem.command - problem.command_start, reach)
                                : problem.command_start;
}

double torque_motor(const ReferenceAxis& axis, double command, double elapsed, const StateVector& y) {
  return axis.position_gain * (axis.arm * command - axis.position_feedback * y[kPiston]) -
         axis.pressure_gain * (y[kPressure] - y[kWashout]) + axis.unlisted.null_offset + axis.unlisted.null_drift * elapsed;
}

namespace {

/// A limit of infinity makes the command jump at the start of the interval.
double command_now(const ReferenceProblem& problem, double t) {
  return std::isinf(problem.axis.rate_limit) ? problem.command : command_at(problem, t);
}

double deflection_of(const ReferenceAxis& axis, const Lever& lever, const StateVector& y) {
  return y[kPiston] - lever.stroke - axis.mode_shape * y[kMode] - y[kCreep];
}

WildStates wild_states(const StateVector& y) { return {y[kWild0], y[kWild1], y[kWild2], y[kWild3]}; }

/// What the drawn law adds at its site, and the rates of its memory.
WildSums wild_sums(const ReferenceProblem& problem, double t, const StateVector& y, StateVector* d) {
  WildSums sums{};
  if (!problem.axis.wild) {
    return sums;
  }
  const WildLaw& law = *problem.axis.wild;
  const double signal = law.signal(quantities_at(problem, t, y));
  const WildStates states = wild_states(y);
  sums[static_cast<std::size_t>(law.site)] = wild_output(law, signal, t - problem.first_row, states, problem.wild_rows);
  // A swing begins with the record; every other memory comes to rest before it.
  if (d != nullptr && (t >= problem.first_row || law.memory.kind != WildMemory::Kind::swing)) {
    const WildStates rates = memory_rates(law, memory_input(law, signal), states);
    std::copy(rates.begin(), rates.end(), d->begin() + kWild0);
  }
  return sums;
}

}  // namespace

WildQuantities quantities_at(const ReferenceProblem& problem, double t, const StateVector& y) {
  const ReferenceAxis& axis = problem.axis;
  const double elapsed = std::max(0.0, t - problem.first_row);
  const double command = command_now(problem, t);
  // In the order of WildArgument.
  return {y[kPiston],
          y[kPistonRate],
          y[kAngle],
          y[kAngleRate],
          y[kPressure],
          valve_flow(axis, elapsed, y, 0.0),
          deflection_of(axis, lever_of(axis, y[kAngle]), y),
          y[kSpool],
          command,
          axis.arm * command - y[kPiston],
          torque_motor(axis, command, elapsed, y),
          elapsed};
}

StateVector derivative(const ReferenceProblem& problem, double t, const StateVector& y) {
  const ReferenceAxis& a = problem.axis;
  const double elapsed = std::max(0.0, t - problem.first_row);
  StateVector d{};
  const WildSums wild = wild_sums(problem, t, y, &d);

  const double angle = command_now(problem, t);
  const bool lags = a.unlisted.command_lag > 0.0;
  const double asked = torque_motor(a, (lags ? y[kCommand] : angle) + at_site(wild, WildSite::command), elapsed, y) +
                       at_site(wild, WildSite::valve_command);
  const double valve_command = clamp_to(asked, 1.0) - clamp_to(y[kPlay], a.play);
  d[kSpool] = clamp_to(y[kSpoolRate], a.unlisted.slew);
  d[kSpoolRate] = a.valve_frequency * a.valve_frequency * (valve_command - y[kSpool]) -
                  2.0 * a.valve_damping * a.valve_frequency * y[kSpoolRate];
  oil(a, elapsed, y, wild, d);

  const double v = y[kPistonRate];
  const double w = y[kAngleRate];
  const double beta = y[kAngle];
  const Lever lever = lever_of(a, beta);
  const double deflection = deflection_of(a, lever, y) + at_site(wild, WildSite::load_spring);
  const Friction joint = elastic_slip(a.unlisted.joint, 1.0, v - lever.arm * w, y[kJoint]);
  const double force = spring_force(a, deflection) * (1.0 + a.unlisted.spring_drift * elapsed) +
                       a.unlisted.spring_damping * (v - lever.arm * w) + joint.force;
  const Friction seal = elastic_slip(a.seal, 1.0 + a.unlisted.seal_squeeze * std::abs(y[kPressure]), v, y[kSeal]);
  const Friction seal_bristle = lugre(a.seal_bristle, 1.0, v, y[kSealBristle]);
  const double damping = a.piston_damping + a.unlisted.cushion * std::abs(beyond(y[kPiston], a.unlisted.cushion_from)) +
                         a.unlisted.orifice_damping * std::abs(v);
  d[kPiston] = v;
  d[kPistonRate] =
      (a.area * y[kPressure] - force - damping * v - seal.force - seal_bristle.force + at_site(wild, WildSite::piston)) /
      a.piston_mass;

  const double coulomb = a.coulomb.level * std::tanh(w / a.coulomb.creep);
  const Friction bristle = gimbal_friction(a, elapsed, w, beta, y[kBristle]);
  const double forcing =
      a.unlisted.periodic_torque * std::sin(2.0 * std::numbers::pi * a.unlisted.periodic_frequency * elapsed);
  const double hose = a.unlisted.hose * std::max(0.0, problem.other_angle - a.unlisted.hose_slack);
  d[kAngle] = w;
  d[kAngleRate] = (lever.arm * force - a.damping * w - a.duct_stiffness * beta - a.duct_cubic * beta * beta * beta -
                   a.torque_offset - a.cross_stiffness * problem.other_angle - a.cross_damping * problem.other_rate - hose -
                   coulomb - bristle.force - forcing + at_site(wild, WildSite::engine_torque)) /
                  a.inertia;

  const double torque_motor_rate =
      -a.position_gain * a.position_feedback * v - a.pressure_gain * (d[kPressure] - d[kWashout]);
  d[kPlay] = (std::abs(asked) < 1.0 ? torque_motor_rate : 0.0) - kPlayGivesWay * beyond(y[kPlay], a.play);
  d[kSeal] = seal.rate;
  d[kSealBristle] = seal_bristle.rate;
  d[kBristle] = bristle.rate;
  const double natural = 2.0 * std::numbers::pi * a.mode_frequency;
  d[kMode] = y[kModeRate];
  d[kModeRate] = a.mode_shape * force - 2.0 * a.mode_damping * natural * y[kModeRate] - natural * natural * y[kMode];
  if (a.piston_sensor.lag > 0.0) {
    d[kPistonReading] = (reading_without_lag(a.piston_sensor, y[kPiston]) - y[kPistonReading]) / a.piston_sensor.lag;
  }
  if (a.engine_sensor.lag > 0.0) {
    d[kEngineReading] = (reading_without_lag(a.engine_sensor, beta) - y[kEngineReading]) / a.engine_sensor.lag;
  }
  if (a.unlisted.creep_stiffness > 0.0) {
    d[kCreep] = (force / a.unlisted.creep_stiffness - y[kCreep]) / a.unlisted.creep_time;
  }
  if (lags) {
    d[kCommand] = (angle - y[kCommand]) / a.unlisted.command_lag;
  }
  d[kJoint] = joint.rate;
  d[kWiper] = v - kPlayGivesWay * beyond(y[kWiper], a.unlisted.wiper_play);
  return d;
}

void begin_row(ReferenceProblem& problem, double t, const StateVector& y) {
  if (problem.axis.wild) {
    const WildLaw& law = *problem.axis.wild;
    problem.wild_rows.begin_row(law, t - problem.first_row, memory_input(law, law.signal(quantities_at(problem, t, y))));
  }
}

std::array<double, 3> readings(const ReferenceProblem& problem, double t, const StateVector& y) {
  const ReferenceAxis& axis = problem.axis;
  const ReferenceAxis::Unlisted& unlisted = axis.unlisted;
  const double moved = y[kPiston] - y[kWiper];
  const double elapsed = t - problem.first_row;
  const double hum = unlisted.hum * std::sin(2.0 * std::numbers::pi * unlisted.hum_frequency * elapsed);
  const WildSums wild = wild_sums(problem, t, y, nullptr);
  return {(axis.piston_sensor.lag > 0.0 ? y[kPistonReading] : reading_without_lag(axis.piston_sensor, moved)) +
              at_site(wild, WildSite::piston_sensor),
          (axis.engine_sensor.lag > 0.0 ? y[kEngineReading] : reading_without_lag(axis.engine_sensor, y[kAngle])) + hum +
              at_site(wild, WildSite::engine_sensor),
          y[kPressure]};
}

}  // namespace hotfire::study
