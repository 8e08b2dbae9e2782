// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// Flow into the extend chamber [m^3/s], by one of two kinds of law. The first is a table over load pressure, spool position
/// or time. The second is a share of the valve's flow, as a table over the recent flow in either direction, which has a
/// memory with a time constant (a supply that sags, oil that warms up).
struct UnlistedFlow {
  static constexpr std::string_view name = "unlisted_flow";
  static constexpr Site site = Site::flow;
  static constexpr bool is_unlisted = true;
  enum class Law { load_pressure, opening, time, recent_flow };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 4> options{"load_pressure", "opening", "time", "recent_flow"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S memory{0.2};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{Field<Params>{"memory", "s", 1e-3, 1e3, 0.2, "time constant over which flow is remembered",
                                      &Params::memory, only(Law::recent_flow)}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{
          T{"load_pressure", "Pa", "flow_at_pressure", "m^3/s", -1.0, 1.0, "further flow at a load pressure", &Params::table,
            only(Law::load_pressure), 5e-5},
          T{"opening", "1", "flow_at_opening", "m^3/s", -1.0, 1.0, "further flow at a spool position", &Params::table,
            only(Law::opening), 5e-5},
          T{"time", "s", "flow_at_time", "m^3/s", -1.0, 1.0, "further flow at a time of the record", &Params::table,
            only(Law::time), 5e-5},
          T{"recent_flow", "m^3/s", "share_at_recent_flow", "1", -1.0, 10.0,
            "share by which the valve's flow grows with the flow of late", &Params::table, only(Law::recent_flow), 0.1}};
    }
  };

  template <class S>
  struct State {
    S recent{0.0};  ///< magnitude of the valve's flow as remembered [m^3/s]
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Hydraulics<S>& input) noexcept {
    state.recent = input.flow * sign_of(input.flow);
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Hydraulics<S>& input) noexcept {
    const Law law = law_of<UnlistedFlow>(params);
    if (law == Law::recent_flow) {
      const S magnitude = input.flow * sign_of(input.flow);
      const S remembered = lag_of_moving(state.recent, magnitude, params.memory, input.h);
      return input.flow * unlisted::value_at<S>(params.table, remembered);
    }
    const Precise<S>& x = law == Law::load_pressure ? input.load_pressure : law == Law::opening ? input.opening : input.time;
    return unlisted::value_at<S>(params.table, x);
  }
};

/// Oil whose compressibility depends on the load pressure (aerated oil, a hose that stiffens). To that of the declared bulk
/// modulus it adds a share that is a table over the pressure: dP/dt = (4 beta_e / V_T) net flow / (1 + share(P)).
struct UnlistedPressure {
  static constexpr std::string_view name = "unlisted_pressure";
  static constexpr Site site = Site::pressure;
  static constexpr bool is_unlisted = true;
  static constexpr std::array<std::string_view, 1> options{"load_pressure"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      return std::array{TableField<Params, UnlistedTable<S>>{
          "load_pressure", "Pa", "compressibility_at_pressure", "1", -0.5, 1000.0,
          "share by which the oil is more compressible than declared at a load pressure", &Params::table, ~0U, 0.2}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Compression<S>& input) noexcept {
    const S share = unlisted::value_at<S>(params.table, input.load_pressure);
    // Of the net flow, what does not build up pressure as declared is -share / (1 + share).
    return -share * input.free_flow / (1.0 + share * (1.0 - input.relief));
  }
};

}  // namespace hotfire::model
