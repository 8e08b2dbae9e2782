// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/for_each_processor.hpp"
#include "tools/interface/plant/plant_of.hpp"

namespace hotfire::plant {

HOTFIRE_FOR_EACH_PROCESSOR void advance(const model::Direct<double>& model, model::Direct<double>::State& state,
                                        const double& input) noexcept {
  model.step(state, input);
}

std::unique_ptr<Plant> make_plant(const model::Direct<double>::Parameters& parameters, const Setup& setup) {
  return PlantOf<DirectAdapter>::make(parameters, setup);
}

}  // namespace hotfire::plant
