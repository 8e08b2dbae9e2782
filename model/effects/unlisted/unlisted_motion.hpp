// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "model/effects/unlisted/unlisted.hpp"
#include "model/friction/friction.hpp"

namespace hotfire::model {

/// A force or torque against the motion at `piston`, `engine_torque` or `mass_force`: a table over the position, over the
/// rate, or over time; dry friction or viscous damping whose level is a table over the position, over its distance from
/// zero, or over time; dry friction whose level is a table over the size of the load, where there is one; or a sinusoid of
/// time.
template <Site at>
struct UnlistedMotion {
  using Names = UnlistedNames<at>;
  static constexpr std::string_view name = Names::name;
  static constexpr Site site = at;
  static constexpr bool is_unlisted = true;
  static constexpr bool has_load = at != Site::mass_force;
  static constexpr auto options = [] {
    constexpr std::array<std::string_view, 11> all{"position",
                                                   "rate",
                                                   "friction_along_position",
                                                   "damping_along_position",
                                                   "time",
                                                   "periodic",
                                                   "friction_along_distance",
                                                   "damping_along_distance",
                                                   "friction_along_time",
                                                   "damping_along_time",
                                                   "friction_along_load"};
    std::array<std::string_view, has_load ? all.size() : all.size() - 1> own{};
    std::copy_n(all.begin(), own.size(), own.begin());
    return own;
  }();
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S stiffness{Names::typical_stiffness};
    S frequency{1.0};
    S amplitude{0.0};
    S phase{0.0};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"stiffness", Names::stiffness_unit, 1e-6, 1e15, Names::typical_stiffness,
                        "stiffness of the friction before it slides", &Params::stiffness, 0b10101000100},
          Field<Params>{"frequency", "Hz", 1e-3, 1e3, 0.5, "frequency of the sinusoid", &Params::frequency, 0b100000},
          Field<Params>{"amplitude", Names::unit, 0.0, 1e12, Names::typical, "amplitude of the sinusoid", &Params::amplitude,
                        0b100000},
          unlisted::phase_field<Params>(0b100000)};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      const std::array without_load{
          T{"position", Names::position_unit, "force_at_position", Names::unit, -1e12, 1e12,
            "force against positive motion at a position", &Params::table, 0b00001, Names::typical},
          T{"rate", Names::rate_unit, "force_at_rate", Names::unit, -1e12, 1e12, "force against positive motion at a rate",
            &Params::table, 0b00010, Names::typical},
          T{"position_of_friction", Names::position_unit, "friction_at_position", Names::unit, -1e12, 1e12,
            "level of dry friction at a position; none where negative", &Params::table, 0b00100, Names::typical},
          T{"position_of_damping", Names::position_unit, "damping_at_position", Names::damping_unit, -1e12, 1e12,
            "damping at a position", &Params::table, 0b01000, Names::typical_damping},
          T{"distance_of_friction", Names::position_unit, "friction_at_distance", Names::unit, -1e12, 1e12,
            "level of dry friction at a distance from zero; none where negative", &Params::table, 0b1000000, Names::typical},
          T{"distance_of_damping", Names::position_unit, "damping_at_distance", Names::damping_unit, -1e12, 1e12,
            "damping at a distance from zero", &Params::table, 0b10000000, Names::typical_damping},
          T{"time", "s", "force_at_time", Names::unit, -1e12, 1e12, "force against positive motion at a time of the record",
            &Params::table, 0b10000, Names::typical},
          T{"time_of_friction", "s", "friction_at_time", Names::unit, -1e12, 1e12,
            "level of dry friction at a time of the record; none where negative", &Params::table, 0b100000000,
            Names::typical},
          T{"time_of_damping", "s", "damping_at_time", Names::damping_unit, -1e12, 1e12, "damping at a time of the record",
            &Params::table, 0b1000000000, Names::typical_damping}};
      if constexpr (has_load) {
        std::array<T, without_load.size() + 1> all{};
        std::copy(without_load.begin(), without_load.end(), all.begin());
        all.back() = T{"load_of_friction",
                       "N",
                       "friction_at_load",
                       Names::unit,
                       -1e12,
                       1e12,
                       "level of dry friction under a size of the load; none where negative",
                       &Params::table,
                       0b10000000000,
                       Names::typical};
        return all;
      } else {
        return without_load;
      }
    }
  };

  template <class S>
  struct State {
    S deflection{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Motion<S>& input) noexcept {
    switch (params.option) {
      case 0:
        return unlisted::value_at<S>(params.table, input.position);
      case 1:
        return unlisted::force_at_rate<S>(params.table, input);
      case 2:
        return friction(params, state, input, input.position);
      case 3:
        return damping(params, input, input.position);
      case 4:
        return unlisted::value_at<S>(params.table, input.time);
      case 5:
        return unlisted::periodic(params, params.amplitude, input.time);
      case 6:
        return friction(params, state, input, S(input.position * sign_of(input.position)));
      case 7:
        return damping(params, input, S(input.position * sign_of(input.position)));
      case 8:
        return friction(params, state, input, input.time);
      case 9:
        return damping(params, input, input.time);
      default:
        return friction(params, state, input, S(input.load * sign_of(input.load)));
    }
  }

 private:
  template <class S, class X>
  static S friction(const Params<S>& params, State<S>& state, const Motion<S>& input, const X& at_x) noexcept {
    const S level = unlisted::value_at<S>(params.table, at_x);
    return value_of(level) > 0.0 ? elastoplastic_force<S>(state.deflection, input, level, params.stiffness) : S{0.0};
  }

  template <class S, class X>
  static S damping(const Params<S>& params, const Motion<S>& input, const X& at_x) noexcept {
    const S damping = unlisted::value_at<S>(params.table, at_x);
    const S slowed = 1.0 + input.compliance * damping;
    // A table that drives more than inertia holds back within a step has no solution forward in time.
    return value_of(slowed) > 0.1 ? damping * input.free_velocity / slowed : S{0.0};
  }
};

}  // namespace hotfire::model
