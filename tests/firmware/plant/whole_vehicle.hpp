// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/files/scratch.hpp"
#include "tests/support/attach_points.hpp"
#include "tools/structure/mode_table.hpp"
#include "tools/structure/reduction.hpp"
#include "tools/structure/synthetic.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::test {

/// A vehicle of four engines with everything that a file can say of one: what differs from axis to axis, effects of all and
/// of some, inclined attach points, thrust, a compliant and vibrating bearing with friction, modes with residual
/// flexibility, sensors that lag and read in steps. Decimals that no binary number hits; no noise.
inline const std::string kWholeVehicle = std::string(R"(schema = 1
name = "whole vehicle"
topology = "masv"
[servovalve]
rated_flow = "50 gallon/minute"
[structure]
stiffness = 1.05e8
[structure.pitch2]
stiffness = 1.1e8
[engine.yaw]
inertia = 9490.1
[effects.soft_stiffness]
law = "compliance"
low_stiffness = 5.2e7
load_scale = 6e3
[effects.soft_stiffness.yaw3]
load_scale = 7.3e3
[effects.valve_deadband]
half_width = 0.0051
[effects.cross_axis.pitch]
stiffness = 3.1e4
[effects.sensor_lag.yaw1]
channel = "engine"
time_constant = 0.0031
)") + kInclinedAttachPoints + R"([gimbal]
thrust = "418000 lbf"
block_mass = 51.3
block_inertia = 0.9
vehicle_side_flexibility = 0.43
stiffness = [
  [2e9, 0, 0, 0, 0, 0],
  [0, 2e9, 0, 0, 0, 9e6],
  [0, 0, 2e9, 0, -9e6, 0],
  [0, 0, 0, 1.7e7, 0, 0],
  [0, 0, -9e6, 0, 1.7e7, 0],
  [0, 9e6, 0, 0, 0, 1.7e7],
]
[gimbal.friction]
law = "lugre"
coulomb_torque = 2e4
stiffness = 1e8
static_ratio = 1.2
stribeck_velocity = 0.02
damping = 3e3
[gimbal.vibration]
pitch_velocity = 0.011
yaw_velocity = 0.007
frequency = 37.1
[modes]
table = "modes.csv"
[sensors.piston]
lag = "2.1 ms"
step = "5.3 um"
[strings]
lag = "1.9 ms"
step = "10 um"
placement_error = "2 cm"
[strings.string2.engine3]
engine_z = 0.8
)";

/// Writes it with its mode table and reads it.
inline VehicleFile whole_vehicle(const Scratch& scratch) {
  scratch.write("modes.csv", mode_table_text(reduce(synthetic_vehicle(3, 60), {.most = 20}).modes, {}));
  return load_vehicle(scratch.write("vehicle.toml", kWholeVehicle));
}

}  // namespace hotfire::test
