// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <variant>

#include "tools/simulate/plant_image_text.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

/// The plant image of a vehicle, which `hotfire-rt --image` reads back bit for bit. Its strings are where `hotfire simulate`
/// places them when it is given no seed.
inline std::string plant_image_text(const VehicleFile& file) {
  return std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        using Plant =
            std::conditional_t<std::is_same_v<Parameters, TaosParameters>, model::Taos<double>, model::Masv<double>>;
        Normal normal(VehicleRun{}.seed);
        const auto instrumented = std::make_unique<const model::InstrumentedVehicle<Plant>>(
            model::InstrumentedVehicle<Plant>{parameters, sensors_in_place<Plant>(file.sensors, normal)});
        return plant_image_text(*instrumented);
      },
      file.parameters);
}

}  // namespace hotfire
