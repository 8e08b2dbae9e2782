// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>

#include "tools/explain/fit/scales.hpp"

namespace hotfire::explain {

namespace {

using model::Site;

constexpr int kPoints = 400;
constexpr double kStep = 1e-3;

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) {
    most = std::max(most, std::abs(v));
  }
  return most;
}

/// Largest rate over a twentieth of a second: differences of neighbours would show noise.
double largest_rate(const std::vector<double>& values, double period) {
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(0.05 / period));
  double most = 0.0;
  for (std::size_t i = apart; i < values.size(); ++i) {
    most = std::max(most, std::abs(values[i] - values[i - apart]) / (static_cast<double>(apart) * period));
  }
  return most;
}

/// A force over one settled cycle of a sine of given position and rate amplitudes, against the rate or the position.
template <class E, class Params>
CurveSeries cycle(const Params& params, double position, double rate, bool against_rate) {
  const double w = rate / position;
  const double period = 2.0 * std::numbers::pi / w;
  const double h = period / kPoints;
  typename E::template State<double> state{};
  CurveSeries drawn;
  for (int i = 0; i < 3 * kPoints; ++i) {
    const double phase = w * h * (i + 0.5);
    const double v = rate * std::cos(phase);
    const double force = E::step(params, state, model::Motion<double>{position * std::sin(phase), v, v, 1e-30, h});
    if (i >= 2 * kPoints) {
      drawn.x.push_back(against_rate ? v : position * std::sin(phase));
      drawn.y.push_back(force);
    }
  }
  return drawn;
}

/// True if the force of an effect changes with the rate at a fixed position.
template <class E, class Params>
bool depends_on_rate(const Params& params, double position, double rate) {
  typename E::template State<double> still{};
  typename E::template State<double> moving{};
  const double at_rest = E::step(params, still, model::Motion<double>{position, 0.0, 0.0, 1e-30, kStep});
  const double in_motion = E::step(params, moving, model::Motion<double>{position, rate, rate, 1e-30, kStep});
  return at_rest != in_motion;
}

template <class E, class Params>
Curve motion_curve(const Params& params, double position, double rate, const std::string& mover,
                   const std::string& angle_unit, const std::string& force, const std::string& force_unit) {
  const bool against_rate = depends_on_rate<E>(params, position, rate);
  std::vector<CurveSeries> series;
  for (const double part : {1.0, 0.2}) {
    series.push_back(cycle<E>(params, part * position, part * rate, against_rate));
    series.back().name = fmt::format("sine at {:.0f} % of the largest motion", 100.0 * part);
    if (!against_rate) {
      series.back().name = "as found";
      break;
    }
  }
  return {{against_rate ? mover + " rate" : mover + (angle_unit == "rad" ? " angle" : " position"),
           against_rate ? angle_unit + "/s" : angle_unit, force, force_unit},
          series};
}

/// Output against input of a stateless or hysteretic signal effect over a slow cycle, or its step response.
template <class E, class Params>
Curve signal_curve(const Params& params, double reach, const std::string& what, const std::string& unit) {
  typename E::template State<double> state{};
  CurveSeries drawn{"as found", {}, {}};
  if constexpr (E::site == Site::command || std::string_view(E::name) == "sensor_lag") {
    if constexpr (requires { E::settle(params, state, model::Signal<double>{0.0, kStep}); }) {
      E::settle(params, state, model::Signal<double>{0.0, kStep});
    }
    for (int i = 0; i < kPoints / 4; ++i) {
      drawn.x.push_back(i * kStep);
      drawn.y.push_back(E::step(params, state, model::Signal<double>{reach, kStep}));
    }
    return {{"time after a step", "s", what, unit}, {drawn}};
  } else {
    for (int i = 0; i < 2 * kPoints; ++i) {
      const double x = reach * std::sin(2.0 * std::numbers::pi * i / kPoints);
      const double y = E::step(params, state, model::Signal<double>{x, kStep});
      if (i >= kPoints) {
        drawn.x.push_back(x);
        drawn.y.push_back(E::site == Site::sensor ? y - x : y);
      }
    }
    return {{what, unit, E::site == Site::sensor ? "error of the reading" : what + " after the effect", unit}, {drawn}};
  }
}

template <class E, class Params>
Curve spring_curve(const SimplexParameters& p, const Params& params, const Reach& reach) {
  const double stiffness = 1.0 / (1.0 / p.actuator.stiffness + 1.0 / p.structure.stiffness);
  typename E::template State<double> state{};
  CurveSeries found{"with the effect", {}, {}};
  CurveSeries declared{"declared", {}, {}};
  if constexpr (std::string_view(E::name) == "variable_moment_arm") {
    for (int i = 0; i <= kPoints; ++i) {
      const double angle = reach.angle * (2.0 * i / kPoints - 1.0);
      const auto out = E::step(params, state,
                               model::Spring<double>{0.0, angle, p.actuator.moment_arm, p.actuator.moment_arm, stiffness,
                                                     p.actuator.stiffness, p.structure.stiffness, kStep});
      found.x.push_back(angle);
      found.y.push_back(out.arm);
    }
    return {{"engine angle", "rad", "moment arm", "m"}, {found}};
  } else {
    for (int i = 0; i <= kPoints; ++i) {
      const double deflection = reach.deflection * (2.0 * i / kPoints - 1.0);
      const model::Spring<double> input{deflection,
                                        0.0,
                                        p.actuator.moment_arm,
                                        p.actuator.moment_arm,
                                        stiffness,
                                        p.actuator.stiffness,
                                        p.structure.stiffness,
                                        kStep};
      // A law that is solved from its last force is solved anew at each point; others see each point twice.
      if constexpr (requires { E::remembers_a_guess; }) {
        E::settle(params, state, input);
      } else {
        E::step(params, state, input);
      }
      const auto out = E::step(params, state, input);
      found.x.push_back(deflection);
      found.y.push_back(stiffness * out.deflection);
      declared.x.push_back(deflection);
      declared.y.push_back(stiffness * deflection);
    }
    return {{"deflection of actuator and load", "m", "force", "N"}, {found, declared}};
  }
}

template <class E, class Params>
Curve structure_curve(const Params& params) {
  typename E::template State<double> state{};
  CurveSeries drawn{"as found", {}, {}};
  for (int i = 0; i < 2000; ++i) {
    drawn.x.push_back(i * kStep);
    drawn.y.push_back(E::step(params, state, model::AttachPoint<double>{1.0, kStep}));
  }
  return {{"time after a step of 1 N", "s", "motion of the attach point", "m"}, {drawn}};
}

/// Torque from the other axis over one cycle of a sine of its largest motion.
template <class E, class Params>
Curve other_axis_curve(const Params& params, const Reach& reach) {
  typename E::template State<double> state{};
  CurveSeries drawn{"sine at the largest motion of the other axis", {}, {}};
  for (int i = 0; i <= kPoints; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / kPoints;
    model::Motion<double> motion{0.0, 0.0, 0.0, 1e-30, kStep};
    motion.other_angle = reach.other_angle * std::sin(phase);
    motion.other_rate = reach.other_rate * std::cos(phase);
    drawn.x.push_back(motion.other_angle);
    drawn.y.push_back(E::step(params, state, motion));
  }
  return {{"engine angle about the other axis", "rad", "torque against the motion", "N.m"}, {drawn}};
}

template <class E, class Params>
Curve effect_curve(const SimplexParameters& p, const Params& params, const Reach& reach) {
  if constexpr (model::needs_other_axis<E>()) {
    return other_axis_curve<E>(params, reach);
  } else if constexpr (E::site == Site::engine_torque) {
    return motion_curve<E>(params, reach.angle, reach.angle_rate, "engine", "rad", "torque against the motion", "N.m");
  } else if constexpr (E::site == Site::piston) {
    return motion_curve<E>(params, reach.position, reach.position_rate, "piston", "m", "force against the motion", "N");
  } else if constexpr (E::site == Site::load_spring) {
    return spring_curve<E>(p, params, reach);
  } else if constexpr (E::site == Site::structure) {
    return structure_curve<E>(params);
  } else if constexpr (E::site == Site::flow) {
    typename E::template State<double> state{};
    CurveSeries drawn{"as found", {}, {}};
    for (int i = 0; i <= kPoints; ++i) {
      const double pressure = reach.pressure * (2.0 * i / kPoints - 1.0);
      drawn.x.push_back(pressure);
      drawn.y.push_back(E::step(params, state, model::Hydraulics<double>{pressure, 0.0, p.actuator.supply_pressure, kStep}));
    }
    return {{"load pressure", "Pa", "flow into the extend chamber", "m^3/s"}, {drawn}};
  } else if constexpr (E::site == Site::command) {
    return signal_curve<E>(params, p.actuator.moment_arm * reach.input, "commanded piston position", "m");
  } else if constexpr (E::site == Site::sensor) {
    const double sizes[] = {reach.position, reach.angle, reach.pressure};
    const auto channel = static_cast<std::size_t>(params.option);
    return signal_curve<E>(params, sizes[channel], "reading", std::string(model::Simplex<double>::channel_units[channel]));
  } else {
    return signal_curve<E>(params, 0.2, E::site == Site::valve ? "spool position" : "valve command", "1");
  }
}

/// The deflection that a transmission still has after its effect.
template <class E, class Params>
Curve play_curve(const Params& params, double reach) {
  typename E::template State<double> state{};
  CurveSeries drawn{"as found", {}, {}};
  for (int i = 0; i <= kPoints; ++i) {
    const double x = reach * (2.0 * i / kPoints - 1.0);
    drawn.x.push_back(x);
    drawn.y.push_back(E::step(params, state, model::Spring<double>{x, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, kStep}).deflection);
  }
  return {{"motor less load", "position", "deflection of the transmission", "position"}, {drawn}};
}

/// Of every plant but a hydraulic axis.
template <class E, class Parameters, class Params>
requires(!std::same_as<Parameters, SimplexParameters>) Curve
    effect_curve(const Parameters&, const Params& params, const Reach& reach) {
  if constexpr (E::site == Site::command && std::same_as<Parameters, ElectromechanicalParameters>) {
    return signal_curve<E>(params, reach.input, "setpoint", "");
  } else if constexpr (E::site == Site::command) {
    return signal_curve<E>(params, reach.input, "input of the drive", "force");
  } else if constexpr (E::site == Site::drive) {
    return signal_curve<E>(params, reach.drive, "motor command", "command");
  } else if constexpr (E::site == Site::transmission) {
    return play_curve<E>(params, reach.deflection);
  } else {
    return motion_curve<E>(params, reach.position, reach.position_rate, "mass", "position", "force against the motion",
                           "force");
  }
}

Reach reach_in(const Dataset& data, const SimplexParameters& parameters) {
  Reach reach;
  for (const Experiment& e : data.experiments) {
    reach.input = std::max(reach.input, largest(e.input));
    if (!e.measured[0].empty()) {
      reach.position = std::max(reach.position, largest(e.measured[0]));
      reach.position_rate = std::max(reach.position_rate, largest_rate(e.measured[0], e.period));
    }
    if (!e.measured[1].empty()) {
      reach.angle = std::max(reach.angle, largest(e.measured[1]));
      reach.angle_rate = std::max(reach.angle_rate, largest_rate(e.measured[1], e.period));
    }
    reach.other_angle = std::max(reach.other_angle, largest(e.other.angle));
    reach.other_rate = std::max(reach.other_rate, largest(e.other.rate));
  }
  // What is not measured follows from the geometry and from the pressure that the duct stiffness asks for.
  const double arm = parameters.actuator.moment_arm;
  reach.angle = std::max(reach.angle, reach.position / arm);
  reach.angle_rate = std::max(reach.angle_rate, reach.position_rate / arm);
  reach.position = std::max(reach.position, reach.angle * arm);
  reach.position_rate = std::max(reach.position_rate, reach.angle_rate * arm);
  const double stiffness = 1.0 / (1.0 / parameters.actuator.stiffness + 1.0 / parameters.structure.stiffness);
  const double force = 0.1 * parameters.actuator.supply_pressure * parameters.actuator.piston_area;
  reach.deflection = force / stiffness;
  reach.pressure = 0.1 * parameters.actuator.supply_pressure;
  return reach;
}

Reach reach_in(const Dataset& data, const DirectParameters&) {
  Reach reach;
  for (const Experiment& e : data.experiments) {
    reach.input = std::max(reach.input, largest(e.input));
    const std::vector<double> position = position_of(e);
    reach.position = std::max(reach.position, largest(position));
    const std::vector<double>& velocity = e.measured[model::Direct<double>::kVelocity];
    reach.position_rate = std::max(reach.position_rate, largest(velocity));
    // A direct mass may move faster than a tenth of a second: neighbours, and their noise, it is.
    for (std::size_t i = 1; velocity.empty() && i < position.size(); ++i) {
      reach.position_rate = std::max(reach.position_rate, std::abs(position[i] - position[i - 1]) / e.period);
    }
  }
  return reach;
}

Reach reach_in(const Dataset& data, const ImposedMotionParameters&) {
  Reach reach;
  for (const Experiment& e : data.experiments) {
    reach.input = std::max(reach.input, largest(e.input));
    reach.position = std::max(reach.position, largest(e.input));
    for (std::size_t i = 1; i < e.input.size(); ++i) {
      reach.position_rate = std::max(reach.position_rate, std::abs(e.input[i] - e.input[i - 1]) / e.period);
    }
  }
  return reach;
}

Reach reach_in(const Dataset& data, const ModalParameters& parameters) {
  Reach reach;
  for (const Experiment& e : data.experiments) {
    const JointMotion joint = joint_motion(data, e, parameters);
    reach.input = std::max(reach.input, largest(e.input));
    reach.position = std::max(reach.position, largest(joint.position));
    reach.position_rate = std::max(reach.position_rate, largest(joint.rate));
  }
  return reach;
}

Reach reach_in(const Dataset& data, const ElectromechanicalParameters& parameters) {
  Reach reach;
  for (const Experiment& e : data.experiments) {
    const LoadMotion load = load_motion(data, e, parameters);
    reach.input = std::max(reach.input, largest(e.input));
    reach.drive = std::max(reach.drive, largest(load.command));
    reach.position = std::max(reach.position, largest(load.position));
    reach.position_rate = std::max(reach.position_rate, largest(load.rate));
    reach.deflection = std::max(reach.deflection, largest(load.twist));
  }
  return reach;
}

}  // namespace

Reach reach_of(const Dataset& data, const ModelParameters& parameters) {
  return std::visit([&](const auto& own) { return reach_in(data, own); }, parameters);
}

Curve curve_of(const ModelParameters& parameters, std::size_t effect, const Reach& reach) {
  Curve result;
  std::visit(
      [&](const auto& own) {
        model::visit_effects(own, [&]<class E>(std::size_t index, const auto& values) {
          if constexpr (requires { E::is_unlisted; }) {
            return;
          } else if (index == effect) {
            result = effect_curve<E>(own, values, reach);
          }
        });
      },
      parameters);
  return result;
}

}  // namespace hotfire::explain
