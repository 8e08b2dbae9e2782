// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"
#include "model/numerics/table.hpp"

/// An effect that is not listed: a term of unknown law at a known site, as a table that the plant can run. `hotfire explain`
/// fits the table if the records require a term and no listed effect explains it. A table is linear between its points and
/// constant beyond them: the points are its bounds of validity. Without points, or with zeros only, the effect is exactly
/// zero.
namespace hotfire::model {

inline constexpr std::size_t kUnlistedPoints = 16;

template <class S>
using UnlistedTable = Table<S, kUnlistedPoints>;

namespace unlisted {

template <class S, class X>
S value_at(const UnlistedTable<S>& table, const X& x) noexcept {
  return curve_value<S>(table.x, table.y, static_cast<std::size_t>(table.points), x);
}

/// `x` limited to the range of a table's points.
template <class S>
S within(const UnlistedTable<S>& table, const S& x) noexcept {
  const auto& first = table.x[0];
  const auto& last = table.x[static_cast<std::size_t>(table.points) - 1];
  return value_of(x) < value_of(first) ? S(first) : value_of(x) > value_of(last) ? S(last) : x;
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

/// A sinusoid of the record's time.
template <class Params>
typename Params::Scalar periodic(const Params& params, const typename Params::Scalar& amplitude,
                                 const Precise<typename Params::Scalar>& time) noexcept {
  using std::sin;
  return amplitude * typename Params::Scalar(sin(2.0 * std::numbers::pi * params.frequency * time + params.phase));
}

/// The phase of such a sinusoid at time zero: found from the records' own, when they agree.
template <class Params>
constexpr Field<Params> phase_field(unsigned options) {
  return {"phase", "rad", -10.0, 10.0, 0.0, "phase of the sinusoid at time zero of a record", &Params::phase, options};
}

}  // namespace unlisted

/// Configuration name of an unlisted term at a site, and the units of its tables.
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

}  // namespace hotfire::model
