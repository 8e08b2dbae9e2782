// SPDX-License-Identifier: Apache-2.0
// Steps from random states under random commands, for callgrind to count: vehicle_cost.cmake runs it.
//   vehicle_cost axis|taos|masv[-alone|-block|-thrust|-disturbed] MODES

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/model/cost/disturbed.hpp"
#include "tests/model/cvode/axis_comparison.hpp"
#include "tests/model/support/vehicles.hpp"

namespace hotfire::test {
namespace {

using Axis = model::Simplex<double>;

constexpr int kSteps = 200;
constexpr double kStep = 5e-4;

}  // namespace

// callgrind knows it by name and counts what is inside.
extern "C" __attribute__((noinline)) void hotfire_measured_axis(const Axis& plant, Axis::State& state, double command);
void hotfire_measured_axis(const Axis& plant, Axis::State& state, double command) { plant.step(state, command); }
extern "C" __attribute__((noinline)) void hotfire_measured_taos(const Taos& plant, Taos::State& state,
                                                                const Taos::Inputs& inputs);
void hotfire_measured_taos(const Taos& plant, Taos::State& state, const Taos::Inputs& inputs) { plant.step(state, inputs); }
extern "C" __attribute__((noinline)) void hotfire_measured_masv(const Masv& plant, Masv::State& state,
                                                                const Masv::Inputs& inputs);
void hotfire_measured_masv(const Masv& plant, Masv::State& state, const Masv::Inputs& inputs) { plant.step(state, inputs); }

namespace {

void step_axis() {
  const Axis plant(hot_fire_axis().parameters, kStep);
  constexpr std::size_t friction = index_in<model::GimbalFriction>(Axis::Effects{});
  Random random(11);
  for (int i = 0; i < kSteps; ++i) {
    Axis::State state = plant.steady(random.uniform(-0.05, 0.05));
    const double size = random.one_in(2) ? 1.0 : 1e-5;
    disturb(state, random, size);
    std::get<friction>(state.effects.values).deflection = size * random.uniform(-1.0, 1.0) * 1.5e-4;
    hotfire_measured_axis(plant, state, random.uniform(-0.05, 0.05));
  }
}

/// Lets everything that can follow the thrust do so: friction, bearing, structure, trim.
template <class Parameters>
void follow_thrust(Parameters& parameters) {
  for (auto& gimbal : parameters.gimbals) {
    gimbal.bearing.rated_thrust = 1.86e6;
    gimbal.bearing.dead_load = -3.4e4;
    gimbal.bearing.unloaded_structure = 0.4;
    gimbal.bearing.pitch_misalignment = gimbal.bearing.yaw_misalignment = 3e-3;
    gimbal.friction.coulomb_torque = 0.0;
    gimbal.friction.coefficient = 0.08;
  }
}

/// What a step follows beside the commands: nothing, nothing with engines one after the other, a block in each bearing, the
/// thrust, or the thrust and all measured disturbances.
enum class Follows { commands, commands_alone, block, thrust, disturbances };

/// Gives every bearing a block that rings at a few hundred hertz.
template <class Parameters>
void add_blocks(Parameters& parameters) {
  for (auto& gimbal : parameters.gimbals) {
    gimbal.bearing.block_mass = 50.0;
    gimbal.bearing.block_inertia = 1.0;
  }
}

/// Torque on the axes, force and vibration on the bearing of an engine.
template <class Inputs>
void disturb_inputs(Inputs& inputs, int engine, Random& random) {
  for (int axis = 2 * engine; axis < 2 * engine + 2; ++axis) {
    inputs.torque[static_cast<std::size_t>(axis)] = random.either_sign(1.0, 1e5);
    inputs.vibration[static_cast<std::size_t>(axis)] = random.either_sign(1e-6, 0.1);
  }
  inputs.force[static_cast<std::size_t>(engine)] = {random.either_sign(1.0, 1e5), random.either_sign(1.0, 1e5),
                                                    random.either_sign(1.0, 1e5)};
}

template <class Vehicle, class Measured>
void step_vehicle(int modes, Follows follows, Measured&& measured) {
  typename Vehicle::Parameters parameters = hot_fire<Vehicle>();
  if (follows == Follows::block) {
    add_blocks(parameters);
  } else if (follows == Follows::thrust || follows == Follows::disturbances) {
    follow_thrust(parameters);
  }
  parameters.modes = random_modes<typename Vehicle::Modes>(modes, 1.0 / 1.05e8, 5);
  const Vehicle plant(parameters, kStep,
                      follows == Follows::commands_alone ? model::Stepping::one_by_one : model::Stepping::side_by_side);
  Random random(11);
  const typename Vehicle::State rest = plant.steady({});
  for (int i = 0; i < kSteps; ++i) {
    typename Vehicle::State state = rest;
    typename Vehicle::Inputs inputs;
    for (int e = 0; e < Vehicle::kEngines; ++e) {
      if (follows == Follows::thrust || follows == Follows::disturbances) {
        inputs.thrust[static_cast<std::size_t>(e)] = -random.uniform(0.0, 1.86e6);
      }
      if (follows == Follows::disturbances) {
        disturb_inputs(inputs, e, random);
      }
      const double size = random.one_in(2) ? 1.0 : 1e-5;
      for (int axis = 2 * e; axis < 2 * e + 2; ++axis) {
        disturb(state.axes[static_cast<std::size_t>(axis)], random, size);
        inputs.commands[static_cast<std::size_t>(axis)] = random.uniform(-0.05, 0.05);
      }
      auto& gimbal = state.gimbals[static_cast<std::size_t>(e)];
      gimbal.bristle = {size * random.uniform(-1e-4, 1e-4), size * random.uniform(-1e-4, 1e-4)};
      gimbal.torque = 1e8 * gimbal.bristle;
      for (auto& mode : gimbal.bearing.block.modes) {
        mode.velocity = follows == Follows::block ? random.either_sign(1e-9, 1.0) : 0.0;
      }
    }
    for (int k = 0; k < modes; ++k) {
      state.structure.modes[static_cast<std::size_t>(k)].displacement += random.either_sign(1e-9, 1e-2);
      state.structure.modes[static_cast<std::size_t>(k)].velocity = random.either_sign(1e-9, 1.0);
    }
    measured(plant, state, inputs);
  }
}

}  // namespace
}  // namespace hotfire::test

int main(int argc, char** argv) {
  using namespace hotfire::test;
  const std::string what = argc > 1 ? argv[1] : "";
  const int modes = argc > 2 ? static_cast<int>(std::strtol(argv[2], nullptr, 10)) : 0;
  const Follows follows = what.ends_with("-disturbed") ? Follows::disturbances
                          : what.ends_with("-thrust")  ? Follows::thrust
                          : what.ends_with("-block")   ? Follows::block
                          : what.ends_with("-alone")   ? Follows::commands_alone
                                                       : Follows::commands;
  if (what == "axis") {
    step_axis();
  } else if (what.starts_with("taos")) {
    step_vehicle<Taos>(modes, follows, hotfire_measured_taos);
  } else if (what.starts_with("masv")) {
    step_vehicle<Masv>(modes, follows, hotfire_measured_masv);
  } else {
    std::fputs("vehicle_cost axis|taos|masv[-alone|-block|-thrust|-disturbed] MODES\n", stderr);
    return 2;
  }
  return 0;
}
