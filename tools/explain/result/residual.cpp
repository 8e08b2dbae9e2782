// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/residual.hpp"

#include <algorithm>
#include <utility>

namespace hotfire::explain {

ResidualResult residual_result(const Dataset& data, const Prediction& before, const Prediction& after) {
  ResidualResult residual;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!data.used[c]) {
      continue;
    }
    const auto of_both = [&](auto&& statistic) {
      using Statistic = decltype(statistic(data, before, c));
      return BeforeAndAfter<Statistic>{statistic(data, before, c), statistic(data, after, c)};
    };
    ChannelResidual channel{data.channels[c], of_both(residual_autocorrelation), of_both(input_correlation),
                            of_both(error_by_frequency), of_both(error_by_amplitude)};
    residual.is_white = residual.is_white && channel.autocorrelation.after.is_none();
    const double declared = excess_over_noise(data, before, c);
    const double left = excess_over_noise(data, after, c);
    const double unexplained = declared > 0.0 ? 100.0 * std::min(1.0, left / declared) : 0.0;
    residual.unexplained = std::max(residual.unexplained, unexplained);
    residual.channels.push_back(std::move(channel));
  }
  return residual;
}

}  // namespace hotfire::explain
