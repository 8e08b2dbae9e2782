// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/sensors/vehicle_sensors.hpp"
#include "model/vehicle.hpp"
#include "tools/interface/plant/normal.hpp"
#include "tools/structure/vehicle_sensors.hpp"

namespace hotfire {

/// The sensors of a vehicle file as its plant reads through them, every anchor where it is: off from where it is drawn by an
/// error of its placement, drawn from `normal`. Without strings in the file they are at their representative places.
template <class Plant>
model::VehicleSensors<Plant> sensors_in_place(const VehicleSensors& sensors, Normal& normal);

}  // namespace hotfire
