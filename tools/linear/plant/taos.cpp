// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/plant/plant_of.hpp"

namespace hotfire::linear {

std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Taos<double>>& parameters, double period,
                                  const OperatingPoint& point) {
  return std::make_unique<PlantOf<TaosTopology>>(parameters, period, point);
}

}  // namespace hotfire::linear
