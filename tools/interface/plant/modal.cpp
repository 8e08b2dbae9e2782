// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/for_each_processor.hpp"
#include "tools/interface/plant/plant_of.hpp"

namespace hotfire::plant {

HOTFIRE_FOR_EACH_PROCESSOR void advance(const model::Modal<double>& model, model::Modal<double>::State& state,
                                        const double& input) noexcept {
  model.step(state, input);
}

std::unique_ptr<Plant> make_plant(const model::Modal<double>::Parameters& parameters, const Setup& setup) {
  return PlantOf<ModalAdapter>::make(parameters, setup);
}

}  // namespace hotfire::plant
