#include <CppUTest/TestHarness.h>

#include <cstdio>
#include <numbers>

#include "tests/model/reference_taos.hpp"
#include "tests/model/vehicles.hpp"

namespace hotfire::test {
namespace {

using Rows = std::vector<std::array<double, 4>>;

constexpr double kSample = 1e-3;
constexpr int kSamples = 1200;
// The figure asked for: half a percent of the signal's rms, in piston and engine of both axes.
constexpr double kLimit = 5e-3;

/// Sines from 1 to 9 Hz about both angles, a step up in pitch and one down in yaw, 0.3 deg each.
std::vector<std::array<double, 2>> command_profile() {
  constexpr double degree = std::numbers::pi / 180.0;
  const auto sine = [](double frequency, double t) { return std::sin(2.0 * std::numbers::pi * frequency * t); };
  std::vector<std::array<double, 2>> commands;
  for (int i = 0; i < kSamples; ++i) {
    const double t = i * kSample;
    commands.push_back({degree * (0.5 * sine(1.0, t) + 0.25 * sine(4.0, t) + 0.15 * sine(9.0, t) + (t >= 0.5 ? 0.3 : 0.0)),
                        degree * (0.4 * sine(1.3, t) + 0.2 * sine(6.0, t) - (t >= 0.8 ? 0.3 : 0.0))});
  }
  return commands;
}

/// Three modes around the loaded resonance and one above, that turn the gimbal as well.
Taos::Modes four_modes() {
  Taos::Modes modes;
  modes.modes = 4;
  modes.frequency = {4.2, 8.1, 11.7, 26.0};
  modes.damping_ratio = {0.01, 0.015, 0.01, 0.02};
  modes.shape.col(0) << 1.0e-3, -4.0e-4, 2.0e-4, 1.0e-4;
  modes.shape.col(1) << 1.5e-3, 9.0e-4, -3.0e-4, 2.0e-4;
  modes.shape.col(2) << -8.0e-4, 1.6e-3, 1.0e-4, 4.0e-4;
  modes.shape.col(3) << 2.0e-3, 1.2e-3, 5.0e-4, -6.0e-4;
  return modes;
}

/// The same engine, told to the reference.
ReferenceTaos reference_of(const Taos::Parameters& parameters, const Taos& plant) {
  ReferenceTaos taos;
  for (int i = 0; i < 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto& axis = parameters.axes[k];
    ReferenceAxis& reference = taos.axes[k];
    reference.arm = plant.axis(i).parameters().actuator.moment_arm;
    reference.load_stiffness = axis.structure.stiffness;
    reference.damping = axis.engine.viscous_damping;
    reference.duct_stiffness = axis.engine.duct_stiffness;
    if (axis.effects.active[index_in<model::SoftStiffness>(Taos::Effects{})]) {
      const auto& soft = std::get<index_in<model::SoftStiffness>(Taos::Effects{})>(axis.effects.values);
      reference.soft = ReferenceAxis::Soft::compliance;
      reference.low_stiffness = soft.low_stiffness;
      reference.load_scale = soft.load_scale;
    }
    if (axis.effects.active[index_in<model::ValveDeadband>(Taos::Effects{})]) {
      reference.deadband = std::get<index_in<model::ValveDeadband>(Taos::Effects{})>(axis.effects.values).half_width;
    }
    taos.on_engine[k] = parameters.attach[k].engine();
    taos.on_vehicle[k] = parameters.attach[k].vehicle();
  }
  const auto& gimbal = parameters.gimbals[0];
  taos.thrust = gimbal.bearing.thrust;
  taos.loss_time = gimbal.bearing.loss_time;
  if (gimbal.compliant) {
    taos.bearing_compliance = gimbal.stiffness.inverse();
  }
  const auto& law = gimbal.friction;
  if (law.coulomb_torque > 0.0) {
    const bool vibrated = law.option == model::BearingFriction<double>::kVibrated;
    const double least = vibrated ? law.coulomb_torque * law.vibration_ratio : law.coulomb_torque;
    taos.friction = {law.coulomb_torque,    law.stiffness, law.static_ratio,
                     law.stribeck_velocity, law.damping,   2.0 * std::sqrt(2.0 * std::numbers::e) * least / law.damping};
    taos.vibration_ratio = vibrated ? law.vibration_ratio : 1.0;
    taos.vibration_velocity = law.vibration_velocity;
  }
  for (int k = 0; k < parameters.modes.modes; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const auto shape = parameters.modes.shape.col(k);
    taos.modes.push_back({parameters.modes.frequency[mode],
                          parameters.modes.damping_ratio[mode],
                          {shape(0), shape(1)},
                          {shape(2), shape(3)}});
  }
  return taos;
}

ReferenceTaos::Start start_of(const Taos::State& state, int modes) {
  ReferenceTaos::Start start;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::copy(state.axes[axis].y.begin(), state.axes[axis].y.end(), start.axes[axis].begin());
  }
  std::copy(state.gimbals[0].displacement.begin(), state.gimbals[0].displacement.end(), start.bearing.begin());
  for (int k = 0; k < modes; ++k) {
    start.modes.push_back(state.structure.modes[static_cast<std::size_t>(k)].displacement);
  }
  return start;
}

Rows run_model(const Taos::Parameters& parameters, int parts) {
  const Taos plant(parameters, kSample / parts);
  Taos::State state = plant.steady({});
  Rows rows;
  for (const auto& commands : command_profile()) {
    for (int part = 0; part < parts; ++part) {
      plant.step(state, {commands, {}});
    }
    const auto& measured = Taos::measured(state);
    rows.push_back({measured[0], measured[1], measured[3], measured[4]});
  }
  return rows;
}

Rows run_reference(const Taos::Parameters& parameters) {
  const Taos plant(parameters, kSample);
  return integrate_reference(reference_of(parameters, plant), start_of(plant.steady({}), parameters.modes.modes),
                             command_profile(), kSample);
}

/// Checks the error at the two steps a sample that the tools take, and prints it beside that of one step a sample.
void check_agreement(const char* name, const Taos::Parameters& parameters) {
  const Rows reference = run_reference(parameters);
  constexpr std::array<const char*, 4> kNames{"pitch piston", "pitch engine", "yaw piston", "yaw engine"};
  const Rows fine = run_model(parameters, 2);
  const Rows coarse = run_model(parameters, 1);
  std::printf("\n%-34s", name);
  for (std::size_t channel = 0; channel < kNames.size(); ++channel) {
    const double error = relative_rms(fine, reference, channel);
    std::printf("  %s %.4f %% (1 ms: %.4f %%)", kNames[channel], 100.0 * error,
                100.0 * relative_rms(coarse, reference, channel));
    CHECK_TRUE_TEXT(error < kLimit, kNames[channel]);
  }
}

/// Order of convergence towards the reference, mean over three halvings of a step of half a millisecond.
double observed_order(const Taos::Parameters& parameters, std::size_t channel) {
  const Rows reference = run_reference(parameters);
  return std::log2(relative_rms(run_model(parameters, 2), reference, channel) /
                   relative_rms(run_model(parameters, 16), reference, channel)) /
         3.0;
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

TEST_GROUP(TaosAgreesWithCvode){};

TEST(TaosAgreesWithCvode, WithTheDeclaredPartsAlone) { check_agreement("declared", Taos::Parameters{}); }

TEST(TaosAgreesWithCvode, AtHotFireWithEveryEffect) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  check_agreement("hot fire, four modes", parameters);
}

TEST(TaosAgreesWithCvode, WithFrictionThatVibrationLowers) {
  Taos::Parameters parameters = hot_fire<Taos>();
  auto& friction = parameters.gimbals[0].friction;
  friction.option = model::BearingFriction<double>::kVibrated;
  friction.vibration_ratio = 0.4;
  friction.vibration_velocity = 0.02;
  check_agreement("hot fire, vibrated_lugre", parameters);
}

// The structure alone carries the actuators, and gives way by more than they do.
TEST(TaosAgreesWithCvode, OnAStructureSofterThanTheActuators) {
  Taos::Parameters parameters = smooth();
  parameters.modes.shape.topRows<2>() *= 4.0;
  check_agreement("soft structure", parameters);
}

// Stiff ducts and strong damping on a mount that turns: what they hand to the vehicle, and take from its rotation, is then a
// good part of the engine's torque.
TEST(TaosAgreesWithCvode, OnAMountThatTurnsUnderStiffDucts) {
  Taos::Parameters parameters = smooth();
  parameters.modes.shape.bottomRows<2>() *= 100.0;
  for (auto& axis : parameters.axes) {
    axis.engine.duct_stiffness = 4e6;
    axis.engine.viscous_damping = 1e5;
  }
  check_agreement("turning mount", parameters);
}

TEST(TaosAgreesWithCvode, WithTheSecondOrderWhereItIsSmooth) {
  const Taos::Parameters parameters = smooth();
  for (const std::size_t channel : {0U, 1U, 2U, 3U}) {
    const double order = observed_order(parameters, channel);
    std::printf("\norder without friction: %.2f", order);
    CHECK_TRUE(order > 1.8);
  }
}

TEST(TaosAgreesWithCvode, WithAtLeastTheFirstOrderUnderFriction) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  for (const std::size_t channel : {0U, 1U, 2U, 3U}) {
    const double order = observed_order(parameters, channel);
    std::printf("\norder with friction: %.2f", order);
    CHECK_TRUE(order > 1.0);
  }
}

}  // namespace hotfire::test
