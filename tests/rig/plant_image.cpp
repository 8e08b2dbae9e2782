// SPDX-License-Identifier: Apache-2.0
// Prints a plant image, what `hotfire plant --model` makes of a file, on a machine that has no host side: of the reference
// axis with every effect active, or, for the argument `masv`, of four engines at hot fire on twenty modes.

#include <cstdio>
#include <memory>
#include <string_view>

#include "firmware/plant/reference_plant.hpp"
#include "model/vehicle_keys.hpp"
#include "tests/model/support/vehicles.hpp"
#include "tools/simulate/plant_image_text.hpp"

namespace {

std::string image_of_four_engines() {
  using hotfire::test::Masv;
  const auto rig = std::make_unique<hotfire::model::InstrumentedVehicle<Masv>>();
  rig->vehicle = hotfire::test::hot_fire<Masv>();
  rig->vehicle.modes = hotfire::test::random_modes<Masv::Modes>(20, 5e-9, 7);
  hotfire::PlantImageWriter writer(Masv::topology);
  hotfire::model::visit_vehicle_keys(*rig, writer);
  return writer.text();
}

std::string image_of_one_axis() {
  hotfire::ModelFile model;
  model.parameters = hotfire::firmware::reference_plant_with_every_effect();
  return hotfire::plant_image_text(model);
}

}  // namespace

int main(int count, char** words) {
  const bool four = count > 1 && words[1] == std::string_view("masv");
  std::fputs((four ? image_of_four_engines() : image_of_one_axis()).c_str(), stdout);
  return 0;
}
