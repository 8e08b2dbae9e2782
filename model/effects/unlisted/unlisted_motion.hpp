// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "model/effects/unlisted/unlisted.hpp"
#include "model/friction/friction.hpp"

namespace hotfire::model {

/// A force or torque against the motion at `piston`, `engine_torque` or `mass_force`, by one of these laws:
///
/// - a table over the position, over the rate, or over time;
/// - dry friction or viscous damping whose level is a table over the position, over its distance from zero, or over time;
/// - dry friction whose level is a table over the size of the load, where there is one;
/// - a sinusoid of time.
template <Site at>
struct UnlistedMotion {
  using Names = UnlistedNames<at>;
  static constexpr std::string_view name = Names::name;
  static constexpr Site site = at;
  static constexpr bool is_unlisted = true;
  static constexpr bool has_load = at != Site::mass_force;
  enum class Law {
    position,
    rate,
    friction_along_position,
    damping_along_position,
    time,
    periodic,
    friction_along_distance,
    damping_along_distance,
    friction_along_time,
    damping_along_time,
    friction_along_load
  };  ///< in the order of `options`
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
      return std::array{Field<Params>{"stiffness", Names::stiffness_unit, 1e-6, 1e15, Names::typical_stiffness,
                                      "stiffness of the friction before it slides", &Params::stiffness,
                                      only(Law::friction_along_position, Law::friction_along_distance,
                                           Law::friction_along_time, Law::friction_along_load)},
                        Field<Params>{"frequency", "Hz", 1e-3, 1e3, 0.5, "frequency of the sinusoid", &Params::frequency,
                                      only(Law::periodic)},
                        Field<Params>{"amplitude", Names::unit, 0.0, 1e12, Names::typical, "amplitude of the sinusoid",
                                      &Params::amplitude, only(Law::periodic)},
                        unlisted::phase_field<Params>(only(Law::periodic))};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      const std::array without_load{
          T{"position", Names::position_unit, "force_at_position", Names::unit, -1e12, 1e12,
            "force against positive motion at a position", &Params::table, only(Law::position), Names::typical},
          T{"rate", Names::rate_unit, "force_at_rate", Names::unit, -1e12, 1e12, "force against positive motion at a rate",
            &Params::table, only(Law::rate), Names::typical},
          T{"position_of_friction", Names::position_unit, "friction_at_position", Names::unit, -1e12, 1e12,
            "level of dry friction at a position; none where negative", &Params::table, only(Law::friction_along_position),
            Names::typical},
          T{"position_of_damping", Names::position_unit, "damping_at_position", Names::damping_unit, -1e12, 1e12,
            "damping at a position", &Params::table, only(Law::damping_along_position), Names::typical_damping},
          T{"distance_of_friction", Names::position_unit, "friction_at_distance", Names::unit, -1e12, 1e12,
            "level of dry friction at a distance from zero; none where negative", &Params::table,
            only(Law::friction_along_distance), Names::typical},
          T{"distance_of_damping", Names::position_unit, "damping_at_distance", Names::damping_unit, -1e12, 1e12,
            "damping at a distance from zero", &Params::table, only(Law::damping_along_distance), Names::typical_damping},
          T{"time", "s", "force_at_time", Names::unit, -1e12, 1e12, "force against positive motion at a time of the record",
            &Params::table, only(Law::time), Names::typical},
          T{"time_of_friction", "s", "friction_at_time", Names::unit, -1e12, 1e12,
            "level of dry friction at a time of the record; none where negative", &Params::table,
            only(Law::friction_along_time), Names::typical},
          T{"time_of_damping", "s", "damping_at_time", Names::damping_unit, -1e12, 1e12, "damping at a time of the record",
            &Params::table, only(Law::damping_along_time), Names::typical_damping}};
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
                       only(Law::friction_along_load),
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
    switch (law_of<UnlistedMotion>(params)) {
      case Law::position:
        return unlisted::value_at<S>(params.table, input.position);
      case Law::rate:
        return unlisted::force_at_rate<S>(params.table, input);
      case Law::friction_along_position:
        return friction(params, state, input, input.position);
      case Law::damping_along_position:
        return damping(params, input, input.position);
      case Law::time:
        return unlisted::value_at<S>(params.table, input.time);
      case Law::periodic:
        return unlisted::periodic(params, params.amplitude, input.time);
      case Law::friction_along_distance:
        return friction(params, state, input, S(input.position * sign_of(input.position)));
      case Law::damping_along_distance:
        return damping(params, input, S(input.position * sign_of(input.position)));
      case Law::friction_along_time:
        return friction(params, state, input, input.time);
      case Law::damping_along_time:
        return damping(params, input, input.time);
      case Law::friction_along_load:
        return friction(params, state, input, S(input.load * sign_of(input.load)));
    }
    return S{0.0};
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
