// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/plant/plant.hpp"

#include <fmt/format.h>

#include <variant>

#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::linear {

std::unique_ptr<Plant> make_plant(const plant::AnyParameters& parameters, double period, const OperatingPoint& point) {
  return std::visit(
      [&]<class Parameters>(const Parameters& own) -> std::unique_ptr<Plant> {
        constexpr bool is_hydraulic = std::is_same_v<Parameters, model::Simplex<double>::Parameters> || requires {
          typename Parameters::Vehicle;
        };
        if constexpr (is_hydraulic) {
          return make_plant(own, period, point);
        } else {
          throw UsageError(
              fmt::format("a model of topology {} is linear as it is declared; allowed topologies: simplex, taos, masv",
                          PlantOf<Parameters, double>::topology));
        }
      },
      parameters);
}

}  // namespace hotfire::linear
