#pragma once

#include <cmath>
#include <numbers>

#include "model/effect.hpp"
#include "model/table.hpp"

/// What no listed effect is: a term of unknown law at a known site, as a table that the plant can run. `hotfire explain`
/// fits the table where the records ask for a term and no listed effect is it. Between its points a table is linear, beyond
/// them constant: the points are its bounds of validity. With no points, or all of them zero, the effect is exactly nothing.
namespace hotfire::model {

inline constexpr std::size_t kUnlistedPoints = 16;

template <class S>
using UnlistedTable = Table<S, kUnlistedPoints>;

namespace unlisted {

template <class S>
S value_at(const UnlistedTable<S>& table, const S& x) noexcept {
  if (table.points == 0) {
    return S{0.0};
  }
  S value = table.y[0];
  for (int i = 1; i < table.points; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const S share = (x - table.x[k - 1]) / (table.x[k] - table.x[k - 1]);
    const S inside = value_of(share) < 1.0 ? share : S{1.0};
    value += (table.y[k] - table.y[k - 1]) * (value_of(inside) > 0.0 ? inside : S{0.0});
  }
  return value;
}

/// Force of a table over the velocity, solved together with velocity = free_velocity - compliance * force: the first
/// crossing as the velocity rises, so that a steep table (dry friction) is as stable as a flat one.
template <class S>
S force_at_rate(const UnlistedTable<S>& table, const Motion<S>& input) noexcept {
  if (table.points == 0) {
    return S{0.0};
  }
  const auto over = [&](const S& velocity, const S& force) {
    return velocity + input.compliance * force - input.free_velocity;
  };
  S force = table.y[static_cast<std::size_t>(table.points) - 1];
  bool found = false;
  S below = over(table.x[0], table.y[0]);
  if (value_of(below) >= 0.0) {
    force = table.y[0];
    found = true;
  }
  for (int i = 1; i < table.points; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const S above = over(table.x[k], table.y[k]);
    if (!found && value_of(above) >= 0.0) {
      force = table.y[k - 1] + (table.y[k] - table.y[k - 1]) * (-below / (above - below));
      found = true;
    }
    below = above;
  }
  return force;
}

/// A sinusoid of the record's time; its phase is the clock's.
template <class S>
S periodic(const S& amplitude, const S& frequency, const S& time) noexcept {
  using std::sin;
  return amplitude * sin(2.0 * std::numbers::pi * frequency * time);
}

}  // namespace unlisted

/// What a configuration calls an unlisted term at a site, and in which units its tables are.
template <Site site>
struct UnlistedNames;

template <>
struct UnlistedNames<Site::command> {
  static constexpr std::string_view name = "unlisted_command", unit = "rad";
  static constexpr double typical = 1e-3, largest = 10.0;
};
template <>
struct UnlistedNames<Site::valve_command> {
  static constexpr std::string_view name = "unlisted_valve_command", unit = "1";
  static constexpr double typical = 0.02, largest = 10.0;
};
template <>
struct UnlistedNames<Site::valve> {
  static constexpr std::string_view name = "unlisted_valve", unit = "1";
  static constexpr double typical = 0.02, largest = 10.0;
};
template <>
struct UnlistedNames<Site::piston> {
  static constexpr std::string_view name = "unlisted_piston_force", position_unit = "m", rate_unit = "m/s", unit = "N",
                                    damping_unit = "N.s/m", stiffness_unit = "N/m";
  static constexpr double typical = 5e3, typical_damping = 2e4, typical_stiffness = 1e8;
};
template <>
struct UnlistedNames<Site::engine_torque> {
  static constexpr std::string_view name = "unlisted_torque", position_unit = "rad", rate_unit = "rad/s", unit = "N.m",
                                    damping_unit = "N.m.s/rad", stiffness_unit = "N.m/rad";
  static constexpr double typical = 3e3, typical_damping = 1e4, typical_stiffness = 1e7;
};
template <>
struct UnlistedNames<Site::mass_force> {
  static constexpr std::string_view name = "unlisted_force", position_unit = "position", rate_unit = "position/time",
                                    unit = "force", damping_unit = "force.time/position", stiffness_unit = "force/position";
  static constexpr double typical = 0.05, typical_damping = 0.05, typical_stiffness = 100.0;
};

/// A term added to the signal at `command`, `valve_command` or `valve`, as a table over the signal's own value or over time,
/// or as a sinusoid of time. What depends on time at the valve is the valve command's: the spool follows it too fast to
/// tell.
template <Site at>
struct UnlistedSignal {
  using Names = UnlistedNames<at>;
  static constexpr std::string_view name = Names::name;
  static constexpr Site site = at;
  static constexpr bool is_unlisted = true;
  static constexpr auto options = [] {
    if constexpr (at == Site::valve) {
      return std::array<std::string_view, 1>{"value"};
    } else {
      return std::array<std::string_view, 3>{"value", "time", "periodic"};
    }
  }();
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S frequency{1.0};
    S amplitude{0.0};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"frequency", "Hz", 1e-3, 1e3, 0.5, "frequency of the sinusoid", &Params::frequency, 0b100},
          Field<Params>{"amplitude", Names::unit, 0.0, Names::largest, Names::typical, "amplitude of the sinusoid",
                        &Params::amplitude, 0b100}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"value", Names::unit, "added_at_value", Names::unit, -Names::largest, Names::largest,
                          "what is added at a value of the signal", &Params::table, 0b001, Names::typical},
                        T{"time", "s", "added_at_time", Names::unit, -Names::largest, Names::largest,
                          "what is added at a time of the record", &Params::table, 0b010, Names::typical}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    switch (params.option) {
      case 0:
        return input.value + unlisted::value_at<S>(params.table, input.value);
      case 1:
        return input.value + unlisted::value_at<S>(params.table, input.time);
      default:
        return input.value + unlisted::periodic<S>(params.amplitude, params.frequency, input.time);
    }
  }
};

/// Flow into the extend chamber [m^3/s] as a table over load pressure, spool position or time.
struct UnlistedFlow {
  static constexpr std::string_view name = "unlisted_flow";
  static constexpr Site site = Site::flow;
  static constexpr bool is_unlisted = true;
  static constexpr std::array<std::string_view, 3> options{"load_pressure", "opening", "time"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"load_pressure", "Pa", "flow_at_pressure", "m^3/s", -1.0, 1.0, "further flow at a load pressure",
                          &Params::table, 0b001, 5e-5},
                        T{"opening", "1", "flow_at_opening", "m^3/s", -1.0, 1.0, "further flow at a spool position",
                          &Params::table, 0b010, 5e-5},
                        T{"time", "s", "flow_at_time", "m^3/s", -1.0, 1.0, "further flow at a time of the record",
                          &Params::table, 0b100, 5e-5}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Hydraulics<S>& input) noexcept {
    const S& x = params.option == 0 ? input.load_pressure : params.option == 1 ? input.opening : input.time;
    return unlisted::value_at<S>(params.table, x);
  }
};

/// Oil whose compressibility depends on the load pressure: what flows in builds pressure up to a share that is a table over
/// it, 1 + share(P) (aerated oil, a hose that stiffens).
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
          "load_pressure", "Pa", "share_at_pressure", "1", -1.0, 10.0,
          "share by which pressure builds up faster than declared at a load pressure", &Params::table, 0b1, 0.2}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Compression<S>& input) noexcept {
    return input.net_flow * unlisted::value_at<S>(params.table, input.load_pressure);
  }
};

/// Deflection added to the load spring's, as a table over its own deflection or the engine angle; or a spring that creeps:
/// a share of the deflection relaxes with a time constant (a standard linear solid).
struct UnlistedDeflection {
  static constexpr std::string_view name = "unlisted_deflection";
  static constexpr Site site = Site::load_spring;
  static constexpr bool is_unlisted = true;
  static constexpr std::array<std::string_view, 3> options{"deflection", "angle", "creep"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S creep_share{0.0};
    S creep_time{1.0};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"creep_share", "1", 0.0, 0.95, 0.1, "share of the deflection that relaxes", &Params::creep_share,
                        0b100},
          Field<Params>{"creep_time", "s", 1e-3, 1e3, 0.5, "time constant of the relaxation", &Params::creep_time, 0b100}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"deflection", "m", "added_at_deflection", "m", -1.0, 1.0, "what is added at a deflection",
                          &Params::table, 0b01, 5e-5},
                        T{"angle", "rad", "added_at_angle", "m", -1.0, 1.0, "what is added at an engine angle",
                          &Params::table, 0b10, 5e-5}};
    }
  };

  template <class S>
  struct State {
    S relaxed{0.0};  ///< deflection that the creeping part follows [m]
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Spring<S>& input) noexcept {
    state.relaxed = input.deflection;
  }

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    Spring<S> output = input;
    if (params.option == 2) {
      const S start = state.relaxed;
      const S decay = fading_exponential<S>(input.h / params.creep_time);
      state.relaxed = input.deflection + (start - input.deflection) * decay;
      output.deflection = input.deflection - params.creep_share * 0.5 * (start + state.relaxed);
    } else {
      output.deflection += unlisted::value_at<S>(params.table, params.option == 0 ? input.deflection : input.angle);
    }
    return output;
  }
};

/// What a sensor adds to its reading, as a table over what it measures: a worn track, a local bump.
struct UnlistedReading {
  static constexpr std::string_view name = "unlisted_reading";
  static constexpr Site site = Site::sensor;
  static constexpr bool is_unlisted = true;
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"position", "m", "error_at_position", "m", -1.0, 1.0, "what the sensor adds at a piston position",
                          &Params::table, 0b01, 1e-4},
                        T{"angle", "rad", "error_at_angle", "rad", -1.0, 1.0, "what the sensor adds at an engine angle",
                          &Params::table, 0b10, 1e-4}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value + unlisted::value_at<S>(params.table, input.value);
  }
};

}  // namespace hotfire::model
