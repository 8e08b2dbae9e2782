// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>

#include "model/declaration/sites.hpp"
#include "tools/explain/data/dataset.hpp"

namespace hotfire::explain {

/// True where a load cell refutes an effect at `site`: what acts on the engine is measured in all records and is an input,
/// so that there is nothing to be found at the engine beside it.
inline bool is_measured_load(const Dataset& data, std::string_view site) {
  return site == model::site_name(model::Site::engine_torque) &&
         std::ranges::none_of(data.experiments, [](const Experiment& e) { return e.torque.empty(); });
}

}  // namespace hotfire::explain
