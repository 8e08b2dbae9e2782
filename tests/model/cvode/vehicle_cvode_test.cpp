// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstdio>

#include "tests/model/cvode/vehicle_comparison.hpp"

namespace hotfire::test {
namespace {

// The figure asked for: half a percent of the signal's rms, in piston and engine of both axes.
constexpr double kLimit = 5e-3;

/// Checks the error at the two steps a sample that the tools take, and prints it beside that of one step a sample. Returns
/// the reference.
VehicleRows check_agreement(const char* name, const Taos::Parameters& parameters,
                            const Drive& drive = command_profile<Taos>()) {
  const VehicleRows reference = run_reference<Taos>(parameters, 1e-10, drive);
  constexpr std::array<const char*, 4> kNames{"pitch piston", "pitch engine", "yaw piston", "yaw engine"};
  const VehicleRows fine = run_model<Taos>(parameters, 2, drive);
  const VehicleRows coarse = run_model<Taos>(parameters, 1, drive);
  std::printf("\n%-34s", name);
  for (std::size_t channel = 0; channel < kNames.size(); ++channel) {
    const double error = relative_rms(fine, reference, channel);
    std::printf("  %s %.4f %% (1 ms: %.4f %%)", kNames[channel], 100.0 * error,
                100.0 * relative_rms(coarse, reference, channel));
    CHECK_TRUE_TEXT(error < kLimit, kNames[channel]);
  }
  return reference;
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

/// Checks that the model without the physics in question parts from the reference that has it by at least twice the limit:
/// the agreement is not one that they reach without.
void check_difference(const char* name, const Taos::Parameters& without, const VehicleRows& reference,
                      const Drive& drive = command_profile<Taos>()) {
  const double difference = largest_error(run_model<Taos>(without, 2, drive), reference);
  std::printf("\n%-34s %.2f %%", name, 100.0 * difference);
  CHECK_TRUE_TEXT(difference > 2.0 * kLimit, name);
}

/// Thrust from zero to full and halfway back, the friction of the bearing mu N r: what follows the thrust follows it.
Taos::Parameters follows_thrust() {
  Taos::Parameters parameters = hot_fire<Taos>();
  auto& gimbal = parameters.gimbals[0];
  gimbal.bearing.rated_thrust = gimbal.bearing.thrust;
  gimbal.bearing.dead_load = -3.4e4;
  gimbal.bearing.unloaded_structure = 0.4;
  gimbal.bearing.pitch_misalignment = 3e-3;
  gimbal.bearing.yaw_misalignment = -2e-3;
  gimbal.friction.coulomb_torque = 0.0;
  gimbal.friction.coefficient = 0.08;
  return parameters;
}

/// The profile, with thrust from zero at 0.2 s to full at 0.5 s and to half of it from 0.8 to 1 s.
Drive thrust_profile(double full) {
  Drive drive = command_profile<Taos>();
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double t = static_cast<double>(i) * kSample;
    const double up = std::clamp((t - 0.2) / 0.3, 0.0, 1.0);
    const double down = std::clamp((t - 0.8) / 0.2, 0.0, 1.0);
    drive[i].thrust = {full * (up - 0.5 * down - 1.0)};
  }
  return drive;
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

/// A bearing that only the actuators and a disturbance seat: no thrust holds it down.
Taos::Parameters unseated() {
  Taos::Parameters parameters = smooth();
  auto& bearing = parameters.gimbals[0].bearing;
  bearing.thrust = 0.0;
  bearing.unloaded_stiffness = 0.02;
  bearing.load_scale = 4e4;
  return parameters;
}

/// The profile, with a force and a torque that load the bearing in turn and leave it.
Drive unseating_profile() {
  Drive drive = command_profile<Taos>();
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * 5.0 * static_cast<double>(i) * kSample;
    drive[i].force = {{3e4 * std::sin(angle), 1e4 * std::sin(0.7 * angle), -1e4 * std::sin(1.3 * angle)}};
    drive[i].torque = {2e3 * std::sin(0.6 * angle), -2e3 * std::sin(0.8 * angle)};
  }
  return drive;
}

// A hundredth of a percent, and steps a sample of 1 ms at which the model's own error, second order, is well below it.
constexpr double kBlockLimit = 1e-4;
constexpr int kFineParts = 16;

/// Checks the error of the largest channel with a block of `inertia` [kg m^2] and fifty times its figure in kg. Returns the
/// error that both halves in series, without a block, would have.
double check_block(const char* name, Taos::Parameters parameters, double inertia,
                   const Drive& drive = command_profile<Taos>()) {
  auto& bearing = parameters.gimbals[0].bearing;
  const VehicleRows without = run_model<Taos>(parameters, kFineParts, drive);
  bearing.block_mass = 50.0 * inertia;
  bearing.block_inertia = inertia;
  const VehicleRows reference = run_reference<Taos>(parameters, 1e-8, drive);
  const double error = largest_error(run_model<Taos>(parameters, kFineParts, drive), reference);
  const double in_series = largest_error(without, reference);
  std::printf("\n%-34s  %.4f %%  halves in series %.4f %%", name, 100.0 * error, 100.0 * in_series);
  CHECK_TRUE_TEXT(error < kBlockLimit, name);
  return in_series;
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

TEST(VehicleAgreesWithCvode, WithFrictionThatFollowsTheLoadOnTheBearing) {
  Taos::Parameters parameters = follows_thrust();
  parameters.modes = four_modes();
  const VehicleRows reference = check_agreement("mu N r, four modes", parameters);
  parameters.gimbals[0].friction.coefficient = 0.0;
  check_difference("without friction", parameters, reference);
}

TEST(VehicleAgreesWithCvode, FromAmbientToHotFireAndBackInOneRun) {
  const Taos::Parameters parameters = follows_thrust();
  const Drive drive = thrust_profile(parameters.gimbals[0].bearing.thrust);
  const VehicleRows reference = check_agreement("thrust rises and falls", parameters, drive);
  Taos::Parameters without = parameters;
  auto& friction = without.gimbals[0].friction;
  friction.coulomb_torque = friction.sliding_torque(parameters.gimbals[0].bearing.thrust);
  friction.coefficient = 0.0;
  check_difference("friction of full thrust", without, reference, drive);
  without = parameters;
  without.gimbals[0].bearing.unloaded_structure = 1.0;
  check_difference("structure of full tanks", without, reference, drive);
  without = parameters;
  without.gimbals[0].bearing.pitch_misalignment = without.gimbals[0].bearing.yaw_misalignment = 0.0;
  check_difference("thrust through the centre", without, reference, drive);
}

// The actuators and a disturbance seat the bearing and unseat it, without thrust to hold it down.
TEST(VehicleAgreesWithCvode, OnABearingThatIsSofterWithoutLoad) {
  Taos::Parameters parameters = unseated();
  const Drive drive = unseating_profile();
  const VehicleRows reference = check_agreement("softer without load", parameters, drive);
  parameters.gimbals[0].bearing.unloaded_stiffness = 1.0;
  check_difference("as stiff without load", parameters, reference, drive);
}

TEST(VehicleAgreesWithCvode, WithDahlsExponentAndTheViscousFrictionOfTheSlip) {
  Taos::Parameters parameters = follows_thrust();
  auto& friction = parameters.gimbals[0].friction;
  friction.choose(model::BearingFriction<double>::Law::dahl);
  friction.coefficient = 0.035;
  friction.stiffness = 1e7;
  friction.exponent = 2.0;
  friction.viscous = 8e3;
  const VehicleRows reference = check_agreement("Dahl's exponent 2, sigma2", parameters);
  friction.exponent = 1.0;
  check_difference("exponent 1", parameters, reference);
  friction.exponent = 2.0;
  friction.viscous = 0.0;
  check_difference("without sigma2", parameters, reference);
}

TEST(VehicleAgreesWithCvode, WithVibrationThatFollowsTheThrust) {
  Taos::Parameters parameters = follows_thrust();
  auto& gimbal = parameters.gimbals[0];
  gimbal.friction.choose(model::BearingFriction<double>::Law::vibrated_lugre);
  gimbal.friction.vibration_ratio = 0.4;
  gimbal.friction.vibration_velocity = 0.02;
  const Drive drive = thrust_profile(gimbal.bearing.thrust);
  const VehicleRows reference = check_agreement("vibrated_lugre, thrust rises", parameters, drive);
  gimbal.friction.vibration_ratio = 1.0;
  check_difference("without vibration", parameters, reference, drive);
}

// Friction between the halves, a bearing whose forces turn it. A block of 50 kg within 0.14 m of the gimbal's centre has
// less than 1 kg m^2, and rings beyond 600 Hz: hardly anything tells it from halves in series. A hundred times as much does.
TEST(VehicleAgreesWithCvode, WithABlockBetweenTheHalvesOfTheBearing) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.gimbals[0].bearing.vehicle_side_flexibility = 0.6;
  check_block("block of 1 kg m^2", parameters, 1.0);
  CHECK_TRUE(check_block("block of 100 kg m^2", parameters, 100.0) > kBlockLimit);
}

// What the joint gives way by without load is on the engine's side of the block, which is heavy enough to be seen.
TEST(VehicleAgreesWithCvode, WithABlockInABearingThatIsSofterWithoutLoad) {
  Taos::Parameters parameters = unseated();
  parameters.modes = {};
  CHECK_TRUE(check_block("block, softer without load", parameters, 800.0, unseating_profile()) > kBlockLimit);
}

// The reference has what the model leaves out: a mount that turns carries the block along, which pushes it.
TEST(VehicleAgreesWithCvode, WithABlockOnAMountThatTurns) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  CHECK_TRUE(check_block("block on a mount that turns", parameters, 100.0) > kBlockLimit);
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
  const Drive drive = command_profile<Masv>(0.01);
  const VehicleRows reference = run_reference<Masv>(parameters, 1e-8, drive);
  const double coarse = largest_error(run_model<Masv>(parameters, 2, drive), reference);
  const double fine = largest_error(run_model<Masv>(parameters, 8, drive), reference);
  std::printf("\nfour engines, linear limit: %.5f %% at 0.5 ms, %.5f %% at 0.125 ms", 100.0 * coarse, 100.0 * fine);
  CHECK_TRUE(fine < 1e-4);
}

}  // namespace hotfire::test
