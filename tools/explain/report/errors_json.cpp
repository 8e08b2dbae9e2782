// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/errors_json.hpp"

namespace hotfire::explain {

nlohmann::json errors_of(const ChannelFit& fit) {
  return {{"rms", fit.rms}, {"max", fit.max}, {"bias", fit.bias}, {"fit_percent", fit.fit_percent}};
}

}  // namespace hotfire::explain
