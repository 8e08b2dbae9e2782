// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstdio>

#include "tests/model/cvode/vehicle_comparison.hpp"

namespace hotfire::test {
namespace {

// The figure asked for: half a percent of the signal's rms, in piston and engine of both axes.
constexpr double kLimit = 5e-3;

/// Checks the error at the two steps a sample that the tools take, and prints it beside that of one step a sample.
void check_agreement(const char* name, const Taos::Parameters& parameters) {
  const VehicleRows reference = run_reference<Taos>(parameters);
  constexpr std::array<const char*, 4> kNames{"pitch piston", "pitch engine", "yaw piston", "yaw engine"};
  const VehicleRows fine = run_model<Taos>(parameters, 2);
  const VehicleRows coarse = run_model<Taos>(parameters, 1);
  std::printf("\n%-34s", name);
  for (std::size_t channel = 0; channel < kNames.size(); ++channel) {
    const double error = relative_rms(fine, reference, channel);
    std::printf("  %s %.4f %% (1 ms: %.4f %%)", kNames[channel], 100.0 * error,
                100.0 * relative_rms(coarse, reference, channel));
    CHECK_TRUE_TEXT(error < kLimit, kNames[channel]);
  }
}

/// Checks the order of convergence towards the reference of every piston and engine, mean over three halvings of a step of
/// half a millisecond.
void check_order(const char* name, const Taos::Parameters& parameters, double least) {
  const VehicleRows reference = run_reference<Taos>(parameters);
  const VehicleRows coarse = run_model<Taos>(parameters, 2);
  const VehicleRows fine = run_model<Taos>(parameters, 16);
  for (const std::size_t channel : {0U, 1U, 2U, 3U}) {
    const double order = std::log2(relative_rms(coarse, reference, channel) / relative_rms(fine, reference, channel)) / 3.0;
    std::printf("\norder %s: %.2f", name, order);
    CHECK_TRUE(order > least);
  }
}

/// Hot fire without what is not smooth: no friction, no lap of the valve.
Taos::Parameters smooth() {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.gimbals[0].friction.coulomb_torque = 0.0;
  for (auto& axis : parameters.axes) {
    axis.effects.active[index_in<model::ValveDeadband>(Taos::Effects{})] = false;
  }
  parameters.modes = four_modes();
  return parameters;
}

}  // namespace

TEST_GROUP(VehicleAgreesWithCvode){};

TEST(VehicleAgreesWithCvode, WithTheDeclaredPartsAlone) { check_agreement("declared", Taos::Parameters{}); }

TEST(VehicleAgreesWithCvode, AtHotFireWithEveryEffect) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  check_agreement("hot fire, four modes", parameters);
}

TEST(VehicleAgreesWithCvode, WithFrictionThatVibrationLowers) {
  Taos::Parameters parameters = hot_fire<Taos>();
  auto& friction = parameters.gimbals[0].friction;
  friction.choose(model::BearingFriction<double>::Law::vibrated_lugre);
  friction.vibration_ratio = 0.4;
  friction.vibration_velocity = 0.02;
  check_agreement("hot fire, vibrated_lugre", parameters);
}

// The components of a bristle vector meet through the length of the slip alone: each axis can carry its own.
TEST(VehicleAgreesWithCvode, WithTheFrictionOfTheBearingGivenAxisByAxis) {
  Taos::Parameters rigid = smooth();
  rigid.modes = {};
  rigid.gimbals[0].compliant = false;
  auto& bearing = rigid.gimbals[0].friction;
  bearing.choose(model::BearingFriction<double>::Law::lugre);
  bearing.coulomb_torque = 1e4;
  bearing.static_ratio = 1.2;
  bearing.damping = 500.0;
  const VehicleRows reference = run_reference<Taos>(rigid);
  Taos::Parameters parameters = rigid;
  parameters.gimbals[0].friction.coulomb_torque = 0.0;
  constexpr std::size_t kFriction = index_in<model::GimbalFriction>(Taos::Effects{});
  for (auto& axis : parameters.axes) {
    axis.effects.active[kFriction] = true;
    std::get<kFriction>(axis.effects.values) = {
        option_named<model::GimbalFriction>("vector_lugre"), 1e4, bearing.stiffness, 1.2, bearing.stribeck_velocity, 500.0};
  }
  const VehicleRows rows = run_model<Taos>(parameters, 2);
  for (std::size_t channel = 0; channel < 4; ++channel) {
    CHECK_TRUE(relative_rms(rows, reference, channel) < kLimit);
  }
}

// Ducts that pull the other way by as much as they resist, and a follower force that is not symmetric.
TEST(VehicleAgreesWithCvode, WithTorqueFromTheOtherAxis) {
  Taos::Parameters parameters = smooth();
  constexpr std::size_t kCross = index_in<model::CrossAxis>(Taos::Effects{});
  for (std::size_t axis = 0; axis < 2; ++axis) {
    parameters.axes[axis].effects.active[kCross] = true;
    auto& cross = std::get<kCross>(parameters.axes[axis].effects.values);
    cross.stiffness = axis == 0 ? 2e6 : -1e6;
    cross.damping = 4e4;
  }
  check_agreement("torque from the other axis", parameters);
}

// A bearing that gives way along the thrust shows where they push, modes what they carry to the structure.
TEST(VehicleAgreesWithCvode, WithTheDeclaredArmsAtAnyAngle) {
  Taos::Parameters parameters = smooth();
  parameters.constant_arms.fill(true);
  parameters.axes[1].actuator.moment_arm = 0.6;
  check_agreement("declared arms", parameters);
}

// The structure alone carries the actuators, and gives way by more than they do.
TEST(VehicleAgreesWithCvode, OnAStructureSofterThanTheActuators) {
  Taos::Parameters parameters = smooth();
  parameters.modes.shape.topRows<2>() *= 4.0;
  check_agreement("soft structure", parameters);
}

// Stiff ducts and strong damping on a mount that turns: what they hand to the vehicle, and take from its rotation, is then a
// good part of the engine's torque.
TEST(VehicleAgreesWithCvode, OnAMountThatTurnsUnderStiffDucts) {
  Taos::Parameters parameters = smooth();
  parameters.modes.shape.bottomRows<2>() *= 100.0;
  for (auto& axis : parameters.axes) {
    axis.engine.duct_stiffness = 4e6;
    axis.engine.viscous_damping = 1e5;
  }
  check_agreement("turning mount", parameters);
}

TEST(VehicleAgreesWithCvode, WithTheSecondOrderWhereItIsSmooth) { check_order("without friction", smooth(), 1.8); }

TEST(VehicleAgreesWithCvode, WithAtLeastTheFirstOrderUnderFriction) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  check_order("with friction", parameters, 1.0);
}

// A block of 50 kg within 0.14 m of the gimbal's centre has less than 1 kg m^2. Given to each half, on half of the bearing's
// torsion, it changes what engine and pistons do by less than a thousandth of what the halves' torsion does itself, which a
// hundred times as much inertia does not.
TEST(VehicleAgreesWithCvode, WithTwoHalvesOfTheBearingAndTheInertiaOfItsBlock) {
  Taos::Parameters parameters = hot_fire<Taos>();
  auto& gimbal = parameters.gimbals[0];
  gimbal.stiffness = Eigen::Matrix<double, 6, 6>(gimbal.stiffness.diagonal().asDiagonal());
  const Taos plant(parameters, kSample);
  const auto with_inertia = [&](double inertia) {
    ReferenceVehicle vehicle = reference_of<Taos>(parameters, plant);
    vehicle.engines[0].half_inertia = inertia;
    return integrate_reference(vehicle, start_of(plant.steady({}), 0), command_profile<Taos>(), kSample, 1e-8);
  };
  const VehicleRows model = run_model<Taos>(parameters, 4);
  Taos::Parameters rigid = parameters;
  rigid.gimbals[0].compliant = false;
  const double torsion = largest_error(run_model<Taos>(rigid, 4), model);
  const double block = largest_error(model, with_inertia(1.0));
  const double heavy = largest_error(model, with_inertia(100.0));
  std::printf("\nrigid gimbal %.3f %%, block of 1 kg m^2 %.4f %%, of 100 kg m^2 %.3f %%", 100.0 * torsion, 100.0 * block,
              100.0 * heavy);
  CHECK_TRUE(block < 1e-3 * torsion);
  CHECK_TRUE(heavy > 1e-3 * torsion);
}

// Four engines that feel each other through twelve modes. The reference's differences for a Jacobian of 120 states take
// their time, so its tolerance is wider: still a thousandth of the limit.
TEST(VehicleAgreesWithCvode, WithFourEnginesOnOneStructure) {
  Masv::Parameters parameters = hot_fire<Masv>();
  parameters.modes = random_modes<Masv::Modes>(12, 0.1 / 1.05e8, 7);
  const double error = largest_error(run_model<Masv>(parameters, 2), run_reference<Masv>(parameters, 1e-7));
  std::printf("\nfour engines, twelve modes: %.4f %%", 100.0 * error);
  CHECK_TRUE(error < kLimit);
}

// The modes and axes without friction, lap, softness and thrust, under commands so small that neither the flow's root nor
// the angles' sines count.
TEST(VehicleAgreesWithCvode, WithFourEnginesInTheLinearLimit) {
  Masv::Parameters parameters;
  parameters.modes = random_modes<Masv::Modes>(12, 0.3 / 1.05e8, 7);
  for (auto& axis : parameters.axes) {
    axis.structure.stiffness = 1.05e8 / 0.7;
  }
  const VehicleRows reference = run_reference<Masv>(parameters, 1e-8, 0.01);
  const double coarse = largest_error(run_model<Masv>(parameters, 2, 0.01), reference);
  const double fine = largest_error(run_model<Masv>(parameters, 8, 0.01), reference);
  std::printf("\nfour engines, linear limit: %.5f %% at 0.5 ms, %.5f %% at 0.125 ms", 100.0 * coarse, 100.0 * fine);
  CHECK_TRUE(fine < 1e-4);
}

}  // namespace hotfire::test
