// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>

#include "model/sensors/string_potentiometer.hpp"

namespace hotfire::model {

/// The sensors of the pistons and engines of a vehicle (`Vehicle`). Default: ideal readings of the pistons; strings at their
/// representative places, whose anchors no mode moves.
template <class V>
struct VehicleSensors {
  using S = typename V::Scalar;
  using Strings = StringPotentiometers<S>;
  static constexpr std::size_t kStrings = V::kEngines * Strings::kStrings;
  using Shape = Eigen::Matrix<S, static_cast<int>(kStrings), V::Modes::kCapacity>;
  using Residual = Eigen::Matrix<S, static_cast<int>(kStrings), V::kPorts>;

  PotentiometerReadout<S> piston;  ///< of every piston
  PotentiometerReadout<S> string;  ///< of every string
  std::array<typename Strings::Anchors, V::kEngines> anchors = representative_anchors();
  /// Distance by which each mode [kg^-0.5], and each force on a port beyond the modes, pulls the ends of a string together.
  Shape string_shape = Shape::Zero();
  Residual string_residual = Residual::Zero();

 private:
  static constexpr std::array<typename Strings::Anchors, V::kEngines> representative_anchors() noexcept {
    std::array<typename Strings::Anchors, V::kEngines> anchors{};
    for (auto& engine : anchors) {
      engine = Strings::representative();
    }
    return anchors;
  }
};

/// A vehicle with what reads it.
template <class V>
struct InstrumentedVehicle {
  using Vehicle = V;
  typename V::Parameters vehicle{};
  VehicleSensors<V> sensors{};
};

/// Readings of the sensors of a vehicle in its successive states. A string measures its engine's angles, the displacement of
/// the bearing and the motion of its anchor with the structure; it cannot separate them. No allocation after construction.
template <class V>
class VehicleReadings {
 public:
  using S = typename V::Scalar;
  using Sensors = VehicleSensors<V>;
  using State = typename V::State;

  /// At rest in `start`.
  VehicleReadings(const Sensors& sensors, const State& start)
      : sensors_(sensors), geometry_(geometry_of(sensors, std::make_index_sequence<V::kEngines>{})) {
    for (std::size_t i = 0; i < pistons_.size(); ++i) {
      PotentiometerReadout<S>::settle(piston_lag_[i], piston_of(start, i));
    }
    const auto lengths = lengths_of(start);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      PotentiometerReadout<S>::settle(string_lag_[i], lengths[i]);
    }
  }

  /// Read a state, `h` seconds after the last one. `draw()` gives independent samples of a distribution of variance 1.
  template <class Draw>
  void read_pistons(const State& state, double h, Draw&& draw) noexcept {
    for (std::size_t i = 0; i < pistons_.size(); ++i) {
      pistons_[i] = sensors_.piston.read(piston_lag_[i], piston_of(state, i), S(draw()), h);
    }
  }
  template <class Draw>
  void read_strings(const State& state, double h, Draw&& draw) noexcept {
    const auto lengths = lengths_of(state);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      strings_[i] = sensors_.string.read(string_lag_[i], lengths[i], S(draw()), h);
    }
  }

  const std::array<S, V::kAxes>& pistons() const noexcept { return pistons_; }  ///< [m]
  /// Change from zero angles, engine by engine [m].
  const std::array<S, Sensors::kStrings>& strings() const noexcept { return strings_; }

 private:
  using Strings = typename Sensors::Strings;

  static const S& piston_of(const State& state, std::size_t axis) noexcept {
    return V::measured(state)[axis * V::kChannels];
  }

  std::array<S, Sensors::kStrings> lengths_of(const State& state) const noexcept {
    std::array<S, Sensors::kStrings> lengths{};
    for (std::size_t e = 0; e < geometry_.size(); ++e) {
      // The bearing's translation carries the engine's end: the same as the anchors carried the other way.
      const Vector3<S> bearing = state.gimbals[e].bearing.translation();
      const auto own = geometry_[e].lengths(state.axes[2 * e].y(V::AxisModel::kAngle),
                                            state.axes[2 * e + 1].y(V::AxisModel::kAngle), -bearing);
      for (std::size_t k = 0; k < own.size(); ++k) {
        lengths[e * own.size() + k] = own[k];
      }
    }
    Eigen::Matrix<S, static_cast<int>(Sensors::kStrings), 1> pulled =
        sensors_.string_residual.col(0) * state.structure.forces(0);
    for (int port = 1; port < V::kPorts; ++port) {
      pulled += sensors_.string_residual.col(port) * state.structure.forces(port);
    }
    for (int k = 0; k < V::Modes::kCapacity; ++k) {
      pulled += sensors_.string_shape.col(k) * state.structure.modes[static_cast<std::size_t>(k)].displacement;
    }
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      lengths[i] -= pulled(static_cast<int>(i));
    }
    return lengths;
  }

  template <std::size_t... E>
  static std::array<Strings, V::kEngines> geometry_of(const Sensors& sensors, std::index_sequence<E...>) {
    return {Strings(sensors.anchors[E])...};
  }

  Sensors sensors_;
  std::array<Strings, V::kEngines> geometry_;  ///< with anchors where they are
  std::array<SensorLag::State<S>, V::kAxes> piston_lag_{};
  std::array<SensorLag::State<S>, Sensors::kStrings> string_lag_{};
  std::array<S, V::kAxes> pistons_{};
  std::array<S, Sensors::kStrings> strings_{};
};

}  // namespace hotfire::model
