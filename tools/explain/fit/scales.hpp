// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tools/explain/data/dataset.hpp"

namespace hotfire::explain {

/// Sizes of the quantities in a record, by which a field whose unit follows the record's own is scaled.
struct Scales {
  double force = 1.0;
  double position = 1.0;
  double time = 1.0;
};

/// rms force, rms position about its mean, and rms position over rms velocity, of all experiments together. For `direct`.
Scales scales_of(const Dataset& data);

/// The size of a unit pattern such as "force.time/position^2"; 1 for any unit that is not made of these three words.
double size_of_unit(std::string_view unit, const Scales& scales);

}  // namespace hotfire::explain
