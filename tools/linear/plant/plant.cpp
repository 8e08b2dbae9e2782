// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/plant/plant.hpp"

#include <variant>

#include "tools/files/text/error.hpp"

namespace hotfire::linear {

std::unique_ptr<Plant> make_plant(const plant::AnyParameters& parameters, double period, const OperatingPoint& point) {
  return std::visit(
      [&]<class Parameters>(const Parameters& own) -> std::unique_ptr<Plant> {
        if constexpr (std::is_same_v<Parameters, model::Direct<double>::Parameters>) {
          throw UsageError(
              "a direct mass is one equation and needs no linear model; allowed topologies: simplex, taos, masv");
        } else {
          return make_plant(own, period, point);
        }
      },
      parameters);
}

}  // namespace hotfire::linear
