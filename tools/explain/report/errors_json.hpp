// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/explain/fit/goodness.hpp"

namespace hotfire::explain {

/// "rms", "max", "bias" in the channel's unit and "fit_percent".
nlohmann::json errors_of(const ChannelFit& fit);

}  // namespace hotfire::explain
