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
  double deflection = 0.0;  ///< largest |piston - R angle|
  double pressure = 0.0;
  double other_angle = 0.0;  ///< largest angle of the engine about its other axis [rad]
  double other_rate = 0.0;
};

Reach reach_of(const Dataset& data, const SimplexParameters& parameters);
Reach reach_of(const Dataset& data, const DirectParameters& parameters);

/// The curve of an active effect as the page draws it (docs/report.md): force or torque against rate or position, output
/// against input, force against deflection, or a response in time where the effect remembers. Evaluated by the effect
/// itself.
template <class Family>
Curve curve_of(const PlainParameters<Family>& parameters, std::size_t effect, const Reach& reach);

extern template Curve curve_of<SimplexFamily>(const SimplexParameters&, std::size_t, const Reach&);
extern template Curve curve_of<DirectFamily>(const DirectParameters&, std::size_t, const Reach&);

}  // namespace hotfire::explain
