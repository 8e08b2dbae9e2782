// SPDX-License-Identifier: Apache-2.0
#include "tools/library/declared_plant.hpp"

#include <type_traits>
#include <utility>

#include "tools/files/model/model_file.hpp"
#include "tools/interface/plant/normal.hpp"
#include "tools/interface/plant/setup_text.hpp"
#include "tools/simulate/plant_image_text.hpp"
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

namespace {

DeclaredPlant declared(ModelFile model, double period, unsigned seed) {
  return {std::move(model.name),
          {period, seed, false},
          std::visit([](const auto& parameters) { return plant::AnyParameters(parameters); }, model.parameters)};
}

}  // namespace

DeclaredPlant declared_plant(const VehicleFile& file, double period, unsigned seed) {
  DeclaredPlant declared{file.name, {period, seed, !file.sensors.strings.empty()}, {}};
  std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        using Vehicle =
            std::conditional_t<std::is_same_v<Parameters, TaosParameters>, model::Taos<double>, model::Masv<double>>;
        Normal normal(seed);
        declared.parameters =
            model::InstrumentedVehicle<Vehicle>{parameters, sensors_in_place<Vehicle>(file.sensors, normal)};
      },
      file.parameters);
  return declared;
}

DeclaredPlant declared_plant(const std::filesystem::path& path, double period, unsigned seed) {
  return is_vehicle(path) ? declared_plant(load_vehicle(path), period, seed) : declared(load_model(path), period, seed);
}

DeclaredPlant declared_plant(const std::string& text, const std::filesystem::path& path, double period, unsigned seed) {
  return is_vehicle(text, path) ? declared_plant(parse_vehicle(text, path), period, seed)
                                : declared(parse_model(text, path), period, seed);
}

std::string plant_text_of(const DeclaredPlant& declared) {
  return plant::setup_text(
      declared.setup, std::visit([](const auto& parameters) { return plant_image_text(parameters); }, declared.parameters));
}

}  // namespace hotfire
