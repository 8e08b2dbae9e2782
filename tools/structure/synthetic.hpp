// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/structure/mode_table.hpp"

namespace hotfire {

/// A synthetic vehicle of four engines: not a model of any real one. `count` modes between 1 and 40 Hz, damping ratios of
/// 0.5 to 1.5 %, mass-normalised shapes. A third of the modes are those of the thrust structure and the engines, and carry
/// nearly all of the flexibility of the attach points, none of them dominant; the others represent tanks, lines and panels
/// that an actuator hardly feels. Every attach point is scaled to a static flexibility between 0.9 and 1.1 of 1 / 1.05e8
/// N/m. The same seed gives the same vehicle on any machine.
ModeSet synthetic_vehicle(unsigned seed, int count);

}  // namespace hotfire
