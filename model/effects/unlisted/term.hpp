// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "model/actuator/surroundings.hpp"
#include "model/effects/unlisted/unlisted.hpp"
#include "model/numerics/memory.hpp"

namespace hotfire::model {

namespace term {

inline constexpr std::array<std::string_view, kArgumentNames.size() + 1> kFactorNames = [] {
  std::array<std::string_view, kArgumentNames.size() + 1> names{"none"};
  for (std::size_t i = 0; i < kArgumentNames.size(); ++i) {
    names[i + 1] = kArgumentNames[i];
  }
  return names;
}();

enum class Order { curve_last, curve_first };
inline constexpr std::array<std::string_view, 2> kOrderNames{"curve_last", "curve_first"};

/// Name and unit of the quantity that a term adds at its site. `own` is the argument that a site of a signal transmits.
template <Site at, int channel>
struct Names;
template <>
struct Names<Site::command, -1> {
  static constexpr std::string_view name = "term_command", unit = "rad";
  static constexpr Argument own = Argument::command;
};
template <>
struct Names<Site::valve_command, -1> {
  static constexpr std::string_view name = "term_valve_command", unit = "1";
  static constexpr Argument own = Argument::valve_command;
};
template <>
struct Names<Site::valve, -1> {
  static constexpr std::string_view name = "term_opening", unit = "1";
  static constexpr Argument own = Argument::spool;
};
template <>
struct Names<Site::flow, -1> {
  static constexpr std::string_view name = "term_flow", unit = "m^3/s";
};
template <>
struct Names<Site::piston, -1> {
  static constexpr std::string_view name = "term_piston_force", unit = "N";
};
template <>
struct Names<Site::load_spring, -1> {
  static constexpr std::string_view name = "term_deflection", unit = "m";
};
template <>
struct Names<Site::engine_torque, -1> {
  static constexpr std::string_view name = "term_torque", unit = "N.m";
};
template <>
struct Names<Site::sensor, 0> {
  static constexpr std::string_view name = "term_piston_reading", unit = "m";
  static constexpr Argument own = Argument::position;
};
template <>
struct Names<Site::sensor, 1> {
  static constexpr std::string_view name = "term_engine_reading", unit = "rad";
  static constexpr Argument own = Argument::angle;
};

}  // namespace term

/// A term of the grammar. What is added at a site is a curve and a memory, in either order, of one quantity of the axis or
/// of the product s of two, and `direct` times s: a signal that is replaced has -1 there. Without points the curve is a
/// gain; of `stops` the points are the widths and what each operator counts (Prandtl and Ishlinskii); of an oscillator the
/// curve is added to its frequency [Hz] and `gain` is its amplitude. A force or torque opposes the motion. Beyond the points
/// of a curve in front of a memory the whole term is constant: `direct` would go on where its counterpart does not.
template <Site at, int channel = -1>
struct Term {
  using Names = term::Names<at, channel>;
  static constexpr std::string_view name = Names::name;
  static constexpr Site site = at;
  static constexpr bool is_unlisted = true;
  static constexpr bool is_term = true;
  static constexpr int sensor_channel = channel;
  using Law = Memory;  ///< in the order of `options`
  static constexpr auto options = kMemoryNames;
  static constexpr std::string_view option_key = "memory";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    int argument = 0;
    int factor = 0;
    int order = 0;
    S gain{0.0};
    S direct{0.0};
    S time{0.01};
    S frequency{1.0};
    S damping{0.5};
    S width{1.0};
    S phase{0.0};
    S exponent{2.0};
    UnlistedTable<S> table{};
    MemoryParameters<S> memory() const noexcept {
      // A command is held over a step, and a sensor reads the end of one. All else is the mean over a step.
      constexpr double kMean = at == Site::command || at == Site::sensor ? 0.0 : 0.5;
      return {static_cast<Memory>(option), time, frequency, damping, width, phase, exponent, kMean};
    }
    static constexpr auto choices() {
      return std::array{Choice<Params>{"argument", kArgumentNames, &Params::argument},
                        Choice<Params>{"factor", term::kFactorNames, &Params::factor},
                        Choice<Params>{"order", term::kOrderNames, &Params::order}};
    }
    static constexpr auto fields() {
      using enum Memory;
      return std::array{
          Field<Params>{"gain", "", -1e18, 1e18, 1.0,
                        "what is added for a unit of the memory's output, without points; amplitude of an oscillator",
                        &Params::gain, ~only(stops)},
          Field<Params>{"direct", "", -1e18, 1e18, 1.0, "what is added for a unit of the argument itself", &Params::direct,
                        ~only(none, oscillator)},
          Field<Params>{"time", "s", 1e-5, 1e3, 0.02, "delay, time constant or sampling period", &Params::time,
                        only(delay, lag, washout, hold)},
          Field<Params>{"frequency", "Hz", 1e-3, 1e4, 5.0, "natural frequency", &Params::frequency,
                        only(resonance, band_pass, oscillator)},
          Field<Params>{"damping", "1", 1e-3, 10.0, 0.5, "damping ratio", &Params::damping, only(resonance, band_pass)},
          Field<Params>{"width", "", 1e-15, 1e15, 1.0,
                        "limit, quantum, half width, pitch or unit of a power, in the argument's unit; of slew, of its rate",
                        &Params::width,
                        only(play, stop, slew, quantise, dead_zone, saturation, periodic, odd_power, even_power)},
          Field<Params>{"phase", "rad", -10.0, 10.0, 1.0,
                        "phase at the start of a record, of the oscillator or of the sampling", &Params::phase,
                        only(oscillator, hold)},
          Field<Params>{"exponent", "1", 1.0, 6.0, 2.0, "exponent of a power", &Params::exponent,
                        only(odd_power, even_power)}};
    }
    static constexpr auto tables() {
      return std::array{TableField<Params, UnlistedTable<S>>{
          "at", "", "added", Names::unit, -1e18, 1e18,
          "what is added at a value of the argument; in hertz to the frequency of an oscillator", &Params::table, ~0U, 1.0,
          true}};
    }
  };

  template <class S>
  struct State {
    MemoryState<S> memory{};
  };

  template <class S, class Input>
  static void settle(const Params<S>&, State<S>& state, const Input&) noexcept {
    state.memory.rest();
  }

  template <class S, class Input>
  static auto step(const Params<S>& params, State<S>& state, const Input& input) noexcept {
    if constexpr (std::is_same_v<Input, Signal<S>>) {
      return S(input.value + added(params, state, input));
    } else if constexpr (std::is_same_v<Input, Spring<S>>) {
      Spring<S> output = input;
      output.deflection += added(params, state, input);
      return output;
    } else {
      return added(params, state, input);
    }
  }

 private:
  /// A quantity at a site: the site's own signal as it arrives, every other quantity from the axis around it.
  template <class S, class Input>
  static S quantity(Argument argument, const Input& input) noexcept {
    if constexpr (std::is_same_v<Input, Signal<S>>) {
      if (argument == Names::own) {
        return input.value;
      }
    } else if constexpr (std::is_same_v<Input, Spring<S>>) {
      if (argument == Argument::deflection) {
        return input.deflection;
      }
    } else if constexpr (std::is_same_v<Input, Hydraulics<S>>) {
      if (argument == Argument::load_pressure) {
        return input.load_pressure;
      }
      if (argument == Argument::spool) {
        return input.opening;
      }
    } else if constexpr (std::is_same_v<Input, Motion<S>>) {
      constexpr bool kIsPiston = at == Site::piston;
      if (argument == (kIsPiston ? Argument::rate : Argument::angle_rate)) {
        return input.velocity;
      }
      if (argument == (kIsPiston ? Argument::position : Argument::angle)) {
        return input.position;
      }
    }
    return input.seen == nullptr ? S{0.0} : input.seen->at(argument);
  }

  template <class S, class Input>
  static S added(const Params<S>& params, State<S>& state, const Input& input) noexcept {
    const auto argument = static_cast<Argument>(params.argument);
    const bool has_curve = params.table.points > 0;
    if constexpr (std::is_same_v<Input, Motion<S>>) {
      constexpr Argument kRate = at == Site::piston ? Argument::rate : Argument::angle_rate;
      if (has_curve && law_of<Term>(params) == Memory::none && argument == kRate && params.factor == 0) {
        return unlisted::force_at_rate<S>(params.table, input);
      }
    }
    S s = quantity<S>(argument, input);
    if (params.factor > 0) {
      s = s * quantity<S>(static_cast<Argument>(params.factor - 1), input);
    }
    const auto kind = law_of<Term>(params);
    if (kind == Memory::stops) {
      const auto& stops = state.memory.stop(params.table.x, params.table.points, s);
      S sum = params.direct * s;
      for (std::size_t k = 0; k < kMostStops; ++k) {
        sum += params.table.y[k] * stops[k];
      }
      return sum;
    }
    const MemoryParameters<S> memory = params.memory();
    if (kind == Memory::oscillator) {
      const S shift = has_curve ? unlisted::value_at<S>(params.table, s) : S{0.0};
      return params.gain * state.memory.step(memory, shift, input.h);
    }
    if (has_curve && static_cast<term::Order>(params.order) == term::Order::curve_first) {
      const S within = unlisted::within<S>(params.table, s);
      return state.memory.step(memory, unlisted::value_at<S>(params.table, within), input.h) + params.direct * within;
    }
    const S remembered = state.memory.step(memory, s, input.h);
    const S own = has_curve ? unlisted::value_at<S>(params.table, remembered) : S(params.gain * remembered);
    return kind == Memory::none ? own : S(own + params.direct * s);
  }
};

}  // namespace hotfire::model
