// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/zeros.hpp"

#include <algorithm>

namespace hotfire::explain {

double zero_precision(const Experiment& experiment, std::size_t channel) {
  if (experiment.measured[channel].empty()) {
    return 0.0;
  }
  double rows = 0.0;
  for (const Block& block : experiment.fitted) {
    rows += static_cast<double>(block.last - block.first);
  }
  const double deviation = experiment.zero_deviation[channel] / experiment.noise[channel];
  return rows * deviation * deviation;
}

double zero_of(const Experiment& experiment, std::size_t channel, const std::vector<double>& predicted) {
  const double precision = zero_precision(experiment, channel);
  if (!(precision > 0.0)) {
    return 0.0;
  }
  double sum = 0.0;
  double rows = 0.0;
  for (const Block& block : experiment.fitted) {
    for (std::size_t row = block.first; row < block.last; ++row) {
      sum += experiment.measured[channel][row] - predicted[row];
    }
    rows += static_cast<double>(block.last - block.first);
  }
  return sum / rows * precision / (1.0 + precision);
}

Zeros add_zeros(const Dataset& data, std::vector<std::vector<std::vector<double>>>& prediction) {
  Zeros zeros(prediction.size());
  for (std::size_t e = 0; e < prediction.size(); ++e) {
    for (std::size_t c = 0; c < prediction[e].size(); ++c) {
      const double zero = zero_of(data.experiments[e], c, prediction[e][c]);
      zeros[e].push_back(zero);
      std::ranges::for_each(prediction[e][c], [zero](double& value) { value += zero; });
    }
  }
  return zeros;
}

Dataset without_zeros(Dataset data, const Zeros& zeros) {
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const double zero = zeros[e][c];
      std::ranges::for_each(data.experiments[e].measured[c], [zero](double& value) { value -= zero; });
    }
  }
  return data;
}

}  // namespace hotfire::explain
