// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

#include "model/key_text.hpp"
#include "model/sensors/vehicle_sensors.hpp"

namespace hotfire::model {

namespace detail {

inline constexpr std::array<std::string_view, 2> kNoYes{"no", "yes"};

template <class Flag, class Visitor>
void visit_flag(const KeyText& key, Flag& flag, Visitor& visitor) {
  int option = flag ? 1 : 0;
  visitor.option(key, kNoYes, option);
  if constexpr (!std::is_const_v<Flag>) {
    flag = option == 1;
  }
}

template <class Column, class Visitor>
void visit_column(const KeyText& key, Column&& column, Visitor& visitor) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  visitor.list(key, -kLargest, kLargest, std::span(column.data(), static_cast<std::size_t>(column.rows())));
}

/// A matrix, a line for each of its columns.
template <class Matrix, class Visitor>
void visit_columns(std::string_view name, Matrix& matrix, Visitor& visitor) {
  for (int column = 0; column < matrix.cols(); ++column) {
    visit_column(KeyText(name, column + 1, ""), matrix.col(column), visitor);
  }
}

template <class Gimbal, class Visitor>
void visit_gimbal(std::string_view prefix, Gimbal& gimbal, Visitor& visitor) {
  visit_owner(prefix, false, gimbal.bearing.name, gimbal.bearing, visitor);
  visitor.option(KeyText(prefix, false, gimbal.friction.name, gimbal.friction.option_key), gimbal.friction.options,
                 gimbal.friction.option);
  visit_owner(prefix, false, gimbal.friction.name, gimbal.friction, visitor);
  visit_owner(prefix, false, gimbal.vibration.name, gimbal.vibration, visitor);
  visit_flag(KeyText(prefix, false, gimbal.bearing.name, "compliant"), gimbal.compliant, visitor);
  visit_columns(KeyText(prefix, false, gimbal.bearing.name, "stiffness").view(), gimbal.stiffness, visitor);
}

/// The modes that are in use, and what they do to the strings.
template <class Modes, class Sensors, class Visitor>
void visit_modes(Modes& modes, Sensors& sensors, Visitor& visitor) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  constexpr double kAboveZero = std::numeric_limits<double>::min();
  constexpr double kBelowOne = 1.0 - 0.5 * std::numeric_limits<double>::epsilon();
  visitor.count(KeyText({}, false, "modes", "count"), std::remove_const_t<Modes>::kCapacity, modes.modes);
  for (int k = 0; k < modes.modes; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    visitor.list(KeyText("mode", k + 1, ".frequency"), kAboveZero, kLargest, std::span(&modes.frequency[mode], 1));
    visitor.list(KeyText("mode", k + 1, ".damping_ratio"), 0.0, kBelowOne, std::span(&modes.damping_ratio[mode], 1));
    visit_column(KeyText("mode", k + 1, ".shape"), modes.shape.col(k), visitor);
    visit_column(KeyText("mode", k + 1, ".string_shape"), sensors.string_shape.col(k), visitor);
  }
  visit_columns("residual.port", modes.residual, visitor);
  visit_columns("residual.string.port", sensors.string_residual, visitor);
}

}  // namespace detail

/// Gives every number of a vehicle with its sensors to a visitor, with its full key. The keys of an axis begin with
/// "pitch1.", "yaw1.", "pitch2." and so on, those of an engine with "engine1.". In addition to the calls of `visit_keys`, a
/// visitor has:
/// - `list(key, lower, upper, values)`: numbers between these bounds, a `std::span`;
/// - `count(key, most, count)`: a whole number from 0 on, an `int`.
/// Set-up only. The values that the visitor sees are const if `instrumented` is (`InstrumentedVehicle`).
template <class Instrumented, class Visitor>
void visit_vehicle_keys(Instrumented& instrumented, Visitor& visitor) {
  auto& [vehicle, sensors] = instrumented;
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    const KeyText prefix(i % 2 == 0 ? "pitch" : "yaw", static_cast<int>(i / 2) + 1, ".");
    visit_keys(vehicle.axes[i], visitor, prefix.view());
    detail::visit_owner(prefix.view(), false, vehicle.attach[i].name, vehicle.attach[i], visitor);
  }
  for (std::size_t e = 0; e < vehicle.gimbals.size(); ++e) {
    const int number = static_cast<int>(e) + 1;
    const KeyText prefix("engine", number, ".");
    detail::visit_flag(KeyText("engine", number, ".constant_arms"), vehicle.constant_arms[e], visitor);
    detail::visit_gimbal(prefix.view(), vehicle.gimbals[e], visitor);
    for (std::size_t k = 0; k < sensors.anchors[e].size(); ++k) {
      const KeyText string("string", static_cast<int>(k) + 1, "");
      detail::visit_owner(prefix.view(), false, string.view(), sensors.anchors[e][k], visitor);
    }
  }
  detail::visit_owner("sensors.", false, "piston", sensors.piston, visitor);
  detail::visit_owner("sensors.", false, "string", sensors.string, visitor);
  detail::visit_modes(vehicle.modes, sensors, visitor);
}

}  // namespace hotfire::model
