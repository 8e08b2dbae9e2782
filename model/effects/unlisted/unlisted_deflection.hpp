// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// Deflection added to that of the load spring, by one of these laws:
///
/// - a table over its own deflection or the engine angle;
/// - creep: a share of the deflection relaxes with a time constant (a standard linear solid);
/// - damping: a further spring beside it that relaxes with a time constant (a Maxwell element). Slow motion does not load
///   it, and to slower motion than its time constant it is a damper;
/// - slip: a joint beside it that sticks, and slips beyond a stretch (a Jenkins element; Iwan 1966);
/// - a stiffness that drifts, K_T (1 + stiffness(t)).
struct UnlistedDeflection {
  static constexpr std::string_view name = "unlisted_deflection";
  static constexpr Site site = Site::load_spring;
  static constexpr bool is_unlisted = true;
  enum class Law { deflection, angle, creep, stiffness_along_time, deflection_rate, slip };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 6> options{"deflection",           "angle",           "creep",
                                                           "stiffness_along_time", "deflection_rate", "slip"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S creep_share{0.0};
    S creep_time{1.0};
    S damping_share{0.0};
    S damping_time{0.01};
    S slip_share{0.0};
    S slip_width{1e-4};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"creep_share", "1", 0.0, 0.95, 0.1, "share of the deflection that relaxes", &Params::creep_share,
                        only(Law::creep)},
          Field<Params>{"creep_time", "s", 1e-3, 1e3, 0.5, "time constant of the relaxation", &Params::creep_time,
                        only(Law::creep)},
          Field<Params>{"damping_share", "1", 0.0, 10.0, 0.3, "stiffness of the spring that relaxes over that of the other",
                        &Params::damping_share, only(Law::deflection_rate)},
          Field<Params>{"damping_time", "s", 1e-4, 1.0, 0.01, "time constant of its relaxation", &Params::damping_time,
                        only(Law::deflection_rate)},
          Field<Params>{"slip_share", "1", 0.0, 10.0, 0.3, "stiffness of the joint that sticks over that of the spring",
                        &Params::slip_share, only(Law::slip)},
          Field<Params>{"slip_width", "m", 1e-9, 1.0, 1e-4, "stretch at which the joint slips", &Params::slip_width,
                        only(Law::slip)}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"deflection", "m", "added_at_deflection", "m", -1.0, 1.0, "what is added at a deflection",
                          &Params::table, only(Law::deflection), 5e-5},
                        T{"angle", "rad", "added_at_angle", "m", -1.0, 1.0, "what is added at an engine angle",
                          &Params::table, only(Law::angle), 5e-5},
                        T{"time", "s", "stiffness_at_time", "1", -0.95, 10.0,
                          "share by which the spring is stiffer at a time of the record", &Params::table,
                          only(Law::stiffness_along_time), 0.1}};
    }
  };

  template <class S>
  struct State {
    S relaxed{0.0};  ///< deflection that the part that relaxes follows [m]
    S stretch{0.0};  ///< of the joint, within its slip width [m]
    S last{0.0};     ///< deflection at the last step [m]
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Spring<S>& input) noexcept {
    state.relaxed = input.deflection;
    state.stretch = S{0.0};
    state.last = input.deflection;
  }

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    Spring<S> output = input;
    const Law law = law_of<UnlistedDeflection>(params);
    if (law == Law::creep) {
      output.deflection =
          input.deflection - params.creep_share * lag_of_moving(state.relaxed, input.deflection, params.creep_time, input.h);
    } else if (law == Law::deflection_rate) {
      output.deflection =
          input.deflection + params.damping_share * (input.deflection - lag_of_moving(state.relaxed, input.deflection,
                                                                                      params.damping_time, input.h));
    } else if (law == Law::slip) {
      state.stretch = stop_after<S>(state.stretch, input.deflection - state.last, params.slip_width);
      state.last = input.deflection;
      output.deflection += params.slip_share * state.stretch;
    } else if (law == Law::stiffness_along_time) {
      output.deflection = input.deflection * (1.0 + unlisted::value_at<S>(params.table, input.time));
    } else {
      output.deflection += unlisted::value_at<S>(params.table, law == Law::deflection ? input.deflection : input.angle);
    }
    return output;
  }
};

}  // namespace hotfire::model
