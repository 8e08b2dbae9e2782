// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace hotfire::test {

/// A parameter of an effect; without an interval where the data do not determine it.
nlohmann::json parameter(double value, const char* unit, double half_width, const char* meaning, bool identified = true);

/// Gimbal friction with a curve that doubles back, an undetermined parameter and alternatives.
nlohmann::json friction();

/// The points that belong under the curve of friction().
nlohmann::json reconstructed_points();

/// A second effect, with a plain curve.
nlohmann::json soft_stiffness();

}  // namespace hotfire::test
