// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/plant_of.hpp"
#include "tools/interface/plant/vehicle_adapter.hpp"

namespace hotfire::plant {

namespace {

template <class S>
using MasvAdapter = VehicleAdapter<model::Masv<S>>;

}  // namespace

std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Masv<double>>& parameters, const Setup& setup) {
  return PlantOf<MasvAdapter>::make(parameters, setup);
}

}  // namespace hotfire::plant
