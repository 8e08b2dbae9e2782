// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hotfire::test {

/// Inclined attach points of both axes, as tables of a vehicle file: a torque about one axis moves the other.
inline constexpr char kInclinedAttachPoints[] = R"([attach.pitch]
engine_x = -0.35
engine_y = 0.05
engine_z = -0.70
vehicle_x = 0.85
vehicle_y = 0.0
vehicle_z = -0.95
[attach.yaw]
engine_x = -0.35
engine_y = 0.70
engine_z = 0.05
vehicle_x = 0.85
vehicle_y = 0.95
vehicle_z = 0.0
)";

}  // namespace hotfire::test
