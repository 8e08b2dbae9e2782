// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/data/plants.hpp"
#include "tools/explain/result/result.hpp"

namespace hotfire::explain {

/// Where an effect was exercised, so that its curve is drawn over what the data saw.
struct Reach {
  double input = 0.0;     ///< largest command [rad] or force
  double position = 0.0;  ///< largest piston position [m] or position of the mass
  double position_rate = 0.0;
  double angle = 0.0;
  double angle_rate = 0.0;
  double deflection = 0.0;  ///< largest |piston - R angle|, or twist of a transmission
  double drive = 0.0;       ///< largest command of a motor
  double pressure = 0.0;
  double other_angle = 0.0;  ///< largest angle of the engine about its other axis [rad]
  double other_rate = 0.0;
};

Reach reach_of(const Dataset& data, const ModelParameters& parameters);

/// The curve of an active effect as the page draws it (docs/report.md): force or torque against rate or position, output
/// against input, force against deflection, or a response in time where the effect remembers. Evaluated by the effect
/// itself.
Curve curve_of(const ModelParameters& parameters, std::size_t effect, const Reach& reach);

}  // namespace hotfire::explain
