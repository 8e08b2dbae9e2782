// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/plant_image.hpp"

#include "tools/files/model/model_file.hpp"
#include "tools/files/rig/fault_file.hpp"
#include "tools/simulate/vehicle_image_text.hpp"

namespace hotfire {

std::string image_of_model(const std::string& model_path, const std::string& faults_path) {
  if (is_vehicle(model_path)) {
    const VehicleFile vehicle = load_vehicle(model_path);
    return plant_image_text(vehicle) + (faults_path.empty() ? "" : load_faults(faults_path, faulty_plant(vehicle)));
  }
  const ModelFile model = load_model(model_path);
  return plant_image_text(model) + (faults_path.empty() ? "" : load_faults(faults_path, faulty_plant(model)));
}

}  // namespace hotfire
