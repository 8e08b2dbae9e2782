// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/reference_axis.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

namespace hotfire::study {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSample = 2e-3;
// Tight enough that a thousandth of what is looked for is seen.
constexpr double kTolerance = 1e-9;

std::vector<double> held(double angle, double seconds) {
  return std::vector<double>(static_cast<std::size_t>(std::lround(seconds / kSample)), angle);
}

std::vector<double> sine(double amplitude, double frequency, double seconds) {
  std::vector<double> commands = held(0.0, seconds);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i] = amplitude * std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(i) * kSample);
  }
  return commands;
}

ReferenceRows rows_of(const ReferenceAxis& axis, const std::vector<double>& commands) {
  return integrate_reference(axis, commands, kSample, 0.0, kTolerance);
}

double largest_difference(const ReferenceRows& a, const ReferenceRows& b, std::size_t channel) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i][channel] - b[i][channel]));
  }
  return largest;
}

/// Of the piston [m/s], under a command so large that the valve is wide open.
double speed_of_open_valve(const ReferenceAxis& axis) {
  const ReferenceRows rows = rows_of(axis, held(6.0 * kDegree, 0.3));
  return (rows[149][0] - rows[100][0]) / (49 * kSample);
}

}  // namespace

TEST_GROUP(ReferenceAxisLaws){};

// At rest F = K_n beta / R stretches the load spring and what creeps beside it: x - R beta = F (1/K_T + 1/k).
TEST(ReferenceAxisLaws, ACreptSpringIsSofterByTheStiffnessThatCreeps) {
  ReferenceAxis axis;
  axis.unlisted.creep_stiffness = 6e7;
  axis.unlisted.creep_time = 0.5;
  const auto last = rows_of(axis, held(2.0 * kDegree, 12.0)).back();
  const double force = axis.duct_stiffness * last[1] / axis.arm;
  const double compliance = 1.0 / axis.actuator_stiffness + 1.0 / axis.load_stiffness + 1.0 / axis.unlisted.creep_stiffness;
  DOUBLES_EQUAL(1.0, (last[0] - axis.arm * last[1]) / (force * compliance), 1e-3);
}

// The loop is slow against the spool and fast against the drift: the piston follows the null at rate / K_e, late by A / (Q_r
// K_e).
TEST(ReferenceAxisLaws, ADriftingNullMovesThePistonByItsRateOverTheGain) {
  ReferenceAxis axis;
  axis.unlisted.null_drift = 1e-3;
  const ReferenceRows rows = rows_of(axis, held(0.0, 10.0));
  const double moved = rows.back()[0] - rows[rows.size() / 2][0];
  DOUBLES_EQUAL(1.0, moved / (5.0 * axis.unlisted.null_drift / axis.position_gain), 0.02);
}

// Along a ramp the engine slides: after ten seconds friction that has drifted is friction of the level it has grown to. Both
// the loop, 1/17 s late, and the pressure feedback, whose washout takes 1/6.3 s, are behind a load that grows by a tenth of
// the growth a second: 2 % of it.
TEST(ReferenceAxisLaws, AFrictionThatDriftsIsAtLastTheFrictionItHasGrownTo) {
  std::vector<double> ramp = held(0.0, 10.0);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = 0.5 * kDegree * static_cast<double>(i) * kSample;
  }
  ReferenceAxis drifting;
  drifting.bristle = {8e3, 1e7, 1.0, 1.0, 0.0, 1.0};
  drifting.unlisted.friction_drift = 0.1;
  ReferenceAxis grown = drifting;
  grown.unlisted.friction_drift = 0.0;
  ReferenceAxis small = grown;
  grown.bristle.level *= 2.0;
  const auto angle_at_last = [&](const ReferenceAxis& axis) { return rows_of(axis, ramp).back()[1]; };
  const double growth = angle_at_last(grown) - angle_at_last(small);
  DOUBLES_EQUAL(1.0, (angle_at_last(drifting) - angle_at_last(small)) / growth, 0.03);
}

TEST(ReferenceAxisLaws, ADeadTimeByAmplitudeIsThatDelayForAStep) {
  ReferenceAxis by_amplitude;
  by_amplitude.unlisted.dead_time = 0.3;
  ReferenceAxis delayed;
  const double angle = 1.0 * kDegree;
  delayed.delay = by_amplitude.unlisted.dead_time * angle;
  std::vector<double> commands = held(0.0, 0.2);
  const std::vector<double> step = held(angle, 0.5);
  commands.insert(commands.end(), step.begin(), step.end());
  const ReferenceRows a = rows_of(by_amplitude, commands);
  const ReferenceRows b = rows_of(delayed, commands);
  CHECK_TRUE(largest_difference(a, b, 0) < 1e-9);
  CHECK_TRUE(largest_difference(a, rows_of({}, commands), 0) > 1e-4);
}

// What a saturated torque motor is asked for beyond its limit reaches neither spool nor play. Five degrees are four times
// the limit, and the piston is a tenth of the way there at the end.
TEST(ReferenceAxisLaws, AJumpOfASaturatedTorqueMotorDoesNotMoveThePlay) {
  ReferenceAxis axis;
  axis.play = 0.02;
  const std::vector<double> steady = held(5.0 * kDegree, 0.05);
  std::vector<double> dithered = steady;
  for (std::size_t i = 1; i < dithered.size(); i += 2) {
    dithered[i] -= 0.1 * kDegree;
  }
  CHECK_TRUE(axis.position_gain * axis.arm * 0.1 * kDegree > 2.0 * axis.play);
  CHECK_TRUE(largest_difference(rows_of(axis, steady), rows_of(axis, dithered), 0) < 1e-9);
}

// The loop closes on the piston itself, so a worn track changes what is read and nothing else.
TEST(ReferenceAxisLaws, AWornTrackIsReadWhereThePistonIs) {
  ReferenceAxis worn;
  worn.piston_sensor.bumps = {{3e-3, 1e-3, 2e-4}};
  const std::vector<double> commands = sine(0.5 * kDegree, 0.5, 2.0);
  const ReferenceRows plain = rows_of({}, commands);
  const ReferenceRows read = rows_of(worn, commands);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const double distance = (plain[i][0] - 3e-3) / 1e-3;
    DOUBLES_EQUAL(2e-4 * std::exp(-distance * distance), read[i][0] - plain[i][0], 1e-9);
  }
  CHECK_TRUE(largest_difference(plain, read, 0) > 1.9e-4);
}

// A first-order lag of 10 ms shifts a slow sine by 10 ms, less (tau w)^3 / 3 w: a thousandth of it at 0.5 Hz.
TEST(ReferenceAxisLaws, ALaggingSensorReadsASlowMotionLate) {
  ReferenceAxis lagging;
  lagging.engine_sensor.lag = 10e-3;
  const std::vector<double> commands = sine(1.0 * kDegree, 0.5, 6.0);
  const ReferenceRows plain = rows_of({}, commands);
  const ReferenceRows late = rows_of(lagging, commands);
  const std::size_t shift = 5;  // samples
  double largest = 0.0;
  for (std::size_t i = 1000; i < plain.size(); ++i) {
    largest = std::max(largest, std::abs(late[i][1] - plain[i - shift][1]));
  }
  // The amplitude of the reading falls by (tau w)^2 / 2, 5e-4 of it.
  CHECK_TRUE(largest < 1e-3 * kDegree);
  CHECK_TRUE(largest_difference(plain, late, 1) > 2e-2 * kDegree);
}

// Valve wide open: v = Q_r (1 + c) / A, as long as the load pressure is small against the supply.
TEST(ReferenceAxisLaws, ACurvedFlowGainSetsTheSpeedOfTheOpenValve) {
  ReferenceAxis axis;
  const double plain = speed_of_open_valve(axis);
  DOUBLES_EQUAL(axis.rated_flow / axis.area, plain, 0.05 * plain);
  axis.unlisted.flow_curvature = -0.3;
  DOUBLES_EQUAL(0.7, speed_of_open_valve(axis) / plain, 0.03);
}

// The supply falls by droop Q, and the flow with its root: s = 1 - d s^(1/2) with d = droop Q_r / P_s.
TEST(ReferenceAxisLaws, ASaggingSupplySlowsTheOpenValve) {
  ReferenceAxis axis;
  const double plain = speed_of_open_valve(axis);
  const double drop = 0.5;
  axis.unlisted.supply_droop = drop * axis.supply / axis.rated_flow;
  axis.unlisted.supply_recovery = 5e-3;
  const double root = 0.5 * (-drop + std::sqrt(drop * drop + 4.0));
  DOUBLES_EQUAL(root, speed_of_open_valve(axis) / plain, 0.03);
}

// Within presliding a Dahl bristle is a spring, and two springs in series are one.
TEST(ReferenceAxisLaws, ASpringBehindAStuckBristleIsOneSofterBristle) {
  const double bristle = 1e8;
  const double spring = 2e7;
  ReferenceAxis sprung;
  sprung.bristle = {1e7, bristle, 1.0, 1.0, 0.0, 1.0};
  ReferenceAxis softer = sprung;
  ReferenceAxis rigid = sprung;
  sprung.gimbal_stiffness = spring;
  softer.bristle.stiffness = bristle * spring / (bristle + spring);
  const std::vector<double> commands = sine(0.1 * kDegree, 1.0, 2.0);
  const ReferenceRows rows = rows_of(sprung, commands);
  // The bristle's slip, z / z_slip = 0.1 deg 1.7e7 / 1e7, is 3e-3 of the motion and is not the same in both.
  CHECK_TRUE(largest_difference(rows, rows_of(softer, commands), 1) < 5e-3 * 0.1 * kDegree);
  CHECK_TRUE(largest_difference(rows, rows_of(rigid, commands), 1) > 5e-2 * 0.1 * kDegree);
}

// Behind the spring the sliding torque is the same: with a slow large motion only the reversals differ.
TEST(ReferenceAxisLaws, ASpringBehindTheBristleLeavesTheSlidingTorque) {
  ReferenceAxis sprung;
  sprung.bristle = {1e4, 1e8, 1.0, 1.0, 0.0, 1.0};
  ReferenceAxis rigid = sprung;
  sprung.gimbal_stiffness = 2e7;
  std::vector<double> ramp = held(0.0, 2.0);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    ramp[i] = 2.0 * kDegree * static_cast<double>(i) * kSample;
  }
  const double torque_per_angle = rigid.arm * rigid.arm / (1.0 / rigid.actuator_stiffness + 1.0 / rigid.load_stiffness);
  const double held_back = sprung.bristle.level / torque_per_angle;
  DOUBLES_EQUAL(rows_of(rigid, ramp).back()[1], rows_of(sprung, ramp).back()[1], 0.01 * held_back);
}

// R(beta) = dL/dbeta of the plane linkage: to first order R (1 + (cot(angle) - R / L) beta).
TEST(ReferenceAxisLaws, ALinkageIsAMomentArmThatVaries) {
  ReferenceAxis plane;
  plane.linkage = {1.5, 80.0 * kDegree};
  ReferenceAxis expanded;
  expanded.arm_linear = 1.0 / std::tan(plane.linkage.angle) - expanded.arm / plane.linkage.length;
  const std::vector<double> commands = sine(1.0 * kDegree, 0.5, 2.0);
  const ReferenceRows rows = rows_of(plane, commands);
  const double effect = largest_difference(rows, rows_of({}, commands), 1);
  // What is left is of second order in the angle, 0.017 rad, of the effect.
  CHECK_TRUE(largest_difference(rows, rows_of(expanded, commands), 1) < 0.05 * effect);
  // The stroke differs by R linear beta^2 / 2, and the engine gives way; the loop's lag of 1/17 s at 0.5 Hz takes 6 % of
  // beta^2.
  const double beta = 1.0 * kDegree;
  DOUBLES_EQUAL(1.0, effect / (0.5 * std::abs(expanded.arm_linear) * beta * beta), 0.15);
}

TEST(ReferenceAxisLaws, APeriodicTorqueTurnsTheEngineAtItsFrequency) {
  ReferenceAxis axis;
  axis.unlisted.periodic_torque = 3e3;
  axis.unlisted.periodic_frequency = 2.0;
  const ReferenceRows rows = rows_of(axis, held(0.0, 4.0));
  double in_phase = 0.0;
  double across = 0.0;
  double square = 0.0;
  for (std::size_t i = 1000; i < 2000; ++i) {  // four whole periods, after the start has died out
    const double phase = 2.0 * std::numbers::pi * 2.0 * static_cast<double>(i + 1) * kSample;
    in_phase += rows[i][1] * std::sin(phase) / 500.0;
    across += rows[i][1] * std::cos(phase) / 500.0;
    square += rows[i][1] * rows[i][1] / 500.0;
  }
  const double amplitude = in_phase * in_phase + across * across;
  DOUBLES_EQUAL(1.0, amplitude / square, 1e-2);
  // Far below the pendulum's 7.5 Hz the engine hangs on the load spring: at least torque / (K_T R^2 + K_n), against the
  // torque.
  const double stiffness =
      axis.arm * axis.arm / (1.0 / axis.actuator_stiffness + 1.0 / axis.load_stiffness) + axis.duct_stiffness;
  CHECK_TRUE(in_phase < -axis.unlisted.periodic_torque / stiffness);
}

}  // namespace hotfire::study
