// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/plant_of.hpp"

// Two versions of a function need a compiler and a C library that choose between them at load time. The functions that
// sanitizers add are not there yet when that happens.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOTFIRE_FOR_EACH_PROCESSOR __attribute__((target_clones("default", "avx2"), flatten))
#else
#define HOTFIRE_FOR_EACH_PROCESSOR
#endif

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
