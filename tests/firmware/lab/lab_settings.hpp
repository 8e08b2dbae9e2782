// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/can/layout.hpp"
#include "firmware/lab/lab.hpp"

namespace hotfire::firmware::test_lab {

constexpr double kPeriod = 1e-3;
constexpr std::int64_t kPeriodNs = 1'000'000;

inline Segment segment(double duration, double from, double to, double amplitude = 0.0, double frequency = 1.0,
                       double last_frequency = 1.0) {
  return {duration, {from}, {to}, {amplitude}, frequency, last_frequency};
}

/// A lab of one actuator that steps to 0.02 rad for a second.
inline LabSettings settings() {
  LabSettings made;
  made.profile = Profile({segment(1.0, 0.02, 0.02)});
  made.piston_per_command = 0.5;
  made.current_per_command = 0.1;
  made.current_limit = 0.02;
  made.approach_rate = 1.0;
  made.rest_speed = 0.01;
  // The arm button starts too, and a press is one as soon as it is let go.
  made.interlock = {true, 0, 1, 1'000'000, 0, 1'000'000, 100};
  made.limits = {5 * kPeriodNs, -0.15, 0.15, 0.001, 10.0, 0.004, 10};
  made.limits.actuators.fill({5 * kPeriodNs, -0.06, 0.06, 100.0});
  return made;
}

/// A lab of as many actuators as a layout has room for, with limits of their load pressures.
inline LabSettings full_settings(can::Layout layout) {
  LabSettings made = settings();
  made.actuators = can::most_actuators(layout);
  made.limits.position_error = 1.0;
  for (ActuatorLimits& limits : made.limits.actuators) {
    limits.load_pressure = 2e7;
  }
  return made;
}

}  // namespace hotfire::firmware::test_lab
