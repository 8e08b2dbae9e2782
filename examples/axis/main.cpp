// SPDX-License-Identifier: Apache-2.0
// One hydraulic axis with gimbal friction, stepped through a command of 10 mrad: the C++ headers alone.

#include <hotfire/keys.hpp>
#include <hotfire/simplex.hpp>

#include <cstdio>

using Axis = hotfire::model::Simplex<double>;

int main() {
  Axis::Parameters parameters;  // the reference values of docs/physics.md
  parameters.engine.inertia = 9000.0;
  hotfire::model::visit_effects(parameters, [&]<class Effect>(std::size_t index, auto& values) {
    if constexpr (Effect::name == "gimbal_friction") {
      parameters.effects.active[index] = true;
      values.option = 1;  // LuGre
      values.coulomb_torque = 12e3;
    }
  });

  const Axis axis(parameters, 5e-4);     // constants for a step of 0.5 ms
  Axis::State state = axis.steady(0.0);  // a copy of the state is a checkpoint
  for (int step = 0; step <= 1000; ++step) {
    if (step % 100 == 0) {
      const auto& [piston, engine, pressure] = Axis::measured(state);
      std::printf("%.2f s  piston %8.5f m  engine %8.5f rad  pressure %9.0f Pa\n", step * 5e-4, piston, engine, pressure);
    }
    axis.step(state, 0.010);
  }
}
