// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>

#include "model/effects.hpp"

namespace hotfire::test {

/// The effects that an electromechanical actuator has and no other plant.
using EffectsOfMotors =
    model::EffectList<model::DriveDeadbandAt<model::Site::drive>, model::DriveSaturationAt<model::Site::drive>,
                      model::MotorFriction, model::BacklashAt<model::Site::transmission>>;

/// Calls `f.template operator()<E>(option)` for every effect of a hydraulic axis, a mass and a motor, and every law or
/// channel it can be set to.
template <class F>
void for_each_law(F&& f) {
  const auto visit = [&]<class E, std::size_t>() {
    const int options = std::max(1, static_cast<int>(E::options.size()));
    for (int option = 0; option < options; ++option) {
      f.template operator()<E>(option);
    }
  };
  model::SimplexEffects::for_each(visit);
  model::DirectEffects::for_each(visit);
  EffectsOfMotors::for_each(visit);
}

/// "gimbal_friction lugre": what a failed check is reported with.
template <class E>
std::string label(int option) {
  std::string text{E::name};
  if constexpr (E::options.size() > 0) {
    text.append(" ").append(E::options[static_cast<std::size_t>(option)]);
  }
  return text;
}

/// Number of the law or channel of that name; a name that the effect does not have does not compile.
template <class E>
consteval int option_named(std::string_view name) {
  for (std::size_t i = 0; i < E::options.size(); ++i) {
    if (E::options[i] == name) {
      return static_cast<int>(i);
    }
  }
  throw "no such option";
}

template <class E, class S>
using ParamsOf = typename E::template Params<S>;
template <class E, class S>
using StateOf = typename E::template State<S>;
template <class E, class S>
using InputOf = typename model::SiteInput<E::site, S>::type;

/// True if the law or channel `option` of the owner uses the field.
template <class Field>
bool used_by(const Field& field, int option) {
  return model::is_used(field.options, option);
}

template <class E>
constexpr bool is_unlisted() {
  return requires { E::is_unlisted; };
}

/// True for an effect that adds nothing of its own and changes what another one sees.
template <class E>
constexpr bool carries_another() {
  return requires { E::carries; };
}

/// True for a term that time itself moves: it has no steady state.
template <class E>
bool depends_on_time(int option) {
  if constexpr (is_unlisted<E>()) {
    const std::string_view law = E::options[static_cast<std::size_t>(option)];
    return law.ends_with("time") || law == "oscillator" || (law == "periodic" && !requires { E::is_term; }) ||
           std::is_same_v<E, model::UnlistedDrift> || std::is_same_v<E, model::UnlistedRipple>;
  }
  return false;
}

/// A table of five points over what the smooth inputs of these tests run through; ordinates are `size` times the typical
/// one, all positive and rising if it is positive.
template <class E, class S>
void lay_table(ParamsOf<E, S>& params, int option, double size) {
  if constexpr (requires { ParamsOf<E, S>::tables(); }) {
    for (const auto& field : ParamsOf<E, S>::tables()) {
      if (!model::is_used(field.options, option)) {
        continue;
      }
      const double reach = field.x_name == "load_pressure"       ? 4e6
                           : field.x_name == "rate"              ? 5.0
                           : field.x_name.starts_with("load_of") ? 2e4
                           : field.x_name == "deflection"        ? 5e-4
                           : field.x_name == "recent_flow"       ? 5e-4
                                                                 : 0.1;
      auto& table = params.*field.member;
      table.points = 5;
      for (std::size_t i = 0; i < 5; ++i) {
        table.x[i] = S(reach * (0.5 * static_cast<double>(i) - 1.0));
        table.y[i] = S(size * field.y_typical * (0.2 + static_cast<double>(i)));
      }
    }
  }
}

template <class E>
constexpr bool is_term() {
  return requires { E::is_term; };
}

/// True for a memory that loses information: its output jumps, and has no derivative by where it does. A slew sets in at a
/// step of the plant, which its limit moves to another, and a dead zone and a saturation have a corner.
template <class E>
bool jumps(int option) {
  if constexpr (is_term<E>()) {
    const auto kind = static_cast<model::Memory>(option);
    return kind == model::Memory::hold || kind == model::Memory::quantise || kind == model::Memory::periodic ||
           kind == model::Memory::dead_zone || kind == model::Memory::saturation || kind == model::Memory::slew;
  }
  return false;
}

/// A term as it may be found: over a quantity of its own site, of a usual size there.
template <class E, class S>
void set_term(ParamsOf<E, S>& params) {
  using model::Argument;
  using model::Site;
  struct Usual {
    Argument argument;
    double gain;
    double width;
  };
  const Usual usual = E::site == Site::command         ? Usual{Argument::command, 0.05, 0.01}
                      : E::site == Site::valve_command ? Usual{Argument::valve_command, 0.05, 0.05}
                      : E::site == Site::valve         ? Usual{Argument::spool, 0.05, 0.05}
                      : E::site == Site::flow          ? Usual{Argument::load_pressure, -2e-11, 5e5}
                      : E::site == Site::piston        ? Usual{Argument::rate, 2e4, 0.02}
                      : E::site == Site::load_spring   ? Usual{Argument::deflection, 0.1, 5e-5}
                      : E::site == Site::engine_torque ? Usual{Argument::angle_rate, 1e4, 0.02}
                      : E::sensor_channel == 0         ? Usual{Argument::position, 0.05, 5e-3}
                                                       : Usual{Argument::angle, 0.05, 5e-3};
  params.argument = static_cast<int>(usual.argument);
  const auto kind = static_cast<model::Memory>(params.option);
  // The gain of an oscillator is its amplitude: what a usual argument gives otherwise.
  params.gain = S(kind == model::Memory::oscillator ? usual.gain * usual.width : usual.gain);
  params.direct = S(kind == model::Memory::none ? 0.0 : 0.3 * usual.gain);
  // The width of a power is the size of the largest motion, that of a slew is a rate.
  const bool is_wide = kind == model::Memory::slew || model::is_power(kind);
  params.width = S(is_wide ? 20.0 * usual.width : usual.width);
  params.table.points = 0;
  if (kind == model::Memory::stops) {
    params.table.points = 2;
    params.table.x = {S(0.5 * usual.width), S(usual.width)};
    params.table.y = {S(usual.gain), S(0.5 * usual.gain)};
  }
}

/// The defaults of an effect set to one of its laws. A law given by a table gets the declared stiffness at two loads.
template <class E, class S>
ParamsOf<E, S> neutral(int option) {
  ParamsOf<E, S> params;
  params.option = option;
  if constexpr (is_unlisted<E>()) {
    lay_table<E, S>(params, option, 0.0);
  } else if constexpr (requires { params.table; }) {
    params.table.points = 2;
    params.table.x = {S(0.0), S(1e4)};
    params.table.y = {S(1.2e8), S(1.2e8)};
  }
  return params;
}

/// Every field that the law uses where a search would start; a table in the shape of [SD] fig. 4.
template <class E, class S>
ParamsOf<E, S> typical(int option) {
  ParamsOf<E, S> params = neutral<E, S>(option);
  for (const auto& field : ParamsOf<E, S>::fields()) {
    if (used_by(field, option)) {
      params.*field.member = S(field.typical);
    }
  }
  if constexpr (is_term<E>()) {
    set_term<E, S>(params);
  } else if constexpr (is_unlisted<E>()) {
    lay_table<E, S>(params, option, 1.0);
  } else if constexpr (requires { params.table; }) {
    params.table.points = 4;
    params.table.x = {S(0.0), S(4e3), S(1.2e4), S(3e4)};
    params.table.y = {S(4e7), S(6e7), S(1e8), S(1.2e8)};
  }
  return params;
}

/// Random numbers of a test, the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool one_in(unsigned n) { return engine_() % n == 0; }
  /// Either sign, magnitude spread over the decades from `low` to `high`; now and then exactly zero.
  double either_sign(double low, double high) {
    const double magnitude = one_in(16) ? 0.0 : logarithmic(low, high);
    return one_in(2) ? -magnitude : magnitude;
  }

 private:
  std::mt19937_64 engine_;
};

/// A value inside a field's bounds, spread over its decades. A range that includes zero is sampled from a millionth of its
/// end upward, and at zero itself.
template <class Owner>
double random_value(Random& random, const model::Field<Owner>& field) {
  if (field.lower > 0.0) {
    return std::clamp(random.logarithmic(field.lower, field.upper), field.lower, field.upper);
  }
  const double value = random.either_sign(1e-6 * field.upper, field.upper);
  return std::clamp(field.lower == 0.0 ? std::abs(value) : value, field.lower, field.upper);
}

template <class E>
ParamsOf<E, double> random_params(Random& random, int option) {
  ParamsOf<E, double> params = neutral<E, double>(option);
  for (const auto& field : ParamsOf<E, double>::fields()) {
    params.*field.member = random_value(random, field);
  }
  if constexpr (is_unlisted<E>()) {
    lay_table<E, double>(params, option, random.either_sign(1e-3, 1e3));
  } else if constexpr (requires { params.table; }) {
    const auto bounds = ParamsOf<E, double>::tables()[0];
    params.table.points = 5;
    double load = 0.0;
    for (std::size_t i = 0; i < 5; ++i) {
      params.table.x[i] = load;
      params.table.y[i] = random.logarithmic(bounds.y_lower, bounds.y_upper);
      load += random.logarithmic(1.0, 1e5);
    }
  }
  return params;
}

// Inputs over the decades that a plant can meet, and well beyond.
inline void randomise(Random& random, model::Signal<double>& input) { input.value = random.either_sign(1e-9, 1e2); }
inline void randomise(Random& random, model::Hydraulics<double>& input) {
  input.load_pressure = random.either_sign(1.0, 1e8);
  input.opening = random.either_sign(1e-9, 10.0);
  input.supply_pressure = 20.684e6;
  input.flow = random.either_sign(1e-12, 1.0);
}
inline void randomise(Random& random, model::Compression<double>& input) {
  input.free_flow = random.either_sign(1e-9, 1.0);
  input.relief = random.uniform(0.0, 0.95);
  input.load_pressure = random.either_sign(1.0, 1e8);
}
inline void randomise(Random& random, model::Motion<double>& input) {
  input.position = random.either_sign(1e-9, 10.0);
  input.velocity = random.either_sign(1e-12, 1e2);
  input.free_velocity = random.either_sign(1e-12, 1e2);
  input.compliance = random.logarithmic(1e-12, 1.0);
  input.other_angle = random.either_sign(1e-9, 10.0);
  input.other_rate = random.either_sign(1e-12, 1e2);
  input.load = random.either_sign(1e-6, 1e7);
}
/// The load spring of the reference values (physics.md section 1) at a deflection [m] and an angle [rad].
inline model::Spring<double> reference_spring(double deflection, double angle, double h) {
  constexpr double actuator = 1.2e8;
  constexpr double load = 5.75e7;
  return {deflection, angle, 0.7544, 0.7544, 1.0 / (1.0 / actuator + 1.0 / load), actuator, load, h};
}
inline void randomise(Random& random, model::Spring<double>& input) {
  input = reference_spring(random.either_sign(1e-12, 1.0), random.either_sign(1e-9, 1.0), input.h);
}
inline void randomise(Random& random, model::AttachPoint<double>& input) { input.force = random.either_sign(1e-6, 1e7); }

template <class E>
InputOf<E, double> random_input(Random& random, double h) {
  InputOf<E, double> input{};
  input.h = h;
  randomise(random, input);
  return input;
}

// A slow smooth motion through every site's usual range, sampled at time t [s].
inline void move(double t, model::Signal<double>& input) {
  input.value = 0.1 * std::sin(7.0 * t) + 0.03 * std::sin(31.0 * t);
  input.time = t;
}
inline void move(double t, model::Hydraulics<double>& input) {
  input = {4e6 * std::sin(9.0 * t), 0.1 * std::sin(5.0 * t), 20.684e6, input.h, t, 2e-4 * std::sin(5.0 * t)};
}
inline void move(double t, model::Compression<double>& input) {
  input = {1e-3 * std::cos(9.0 * t), 0.2, 4e6 * std::sin(9.0 * t), input.h};
}
inline void move(double t, model::Motion<double>& input) {
  const double velocity = 0.7 * std::cos(7.0 * t) + 0.3 * std::cos(20.0 * t);
  input = {0.1 * std::sin(7.0 * t) + 0.015 * std::sin(20.0 * t),
           velocity,
           velocity,
           1e-12,
           input.h,
           t,
           0.1 * std::sin(5.0 * t),
           0.5 * std::cos(5.0 * t)};
  input.declared_stiffness = 40.0;
  input.declared_damping = 0.5;
}
inline void move(double t, model::Spring<double>& input) {
  input = reference_spring(5e-4 * std::sin(9.0 * t), 0.1 * std::sin(5.0 * t), input.h);
  input.time = t;
}
inline void move(double t, model::AttachPoint<double>& input) { input.force = 3e4 * std::sin(9.0 * t); }

template <class E>
InputOf<E, double> smooth_input(double t, double h) {
  InputOf<E, double> input{};
  input.h = h;
  move(t, input);
  if constexpr (E::site == model::Site::transmission) {
    input.deflection *= 100.0;  // of the order of its load's motion, where a load spring gives way by micrometres
  }
  if constexpr (E::name == model::DriveDeadband::name) {
    input.value *= 10.0;  // a force of the order of one, where a command is an angle
  }
  return input;
}

// The same input in another scalar.
template <class S>
model::Signal<S> converted(const model::Signal<double>& in) {
  return {S(in.value), in.h, model::Precise<S>(in.time)};
}
template <class S>
model::Hydraulics<S> converted(const model::Hydraulics<double>& in) {
  return {S(in.load_pressure), S(in.opening), S(in.supply_pressure), in.h, model::Precise<S>(in.time), S(in.flow)};
}
template <class S>
model::Compression<S> converted(const model::Compression<double>& in) {
  return {S(in.free_flow), S(in.relief), S(in.load_pressure), in.h};
}
template <class S>
model::Motion<S> converted(const model::Motion<double>& in) {
  return {S(in.position),
          S(in.velocity),
          S(in.free_velocity),
          S(in.compliance),
          in.h,
          model::Precise<S>(in.time),
          S(in.other_angle),
          S(in.other_rate),
          S(in.load),
          S(in.declared_stiffness),
          S(in.declared_damping)};
}
template <class S>
model::Spring<S> converted(const model::Spring<double>& in) {
  return {S(in.deflection),     S(in.angle), S(in.nominal_arm),         S(in.arm), S(in.stiffness), S(in.actuator_stiffness),
          S(in.load_stiffness), in.h,        model::Precise<S>(in.time)};
}
template <class S>
model::AttachPoint<S> converted(const model::AttachPoint<double>& in) {
  return {S(in.force), in.h};
}

/// The numbers of a site's output that an effect can change.
template <class S>
std::array<double, 2> plain(const S& output) {
  return {model::value_of(output), 0.0};
}
template <class S>
std::array<double, 2> plain(const model::Spring<S>& output) {
  return {model::value_of(output.deflection), model::value_of(output.arm)};
}

/// What a serial effect returns if it does nothing.
inline std::array<double, 2> untouched(const model::Signal<double>& input) { return {input.value, 0.0}; }
inline std::array<double, 2> untouched(const model::Spring<double>& input) { return {input.deflection, input.arm}; }

}  // namespace hotfire::test
