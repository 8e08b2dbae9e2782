// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstdio>
#include <numbers>

#include "tests/model/cvode/axis_comparison.hpp"

namespace hotfire::test {
namespace {

using Plant = model::Simplex<double>;
using Case = AxisCase;
using study::ReferenceAxis;

// The figure asked for: half a percent of the signal's rms, in piston and engine.
constexpr double kLimit = 5e-3;

/// Checks the error at the two steps a sample that the tools take, and prints it beside that of one step a sample.
void check_agreement(const Case& test) {
  const study::ReferenceRows reference =
      study::integrate_reference(test.reference, axis_commands(), kAxisSample, test.settling);
  const study::ReferenceRows fine = run_axis(test.parameters, 2);
  const study::ReferenceRows coarse = run_axis(test.parameters, 1);
  std::printf("\n%-28s 0.5 ms: piston %.4f %% engine %.4f %%   1 ms: piston %.4f %% engine %.4f %%", test.name,
              100.0 * relative_rms(fine, reference, 0), 100.0 * relative_rms(fine, reference, 1),
              100.0 * relative_rms(coarse, reference, 0), 100.0 * relative_rms(coarse, reference, 1));
  CHECK_TRUE_TEXT(relative_rms(fine, reference, 0) < kLimit, test.name);
  CHECK_TRUE_TEXT(relative_rms(fine, reference, 1) < kLimit, test.name);
}

}  // namespace

TEST_GROUP(AgreesWithCvode){};

TEST(AgreesWithCvode, OnTheDeclaredModel) { check_agreement({"declared"}); }

TEST(AgreesWithCvode, WhereTheValveSaturates) {
  Case test{"saturation"};
  test.parameters.servovalve.position_gain = 3000.0;
  test.parameters.servovalve.rated_flow = 1.5e-3;
  test.reference.position_gain = 3000.0;
  test.reference.rated_flow = 1.5e-3;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnFrictionSoftStiffnessAndDeadbandTogether) {
  Case test{"friction + soft + deadband"};
  add_lugre(test, 8e3, 1e7, 1.2, 0.01, 1e3);
  add_soft(test, 4e7, 8e3);
  add_deadband(test, 0.02);
  check_agreement(test);
}

// The stiff gimbal of physics.md section 3: the piston is held so tight that the notch is gone.
TEST(AgreesWithCvode, OnHotFireFrictionOfARigidGimbal) {
  Case test{"hot fire, rigid gimbal"};
  test.parameters.structure.stiffness = 1.05e8;
  test.reference.load_stiffness = 1.05e8;
  add_lugre(test, 45e3, 5e8, 1.0, 0.01, 0.0);
  check_agreement(test);
}

TEST(AgreesWithCvode, OnLugreFriction) {
  Case test{"gimbal_friction lugre"};
  add_lugre(test, 8e3, 1e7, 1.2, 0.01, 1e3);
  check_agreement(test);
}

TEST(AgreesWithCvode, OnDahlFriction) {
  Case test{"gimbal_friction dahl"};
  activate<model::GimbalFriction, Plant>(test.parameters,
                                         {option_named<model::GimbalFriction>("dahl"), 8e3, 1e7, 1.0, 0.01, 0.0});
  test.reference.bristle = {8e3, 1e7, 1.0, 1.0, 0.0, 1.0};
  check_agreement(test);
}

TEST(AgreesWithCvode, OnFrictionThatVibrationLowers) {
  Case test{"gimbal_friction vibrated"};
  activate<model::GimbalFriction, Plant>(
      test.parameters, {option_named<model::GimbalFriction>("vibrated_lugre"), 8e3, 1e7, 1.1, 0.01, 1e3, 0.4, 0.02});
  const double dies_at = 2.0 * std::sqrt(2.0 * std::numbers::e) * 0.4 * 8e3 / 1e3;
  test.reference.bristle = {8e3, 1e7, 1.1, 0.01, 1e3, dies_at, 0.4, 0.02};
  check_agreement(test);
}

// The spring takes as much as the bristle, then five times as much.
TEST(AgreesWithCvode, OnFrictionBehindTheComplianceOfTheGimbal) {
  for (const double spring : {1e7, 2e6}) {
    Case test{spring > 5e6 ? "gimbal_compliance 1e7" : "gimbal_compliance 2e6"};
    activate<model::GimbalFriction, Plant>(test.parameters,
                                           {option_named<model::GimbalFriction>("dahl"), 8e3, 1e7, 1.0, 0.01, 0.0});
    activate<model::GimbalCompliance, Plant>(test.parameters, {0, spring});
    test.reference.bristle = {8e3, 1e7, 1.0, 1.0, 0.0, 1.0};
    test.reference.gimbal_stiffness = spring;
    check_agreement(test);
  }
}

TEST(AgreesWithCvode, OnRigidCoulombFriction) {
  Case test{"gimbal_friction coulomb"};
  activate<model::GimbalFriction, Plant>(test.parameters,
                                         {option_named<model::GimbalFriction>("coulomb"), 8e3, 1e7, 1.0, 0.01, 0.0});
  test.reference.coulomb.level = 8e3;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnPistonFrictionOfAnElasticSeal) {
  Case test{"piston_friction elastoplastic"};
  activate<model::PistonFriction, Plant>(test.parameters,
                                         {option_named<model::PistonFriction>("elastoplastic"), 5e3, 1.2, 0.01, 5e8});
  test.reference.seal = {5e3, 5e8, 1.2, 0.01};
  check_agreement(test);
}

TEST(AgreesWithCvode, OnPistonFrictionOfABristle) {
  Case test{"piston_friction lugre"};
  activate<model::PistonFriction, Plant>(test.parameters,
                                         {option_named<model::PistonFriction>("lugre"), 5e3, 1.2, 0.01, 5e8});
  test.reference.seal_bristle = {5e3, 5e8, 1.2, 0.01, 0.0, 1.0};
  check_agreement(test);
}

TEST(AgreesWithCvode, OnSoftStiffnessByCompliance) {
  Case test{"soft_stiffness compliance"};
  add_soft(test, 4e7, 8e3);
  check_agreement(test);
}

TEST(AgreesWithCvode, OnSoftStiffnessByStiffness) {
  Case test{"soft_stiffness stiffness"};
  activate<model::SoftStiffness, Plant>(test.parameters, {option_named<model::SoftStiffness>("stiffness"), 4e7, 8e3, {}});
  test.reference.soft = ReferenceAxis::Soft::stiffness;
  test.reference.low_stiffness = 4e7;
  test.reference.load_scale = 8e3;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnSoftStiffnessThatSaturates) {
  Case test{"soft_stiffness saturation"};
  activate<model::SoftStiffness, Plant>(test.parameters, {option_named<model::SoftStiffness>("saturation"), 4e7, 8e3, {}});
  test.reference.soft = ReferenceAxis::Soft::saturation;
  test.reference.low_stiffness = 4e7;
  test.reference.load_scale = 8e3;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnSoftStiffnessByTable) {
  Case test{"soft_stiffness table"};
  activate<model::SoftStiffness, Plant>(test.parameters,
                                        typical<model::SoftStiffness, double>(option_named<model::SoftStiffness>("table")));
  test.reference.soft = ReferenceAxis::Soft::table;
  test.reference.stiffness_table = {{0.0, 4e7}, {4e3, 6e7}, {1.2e4, 1e8}, {3e4, 1.2e8}};
  check_agreement(test);
}

TEST(AgreesWithCvode, OnBacklash) {
  Case test{"backlash"};
  activate<model::Backlash, Plant>(test.parameters, {0, 1e-4});
  test.reference.backlash = 1e-4;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnAVariableMomentArm) {
  Case test{"variable_moment_arm"};
  activate<model::VariableMomentArm, Plant>(test.parameters, {0, 1.0, -0.5});
  test.reference.arm_linear = 1.0;
  test.reference.arm_quadratic = -0.5;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnAStructuralMode) {
  Case test{"structural_mode"};
  activate<model::StructuralMode, Plant>(test.parameters, {0, 6.0, 0.02, 3e-3});
  test.reference.mode_frequency = 6.0;
  test.reference.mode_damping = 0.02;
  test.reference.mode_shape = 3e-3;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnDuctHardening) {
  Case test{"duct_hardening"};
  activate<model::DuctHardening, Plant>(test.parameters, {0, 1e8});
  test.reference.duct_cubic = 1e8;
  check_agreement(test);
}

// The reference waits for the constant torque to settle, 20 s against the slowest mode of the loop, 1/17 s and the washout's
// 1/6.3 s; the model starts from its steady state.
TEST(AgreesWithCvode, OnATorqueOffset) {
  Case test{"torque_offset"};
  activate<model::TorqueOffset, Plant>(test.parameters, {0, 2e4});
  test.reference.torque_offset = 2e4;
  test.settling = 20.0;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnAValveDeadband) {
  Case test{"valve_deadband"};
  add_deadband(test, 0.02);
  check_agreement(test);
}

TEST(AgreesWithCvode, OnAValveAsymmetry) {
  Case test{"valve_asymmetry"};
  activate<model::ValveAsymmetry, Plant>(test.parameters, {0, 0.2});
  test.reference.asymmetry = 0.2;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnValveHysteresis) {
  Case test{"valve_hysteresis"};
  activate<model::ValveHysteresis, Plant>(test.parameters, {0, 0.01});
  test.reference.play = 0.01;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnLaminarLeakage) {
  Case test{"leakage laminar"};
  activate<model::Leakage, Plant>(test.parameters, {option_named<model::Leakage>("laminar"), 5e-11});
  test.reference.laminar_leak = 5e-11;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnLeakageThroughAnOrifice) {
  Case test{"leakage orifice"};
  activate<model::Leakage, Plant>(test.parameters, {option_named<model::Leakage>("orifice"), 5e-11});
  test.reference.orifice_leak = 5e-11;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnACommandDelay) {
  Case test{"command_delay"};
  activate<model::CommandDelay, Plant>(test.parameters, {0, 5.3e-3});
  test.reference.delay = 5.3e-3;
  check_agreement(test);
}

/// A table that is a straight line through zero with this slope.
template <class Params>
Params line(int option, double slope) {
  Params params;
  params.option = option;
  params.table.points = 2;
  params.table.x = {0.0, 100.0};
  params.table.y = {0.0, 100.0 * slope};
  return params;
}

TEST(AgreesWithCvode, OnADeadTimeThatGrowsWithTheCommand) {
  using Command = model::UnlistedSignal<model::Site::command>;
  Case test{"unlisted_command delay"};
  activate<Command, Plant>(test.parameters,
                           line<Command::Params<double>>(option_named<Command>("delay_along_distance"), 0.2));
  test.reference.unlisted.dead_time = 0.2;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnAValveGainThatDrifts) {
  using Opening = model::UnlistedOpening;
  Case test{"unlisted_valve gain"};
  activate<Opening, Plant>(test.parameters, line<Opening::Params<double>>(option_named<Opening>("gain_along_time"), 0.1));
  test.reference.unlisted.gain_drift = 0.1;
  check_agreement(test);
}

TEST(AgreesWithCvode, OnARateLimit) {
  Case test{"rate_limit"};
  activate<model::RateLimit, Plant>(test.parameters, {0, 0.1});
  test.reference.rate_limit = 0.1;
  check_agreement(test);
}

}  // namespace hotfire::test
