// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/response/condition.hpp"
#include "tools/response/measured.hpp"

namespace hotfire::response {

/// Conditions that are compared, on one grid of frequencies [Hz].
struct Comparison {
  std::vector<Condition> conditions;
  std::vector<MeasuredAxis> measured;  ///< each of a condition and an axis that are there
  std::vector<double> frequencies;
};

/// Refuses what was measured of a condition or an axis that is not compared. Throws UsageError.
void require_known(const Comparison& comparison);

/// Load stiffness, equivalent actuator and total stiffness and load resonance of every axis, beside what was measured; with
/// `responses` the frequency responses too.
nlohmann::ordered_json to_json(const Comparison& comparison, bool responses);

/// The same figures for a reader, a line an axis.
std::string text_of(const Comparison& comparison);

/// A row a frequency: gain and phase of every port to its own force, of every condition, then those of the actuators.
std::string table_of(const Comparison& comparison);

/// Pictures by name of file: `structure.svg` (force to displacement at the ports), `actuators.svg` [SD fig. 2 a, b],
/// `modal_integral.svg`, `resonances.svg` [SD fig. 6] and `locations.svg` [SD fig. 11]. What needs engines is left out for
/// mode tables alone.
std::map<std::string, analysis::Chart> pictures_of(const Comparison& comparison);

}  // namespace hotfire::response
