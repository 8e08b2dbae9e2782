// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/plant/plant.hpp"

#include <fmt/format.h>

#include <variant>

#include "tools/files/text/error.hpp"

namespace hotfire::linear {

std::unique_ptr<Plant> make_plant(const plant::AnyParameters& parameters, double period, const OperatingPoint& point) {
  return std::visit(
      [&]<class Parameters>(const Parameters& own) -> std::unique_ptr<Plant> {
        constexpr bool is_moved = std::is_same_v<Parameters, model::ImposedMotion<double>::Parameters>;
        constexpr bool is_modal = std::is_same_v<Parameters, model::Modal<double>::Parameters>;
        if constexpr (is_moved || is_modal || std::is_same_v<Parameters, model::Direct<double>::Parameters>) {
          throw UsageError(
              fmt::format("a model of topology {} is linear as it is declared; allowed topologies: simplex, taos, masv",
                          is_moved   ? "imposed_motion"
                          : is_modal ? "modal"
                                     : "direct"));
        } else {
          return make_plant(own, period, point);
        }
      },
      parameters);
}

}  // namespace hotfire::linear
