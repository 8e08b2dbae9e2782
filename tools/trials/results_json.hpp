// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/analysis/step_response.hpp"
#include "tools/trials/stiffness.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

/// Results as `--json` prints them; what did not happen is null.
nlohmann::ordered_json to_json(const std::vector<ChannelSweep>& sweeps);
nlohmann::ordered_json to_json(const std::vector<analysis::StepResponse>& steps, double period);
nlohmann::ordered_json to_json(const std::vector<SineStiffness>& stiffnesses, const LoadSpring& spring);

}  // namespace hotfire::trials
