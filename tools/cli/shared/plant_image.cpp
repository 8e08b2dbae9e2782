// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/plant_image.hpp"
#include "tools/cli/shared/any_record.hpp"

#include <fmt/format.h>

#include <variant>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/rig/fault_file.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/disturbances.hpp"
#include "tools/simulate/vehicle_image_text.hpp"

namespace hotfire {

namespace {

/// The lines of what the plant of a model plays; `disturbances(record)` is what its record has for that model.
template <class Model, class Disturbances>
std::string played_lines(const Model& model, const PlayedFiles& played, Disturbances&& disturbances) {
  std::string lines = played.faults.empty() ? "" : load_faults(played.faults, faulty_plant(model));
  if (!played.disturbances.empty()) {
    const Record record = load_any_record(played.disturbances);
    lines += disturbances_image_text(record, disturbances(record));
  }
  return lines;
}

}  // namespace

std::string image_of_model(const std::string& model_path, const PlayedFiles& played) {
  if (is_vehicle(model_path)) {
    const VehicleFile vehicle = load_vehicle(model_path);
    return plant_image_text(vehicle) + played_lines(vehicle, played, [&](const Record& record) {
             return std::visit([&](const auto& parameters) { return disturbances_of(record, parameters.gimbals); },
                               vehicle.parameters);
           });
  }
  const ModelFile model = load_model(model_path);
  return plant_image_text(model) + played_lines(model, played, [&](const Record& record) {
           if (!std::holds_alternative<SimplexParameters>(model.parameters)) {
             throw FileError(
                 fmt::format("{}: a mass or a moved body has no disturbance beside its input; allowed with "
                             "\"simplex\", \"taos\" and \"masv\"",
                             model_path));
           }
           return disturbances_of(record);
         });
}

}  // namespace hotfire
