// SPDX-License-Identifier: Apache-2.0
// The engines of a MASV side by side in lanes against one after the other: the same bits.
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "model/vehicle.hpp"
#include "tests/model/support/every_effect.hpp"
#include "tests/model/support/vehicles.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::test {
namespace {

constexpr double kLaneStep = 5e-4;
constexpr int kLaneSteps = 120;

using Parameters = Masv::Parameters;

/// Hot fire on modes, with numbers of its own in every engine and axis.
std::unique_ptr<Parameters> uneven(int modes) {
  auto parameters = std::make_unique<Parameters>(hot_fire<Masv>());
  parameters->modes = random_modes<Masv::Modes>(modes, 1.0 / 1.05e8, 5);
  for (std::size_t i = 0; i < Masv::kAxes; ++i) {
    const auto place = static_cast<double>(i);
    auto& axis = parameters->axes[i];
    axis.engine.inertia *= 1.0 + 0.02 * place;
    axis.servovalve.position_gain *= 1.0 - 0.01 * place;
    axis.structure.stiffness *= 1.0 + 0.03 * place;
    parameters->attach[i].vehicle_x += 0.01 * place;
  }
  for (std::size_t e = 0; e < Masv::kEngines; ++e) {
    auto& gimbal = parameters->gimbals[e];
    gimbal.stiffness *= 1.0 + 0.1 * static_cast<double>(e);
    gimbal.friction.coulomb_torque *= 1.0 + 0.2 * static_cast<double>(e);
    gimbal.friction.vibration_ratio = 0.4;
  }
  return parameters;
}

/// Inputs of every kind, another in every step.
Masv::Inputs any_inputs(Random& random) {
  Masv::Inputs inputs;
  for (std::size_t i = 0; i < Masv::kAxes; ++i) {
    inputs.commands[i] = random.uniform(-0.05, 0.05);
    inputs.torque[i] = random.either_sign(1.0, 1e4);
    inputs.vibration[i] = random.either_sign(1e-6, 0.02);
  }
  for (std::size_t e = 0; e < Masv::kEngines; ++e) {
    inputs.thrust[e] = -random.uniform(0.0, 1e6);
    inputs.force[e] = {random.either_sign(1.0, 1e4), random.either_sign(1.0, 1e4), random.either_sign(1.0, 1e4)};
  }
  return inputs;
}

/// Every number of a state, but for the memories of effects: those act on the numbers of the next steps.
std::vector<std::uint64_t> bits_of(const Masv::State& state) {
  std::vector<std::uint64_t> bits;
  const auto add = [&bits](double number) { bits.push_back(std::bit_cast<std::uint64_t>(number)); };
  const auto add_all = [&add](const auto& numbers) { std::for_each(numbers.begin(), numbers.end(), add); };
  for (const auto& axis : state.axes) {
    add_all(axis.y);
    add_all(axis.inputs);
    add_all(axis.effects.outputs);
    add_all(axis.measured);
    add(axis.spring_force);
    add(axis.built_up);
    add(axis.clock.at(kLaneStep));
  }
  for (const auto& gimbal : state.gimbals) {
    add_all(gimbal.bearing.displacement);
    add_all(gimbal.bearing.block.displacement);
    for (const auto& mode : gimbal.bearing.block.modes) {
      add(mode.displacement);
      add(mode.velocity);
    }
    for (const double number : {gimbal.bristle.pitch, gimbal.bristle.yaw, gimbal.torque.pitch, gimbal.torque.yaw}) {
      add(number);
    }
  }
  for (const auto& mode : state.structure.modes) {
    add(mode.displacement);
    add(mode.velocity);
  }
  add_all(state.structure.forces);
  add_all(state.softening);
  add_all(state.measured);
  return bits;
}

/// Runs a vehicle both ways from the same state.
void check_bits(const Parameters& parameters) {
  const auto beside = std::make_unique<Masv>(parameters, kLaneStep);
  const auto alone = std::make_unique<Masv>(parameters, kLaneStep, model::Stepping::one_by_one);
  CHECK_EQUAL(model::kHasRegistersOfLanes, beside->steps_side_by_side());
  CHECK_FALSE(alone->steps_side_by_side());
  Masv::State own = beside->steady({0.01, -0.01, 0.02});
  Masv::State other = alone->steady({0.01, -0.01, 0.02});
  CHECK_TRUE(bits_of(own) == bits_of(other));
  Random random(17);
  for (int k = 0; k < kLaneSteps; ++k) {
    const Masv::Inputs inputs = any_inputs(random);
    beside->step(own, inputs);
    alone->step(other, inputs);
    CHECK_TRUE(std::isfinite(own.measured[1]));
    CHECK_TRUE(bits_of(own) == bits_of(other));
  }
}

/// Typical values of a law, different on each axis, and for the third engine those that add nothing.
template <class E>
ParamsOf<E, double> values_of_axis(int law, int axis) {
  ParamsOf<E, double> params = typical<E, double>(law);
  const ParamsOf<E, double> nothing = neutral<E, double>(law);
  const double factor = 1.0 - 0.02 * axis;
  for (const auto& field : ParamsOf<E, double>::fields()) {
    if (used_by(field, law)) {
      double& value = params.*field.member;
      value = axis / 2 == 2 ? nothing.*field.member : std::clamp(factor * value, field.lower, field.upper);
    }
  }
  if constexpr (requires { params.table; }) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(params.table.points); ++i) {
      params.table.x[i] *= factor;
      params.table.y[i] *= factor;
    }
  }
  return params;
}

bool runs_side_by_side(const Parameters& parameters) {
  return std::make_unique<Masv>(parameters, kLaneStep)->steps_side_by_side();
}

}  // namespace

TEST_GROUP(VehicleLanes){};

TEST(VehicleLanes, EveryLawOfFrictionHasTheSameBits) {
  for (int law = 0; law < 4; ++law) {
    for (const double exponent : {1.0, 2.5}) {
      auto parameters = uneven(9);
      for (auto& gimbal : parameters->gimbals) {
        gimbal.friction.option = law;
        gimbal.friction.exponent = exponent;
      }
      // One engine that does not rub, and one whose exponent does nothing.
      parameters->gimbals[1].friction.coulomb_torque = 0.0;
      parameters->gimbals[2].friction.exponent = 1.0;
      check_bits(*parameters);
    }
  }
}

TEST(VehicleLanes, EveryKindOfBearingHasTheSameBits) {
  const std::vector<std::function<void(model::GimbalParameters<double>&, double)>> kinds{
      [](auto& gimbal, double) { gimbal.compliant = false; },
      [](auto& gimbal, double place) {
        gimbal.bearing.block_mass = 50.0 + 5.0 * place;
        gimbal.bearing.block_inertia = 1.0 + 0.1 * place;
      },
      [](auto& gimbal, double place) {
        gimbal.bearing.rated_thrust = place == 1.0 ? 0.0 : 1.86e6;
        gimbal.bearing.unloaded_stiffness = place == 2.0 ? 1.0 : 0.3;
        gimbal.bearing.unloaded_structure = place == 1.0 ? 1.0 : 0.4;
        gimbal.bearing.pitch_misalignment = 3e-3;
        gimbal.friction.coefficient = 0.08;
        gimbal.friction.coulomb_torque = 0.0;
      },
      [](auto& gimbal, double place) {
        gimbal.vibration.pitch_velocity = 0.02;
        gimbal.vibration.frequency = 100.0 + place;
      }};
  for (const auto& put_into : kinds) {
    for (const int modes : {0, 64}) {
      auto parameters = uneven(modes);
      for (std::size_t e = 0; e < Masv::kEngines; ++e) {
        put_into(parameters->gimbals[e], static_cast<double>(e));
      }
      check_bits(*parameters);
    }
  }
  auto constant = uneven(3);
  constant->constant_arms.fill(true);
  check_bits(*constant);
}

TEST(VehicleLanes, EveryEffectHasTheSameBits) {
  Masv::Effects::for_each([]<class E, std::size_t>() {
    const int laws = E::options.size() == 0 ? 1 : static_cast<int>(E::options.size());
    for (int law = 0; law < laws; ++law) {
      auto parameters = uneven(5);
      // On all axes, and on the yaw axes alone.
      for (int axis = law % 2; axis < Masv::kAxes; axis += 1 + law % 2) {
        activate_in<E, Masv>(*parameters, axis, values_of_axis<E>(law, axis));
      }
      check_bits(*parameters);
    }
  });
}

TEST(VehicleLanes, WhatLanesShareMustBeTheSameInAllEngines) {
  if (!model::kHasRegistersOfLanes) {
    return;
  }
  auto parameters = uneven(5);
  CHECK_TRUE(runs_side_by_side(*parameters));
  constexpr std::size_t kLeakage = index_in<model::Leakage>(Masv::Effects{});
  constexpr std::size_t kSoft = index_in<model::SoftStiffness>(Masv::Effects{});
  using Change = std::function<void(Parameters&)>;
  const std::vector<Change> changes{
      [](Parameters& own) { own.axes[3].effects.active[kLeakage] = true; },
      [](Parameters& own) { std::get<kSoft>(own.axes[4].effects.values).option = 1; },
      [](Parameters& own) { ++std::get<kSoft>(own.axes[4].effects.values).table.points; },
      [](Parameters& own) { own.gimbals[2].friction.option = 0; },
      [](Parameters& own) { own.gimbals[1].compliant = false; },
      [](Parameters& own) { own.constant_arms[3] = true; },
      [](Parameters& own) { own.gimbals[3].vibration.pitch_velocity = 0.01; },
      [](Parameters& own) { own.gimbals[0].bearing.block_mass = own.gimbals[0].bearing.block_inertia = 10.0; }};
  for (const Change& change : changes) {
    auto changed = std::make_unique<Parameters>(*parameters);
    change(*changed);
    CHECK_FALSE(runs_side_by_side(*changed));
  }
  // All yaw axes may differ from all pitch axes.
  for (std::size_t yaw = 1; yaw < Masv::kAxes; yaw += 2) {
    parameters->axes[yaw].effects.active[kLeakage] = true;
  }
  CHECK_TRUE(runs_side_by_side(*parameters));
}

// A fault on one axis makes the engines unlike: the run goes on from the same state.
TEST(VehicleLanes, AStateGoesFromOneWayToTheOther) {
  const auto parameters = uneven(12);
  const auto beside = std::make_unique<Masv>(*parameters, kLaneStep);
  const auto alone = std::make_unique<Masv>(*parameters, kLaneStep, model::Stepping::one_by_one);
  Masv::State straight = beside->steady({});
  Masv::State turns = straight;
  Random random(3);
  for (int k = 0; k < kLaneSteps; ++k) {
    const Masv::Inputs inputs = any_inputs(random);
    beside->step(straight, inputs);
    (k % 7 < 3 ? beside : alone)->step(turns, inputs);
  }
  CHECK_TRUE(bits_of(straight) == bits_of(turns));
}

TEST(VehicleLanes, AnAxisIsTheSameBothWays) {
  const auto parameters = uneven(2);
  const auto beside = std::make_unique<Masv>(*parameters, kLaneStep);
  const auto alone = std::make_unique<Masv>(*parameters, kLaneStep, model::Stepping::one_by_one);
  for (int i = 0; i < Masv::kAxes; ++i) {
    CHECK_TRUE(beside->axis(i).stiffness() == alone->axis(i).stiffness());
    CHECK_TRUE(beside->axis(i).engine_compliance() == alone->axis(i).engine_compliance());
    CHECK_TRUE(beside->axis(i).parameters().actuator.moment_arm == alone->axis(i).parameters().actuator.moment_arm);
    CHECK_TRUE(beside->geometry(i / 2).at(0.02, -0.03).stroke == alone->geometry(i / 2).at(0.02, -0.03).stroke);
  }
}

TEST(VehicleLanes, StepDoesNotAllocate) {
  const auto beside = std::make_unique<Masv>(*uneven(64), kLaneStep);
  Masv::State state = beside->steady({});
  Random random(3);
  const Masv::Inputs inputs = any_inputs(random);
  const AllocationGuard guard;
  beside->step(state, inputs);
  LONGS_EQUAL(0, guard.allocations());
}

}  // namespace hotfire::test
