// SPDX-License-Identifier: Apache-2.0
#include "firmware/lab/lab.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/firmware/lab/lab_settings.hpp"

namespace hotfire::firmware {

using test_lab::kPeriod;
using test_lab::kPeriodNs;
using test_lab::segment;
using test_lab::settings;

TEST_GROUP(Lab) {
  Lab lab{settings(), kPeriod};
  LabInputs inputs;

  const LabOutputs& step() {
    inputs.readings[0] = {lab.outputs().interlock.drive ? 0.5 * lab.outputs().commands[0] : inputs.readings[0][0], 0.0};
    inputs.readings[0][1] = inputs.readings[0][0];
    return lab.step(inputs);
  }

  void press() {
    inputs.arm = inputs.start = false;
    step();
    inputs.arm = inputs.start = true;
    step();
    inputs.arm = inputs.start = false;
    step();
  }

  RigState state() const { return lab.outputs().interlock.state; }
};

TEST(Lab, ArmedItHoldsThePistonWhereItStoodAndThenBringsItSlowlyToTheProfile) {
  inputs.readings[0] = {0.005, 0.005};
  press();
  CHECK(state() == RigState::armed);
  DOUBLES_EQUAL(0.01, lab.outputs().commands[0], 1e-12);
  DOUBLES_EQUAL(0.001, lab.outputs().currents[0], 1e-12);
  press();
  double before = lab.outputs().commands[0];
  for (int i = 0; i < 100; ++i) {
    const double now = step().commands[0];
    CHECK(now - before <= 1.0 * kPeriod + 1e-12);
    before = now;
  }
  DOUBLES_EQUAL(0.02, before, 1e-12);
}

TEST(Lab, AtTheEndOfTheProfileItComesToRestAndIsSafe) {
  press();
  press();
  for (int i = 0; i < 1200 && state() != RigState::safe; ++i) {
    step();
  }
  CHECK(state() == RigState::safe);
  CHECK(lab.completed());
}

TEST(Lab, PistonThatStillMovesWhenTheStoppingTimeIsOverIsSaid) {
  for (const bool moves : {false, true}) {
    press();
    press();
    inputs.stop = true;
    for (int i = 0; i < 300 && state() != RigState::safe; ++i) {
      const double position = moves && i % 2 == 0 ? 0.001 : 0.0;
      inputs.readings[0] = {position, position};
      lab.step(inputs);
    }
    CHECK(state() == RigState::safe);
    CHECK(lab.came_to_rest() != moves);
    inputs.stop = false;
    step();
  }
}

TEST(Lab, EveryFaultEndsDrivingInItsCycleAndNothingMovesUntilArmedAgain) {
  const std::vector<std::pair<Fault, void (*)(LabInputs&)>> provoked{
      {Fault::stale_command, [](LabInputs& in) { in.rig.command_age_ns = 6 * kPeriodNs; }},
      {Fault::stale_sensor, [](LabInputs& in) { in.ages_ns[0][1] = 6 * kPeriodNs; }},
      {Fault::out_of_range,
       [](LabInputs& in) {
         in.readings[0] = {0.2, 0.2};
       }},
      {Fault::readings_disagree, [](LabInputs& in) { in.readings[0][1] += 0.002; }},
      {Fault::bad_frame, [](LabInputs& in) { in.rig.bad_frame = true; }},
      {Fault::second_sender, [](LabInputs& in) { in.rig.second_sender = true; }},
      {Fault::command_not_answered, [](LabInputs& in) { in.rig.command_not_answered = true; }},
      {Fault::not_authentic, [](LabInputs& in) { in.rig.not_authentic = true; }},
      {Fault::bus_off, [](LabInputs& in) { in.rig.bus_off = true; }},
      {Fault::bus_down, [](LabInputs& in) { in.rig.bus_down = true; }},
      {Fault::transmit_queue_full, [](LabInputs& in) { in.rig.transmit_queue_full = true; }},
      {Fault::emergency_stop, [](LabInputs& in) { in.rig.emergency_stop = true; }},
      {Fault::hydraulic_enable_lost, [](LabInputs& in) { in.rig.hydraulic_enable = false; }},
      {Fault::overrun, [](LabInputs& in) { in.rig.overrun = true; }},
      {Fault::limit,
       [](LabInputs& in) {
         in.readings[0] = {0.07, 0.07};
       }},
      {Fault::not_finite,
       [](LabInputs& in) {
         in.readings[0] = {NAN, NAN};
       }},
      {Fault::load_pressure, [](LabInputs& in) { in.load_pressures[0] = -2.00001e7; }},
      {Fault::recorder_full, [](LabInputs& in) { in.rig.dropped_recording = true; }}};
  LabSettings limited = settings();
  limited.limits.actuators[0].load_pressure = 2e7;
  for (const auto& [fault, provoke] : provoked) {
    Lab one(limited, kPeriod);
    LabInputs good;
    const auto press_button = [&] {
      one.step(good);
      good.arm = good.start = true;
      one.step(good);
      good.arm = good.start = false;
      one.step(good);
    };
    press_button();
    press_button();
    CHECK(one.outputs().interlock.state == RigState::running);
    LabInputs bad = good;
    provoke(bad);
    CHECK(!one.step(bad).interlock.drive);
    CHECK(one.outputs().interlock.faults.has(fault));
    for (int i = 0; i < 50; ++i) {
      CHECK(!one.step(good).interlock.drive);
    }
    press_button();
    CHECK(one.outputs().interlock.state == RigState::armed);
  }
}

TEST(Lab, JammedActuatorIsAPositionErrorOnceItLastsTooLong) {
  press();
  press();
  for (int i = 0; i < 100 && state() == RigState::running; ++i) {
    lab.step(inputs);
  }
  CHECK(state() == RigState::faulted);
  CHECK(lab.outputs().interlock.first == Fault::position_error);
  UNSIGNED_LONGS_EQUAL(1, lab.times_first(Fault::position_error));
}

TEST(Lab, EveryActuatorIsGivenItsOwnCommand) {
  LabSettings two = settings();
  two.actuators = 2;
  two.profile = Profile({{1.0, {0.02, -0.01}, {0.02, -0.01}, {0.0, 0.005}, 0.25, 0.25}});
  Lab one(two, kPeriod);
  LabInputs pressed;
  pressed.arm = pressed.start = true;
  const auto follow = [&](LabInputs in) {
    for (std::size_t i = 0; i < 2 && one.outputs().interlock.drive; ++i) {
      in.readings[i] = {0.5 * one.outputs().commands[i], 0.5 * one.outputs().commands[i]};
    }
    one.step(in);
  };
  for (int press = 0; press < 2; ++press) {
    follow({});
    follow({});
    follow(pressed);
  }
  follow({});
  // 20 cycles to where the profile begins, then all of it: its sine ends at its peak.
  for (int i = 0; i < 1019; ++i) {
    follow({});
  }
  CHECK(one.outputs().interlock.state == RigState::running);
  DOUBLES_EQUAL(0.02, one.outputs().commands[0], 1e-12);
  DOUBLES_EQUAL(-0.005, one.outputs().commands[1], 1e-6);
  DOUBLES_EQUAL(0.1 * one.outputs().commands[1], one.outputs().currents[1], 1e-15);
}

TEST(Lab, CommandThatIsNotFiniteIsThatFaultAndIsHandedToNobody) {
  LabSettings broken = settings();
  broken.profile = Profile({segment(1.0, 0.0, NAN)});
  Lab one(broken, kPeriod);
  LabInputs pressed;
  pressed.arm = pressed.start = true;
  for (int i = 0; i < 100; ++i) {
    one.step(i % 2 == 0 ? LabInputs{} : pressed);
    CHECK(std::isfinite(one.outputs().commands[0]));
  }
  CHECK(one.times_first(Fault::not_finite) > 0);
  UNSIGNED_LONGS_EQUAL(one.armings() - (one.outputs().interlock.drive ? 1 : 0), one.times_first(Fault::not_finite));
}

TEST(Lab, OverrunsThatAreAllowedInARowAreNoFault) {
  LabSettings tolerant = settings();
  tolerant.most_overruns = 2;
  Lab one(tolerant, kPeriod);
  inputs.arm = true;
  one.step({});
  one.step(inputs);
  inputs.arm = false;
  inputs.rig.overrun = true;
  CHECK(one.step(inputs).interlock.drive);
  CHECK(one.step(inputs).interlock.drive);
  CHECK(!one.step(inputs).interlock.drive);
}

TEST_GROUP(Profile){};

TEST(Profile, SegmentsFollowEachOtherAndTheEndIsHeld) {
  const Profile profile({segment(1.0, 0.0, 2.0), segment(2.0, 5.0, 5.0, 1.0, 0.25, 0.25)});
  DOUBLES_EQUAL(3.0, profile.duration(), 0.0);
  DOUBLES_EQUAL(1.0, profile.at(0.5)[0], 1e-12);
  DOUBLES_EQUAL(5.0, profile.at(1.0)[0], 1e-12);
  DOUBLES_EQUAL(6.0, profile.at(2.0)[0], 1e-12);
  DOUBLES_EQUAL(5.0, profile.at(10.0)[0], 1e-12);
}

TEST(Profile, SweepHasTheFrequenciesOfItsEnds) {
  const Profile profile({segment(10.0, 0.0, 0.0, 1.0, 1.0, 4.0)});
  const auto slope = [&](double time) { return (profile.at(time + 1e-7)[0] - profile.at(time)[0]) / 1e-7; };
  DOUBLES_EQUAL(2.0 * std::numbers::pi, slope(0.0), 1e-3);
  // Phase of a sweep of equal factors: f0 T / ln(f1 / f0) (e^{t ln(f1 / f0) / T} - 1) periods.
  const double periods = 10.0 / std::log(4.0) * (2.0 - 1.0);
  DOUBLES_EQUAL(std::sin(2.0 * std::numbers::pi * periods), profile.at(5.0)[0], 1e-9);
}

}  // namespace hotfire::firmware
