// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/for_each_processor.hpp"
#include "tools/interface/plant/plant_of.hpp"

namespace hotfire::plant {

HOTFIRE_FOR_EACH_PROCESSOR void step_axis(const model::Simplex<double>& model, model::Simplex<double>::State& state,
                                          const double& command, const double& torque) noexcept {
  // Without a torque the step is cheaper and gives the same bits.
  if (torque == 0.0) {
    model.step(state, command);
  } else {
    model.step(state, command, under_torque(model, torque));
  }
}

std::unique_ptr<Plant> make_plant(const model::Simplex<double>::Parameters& parameters, const Setup& setup) {
  return PlantOf<SimplexAdapter>::make(parameters, setup);
}

}  // namespace hotfire::plant
