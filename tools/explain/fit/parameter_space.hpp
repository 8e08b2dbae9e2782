// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "model/key_text.hpp"

namespace hotfire::explain {

/// Which number of the model a parameter is. The text of a key is for people only.
struct Address {
  model::Key owner{};      ///< a declared part, or an effect of the plant's list; of no section for an initial state
  std::string_view field;  ///< of the owner; for a point of a table the field of its ordinates
  int point = -1;          ///< of a table; -1: not of a table

  bool operator==(const Address&) const = default;
  bool operator<(const Address& other) const {
    return std::tie(owner.section, owner.is_effect, owner.effect_index, field, point) <
           std::tie(other.owner.section, other.owner.is_effect, other.owner.effect_index, other.field, other.point);
  }

  bool is_of_effect() const { return owner.is_effect; }
  bool is_of_effect(std::size_t effect) const { return owner.is_effect && owner.effect_index == effect; }
  bool is_ordinate() const { return point >= 0; }
  /// The field, with the point of a table: "coulomb_torque", "torque.3".
  std::string name() const { return is_ordinate() ? std::string(field) + "." + std::to_string(point) : std::string(field); }
  /// As model files write it: "engine.inertia", "effects.gimbal_friction.coulomb_torque".
  std::string key() const { return std::string(model::KeyText(owner, name()).view()); }
};

/// What of a record's start a fit may move.
enum class InitialState { position, velocity, clock };

/// One parameter that a fit may move, as the fit sees it: a number u without unit, with the parameter p = value(u).
struct FreeParameter {
  enum class Scale {
    tolerance,  ///< p = declared (1 + tolerance u), u ~ N(0, 1): a declared value within its tolerance; below half of it on
                ///< along the tangent of the logarithm, so that no number of tolerances takes it to nothing
    logarithmic,  ///< p = e^u: an effect's parameter that can't be negative
    linear        ///< p = unit u
  };

  std::size_t index = 0;  ///< in the order of model::visit_values; for an initial state see `state`
  Address address;        ///< of an initial state: none
  std::string key;        ///< for messages and reports: of the address, or the record with ".initial_position"
  std::string unit;
  Scale scale = Scale::linear;
  double declared = 0.0;
  double tolerance = 0.0;
  double unit_size = 1.0;
  double lower = 0.0;  ///< bounds of p
  double upper = 0.0;
  double prior_center = 0.0;                    ///< in u
  double prior_deviation = 0.0;                 ///< in u; 0: no prior
  int experiment = -1;                          ///< for an initial state: which record; -1 otherwise
  InitialState state = InitialState::position;  ///< for an initial state: which

  double value(double u) const {
    switch (scale) {
      case Scale::tolerance:
        return declared * (is_fading(u) ? kFading * std::exp((1.0 + tolerance * u) / kFading - 1.0) : 1.0 + tolerance * u);
      case Scale::logarithmic:
        return std::exp(u);
      case Scale::linear:
        break;
    }
    return unit_size * u;
  }

  double slope(double u) const {
    switch (scale) {
      case Scale::tolerance:
        return tolerance * (is_fading(u) ? value(u) / kFading : declared);
      case Scale::logarithmic:
        return std::exp(u);
      case Scale::linear:
        break;
    }
    return unit_size;
  }

  double coordinate(double p) const {
    switch (scale) {
      case Scale::tolerance:
        return ((p / declared < kFading ? kFading * (std::log(p / (kFading * declared)) + 1.0) : p / declared) - 1.0) /
               tolerance;
      case Scale::logarithmic:
        return std::log(p);
      case Scale::linear:
        break;
    }
    return p / unit_size;
  }

  /// The bounds as coordinates, the lower first.
  std::pair<double, double> range() const { return std::minmax({coordinate(lower), coordinate(upper)}); }

  bool has_prior() const { return prior_deviation > 0.0; }
  /// Distance from the prior in its deviations; 0 without one.
  double surprise(double u) const { return has_prior() ? (u - prior_center) / prior_deviation : 0.0; }
  /// What the prior adds to a sum of squares at u, to half of that sum's slope, and to half of its curvature; 0 without one.
  double prior_cost(double u) const { return surprise(u) * surprise(u); }
  double prior_slope(double u) const { return has_prior() ? surprise(u) / prior_deviation : 0.0; }
  double prior_curvature() const { return has_prior() ? 1.0 / (prior_deviation * prior_deviation) : 0.0; }
  bool is_declared() const { return scale == Scale::tolerance; }
  bool is_initial_state() const { return experiment >= 0; }
  bool is_clock() const { return is_initial_state() && state == InitialState::clock; }
  bool is_ordinate() const { return address.is_ordinate(); }
  bool is_of_effect(std::size_t effect) const { return address.is_of_effect(effect); }
  /// True if both are the same number of the model or of a record's start.
  bool is_same_as(const FreeParameter& other) const {
    return address == other.address && experiment == other.experiment && state == other.state;
  }

  /// A parameter of the model, by its place in model::visit_values, with the rest still to be filled in.
  static FreeParameter at(std::size_t index, const Address& address, std::string_view unit) {
    FreeParameter parameter;
    parameter.index = index;
    parameter.address = address;
    parameter.key = address.key();
    parameter.unit = unit;
    return parameter;
  }

 private:
  /// Share of a declared value below which its tolerance is one of the logarithm.
  static constexpr double kFading = 0.5;
  bool is_fading(double u) const { return 1.0 + tolerance * u < kFading; }
};

/// What the priors of all parameters add to a sum of squares at `u`.
inline double prior_cost(std::span<const FreeParameter> free, std::span<const double> u) {
  double cost = 0.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    cost += free[k].prior_cost(u[k]);
  }
  return cost;
}

}  // namespace hotfire::explain
