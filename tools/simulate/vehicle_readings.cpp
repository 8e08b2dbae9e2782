// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

template <class Plant>
model::VehicleSensors<Plant> sensors_in_place(const VehicleSensors& sensors, Normal& normal) {
  model::VehicleSensors<Plant> placed;
  placed.piston = sensors.piston;
  placed.string = sensors.string;
  for (std::size_t e = 0; e < sensors.strings.size(); ++e) {
    placed.anchors[e] = sensors.strings[e];
    for (auto& string : placed.anchors[e]) {
      for (double* coordinate : {&string.vehicle_x, &string.vehicle_y, &string.vehicle_z}) {
        *coordinate += sensors.placement_error * normal();
      }
    }
  }
  if (sensors.string_shape.rows() > 0) {
    placed.string_shape.leftCols(sensors.string_shape.cols()) = sensors.string_shape;
    placed.string_residual = sensors.string_residual;
  }
  return placed;
}

template model::VehicleSensors<model::Taos<double>> sensors_in_place(const VehicleSensors&, Normal&);
template model::VehicleSensors<model::Masv<double>> sensors_in_place(const VehicleSensors&, Normal&);

}  // namespace hotfire
