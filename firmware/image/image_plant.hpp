// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "firmware/image/plant_image.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/plant/vehicle_plant.hpp"
#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace detail {

template <class Parameters>
struct PlantOf {
  using Vehicle = typename Parameters::Vehicle;
  static constexpr std::size_t kReadings = Vehicle::kChannels;
  static constexpr std::string_view kWithoutValve{};
  static auto make(const Parameters& parameters, double period, std::size_t, const PlantImage& image) {
    return std::make_unique<VehiclePlant<Vehicle>>(parameters, period, image.faults, image.recorded);
  }
};

template <class Model>
struct PlantOfAxes {
  static constexpr std::size_t kReadings = Model::channels.size();
  static constexpr bool kHasValve = requires { Model::kAngle; };
  static constexpr std::string_view kWithoutValve = kHasValve ? std::string_view() : Model::topology;

  static auto make(const typename Model::Parameters& parameters, double period, std::size_t actuators,
                   const PlantImage& image) {
    return std::make_unique<Plant<Model>>(parameters, period, actuators, image.faults, image.recorded);
  }
};
template <>
struct PlantOf<model::Simplex<double>::Parameters> : PlantOfAxes<model::Simplex<double>> {};
template <>
struct PlantOf<model::Direct<double>::Parameters> : PlantOfAxes<model::Direct<double>> {};
template <>
struct PlantOf<model::ImposedMotion<double>::Parameters> : PlantOfAxes<model::ImposedMotion<double>> {};
template <>
struct PlantOf<model::Modal<double>::Parameters> : PlantOfAxes<model::Modal<double>> {};
template <>
struct PlantOf<model::Electromechanical<double>::Parameters> : PlantOfAxes<model::Electromechanical<double>> {};

}  // namespace detail

/// Number of actuators of the plant in an image; 0: any number, each a copy of one axis.
inline std::size_t actuators_of(const PlantParameters& parameters) {
  return std::visit(
      []<class Parameters>(const Parameters&) -> std::size_t {
        if constexpr (requires { typename Parameters::Vehicle; }) {
          return Parameters::Vehicle::kAxes;
        } else {
          return 0;
        }
      },
      parameters);
}

/// Number of readings of one actuator of the plant in an image.
inline std::size_t readings_of(const PlantParameters& parameters) {
  return std::visit([]<class Parameters>(const Parameters&) { return detail::PlantOf<Parameters>::kReadings; }, parameters);
}

/// The topology of the plant in an image, if it has no servovalve; empty for the others.
inline std::string_view topology_without_valve(const PlantParameters& parameters) {
  return std::visit([]<class Parameters>(const Parameters&) { return detail::PlantOf<Parameters>::kWithoutValve; },
                    parameters);
}

/// Why the record of disturbances of an image cannot be played in cycles of `period` [s]; empty if it can.
inline std::string refused_record(const PlantImage& image, double period) {
  return image.recorded.loads.empty() || cycles_per_row(image.recorded.period, period)
             ? std::string()
             : text("disturbances: a row lasts %g us and a cycle %g us; allowed: rows of a whole number of cycles",
                    image.recorded.period * 1e6, period * 1e6);
}

/// Constructs the plant of an image on the heap and returns the result of `use` with it. `period` in s; `actuators`: copies
/// of one axis, ignored for a vehicle.
template <class Use>
auto with_plant(const PlantImage& image, double period, std::size_t actuators, Use&& use) {
  return std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        return use(detail::PlantOf<Parameters>::make(parameters, period, actuators, image));
      },
      *image.parameters);
}

}  // namespace hotfire::firmware
