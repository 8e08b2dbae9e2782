// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/veto.hpp"

#include <algorithm>
#include <cmath>

#include "tools/explain/fit/goodness.hpp"
#include "tools/explain/inference/residual_statistics.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

namespace {

constexpr double kSignalOverNoise = 10.0;
constexpr double kSignalShare = 0.01;

/// Root mean square of what is left of a channel on the held-out rows of one record.
double left_of(const Experiment& experiment, const std::vector<std::vector<double>>& prediction, std::size_t channel) {
  double square = 0.0;
  double rows = 0.0;
  for (const Block& block : experiment.held_out) {
    for (const double left : residual_of(experiment, prediction[channel], channel, block)) {
      square += left * left;
    }
    rows += static_cast<double>(block.last - block.first);
  }
  return rows > 0.0 ? std::sqrt(square / rows) : 0.0;
}

/// The channel itself, by frequency.
std::vector<Band> signal_by_frequency(const Dataset& data, const Prediction& like, std::size_t channel) {
  Prediction nothing = like;
  for (auto& experiment : nothing) {
    std::ranges::fill(experiment[channel], 0.0);
  }
  return error_by_frequency(data, nothing, channel);
}

}  // namespace

std::string harm_of(const Dataset& data, const Prediction& model, const Prediction& calibrated) {
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!data.used[c]) {
      continue;
    }
    for (std::size_t e = 0; e < data.experiments.size(); ++e) {
      const Experiment& experiment = data.experiments[e];
      if (experiment.measured[c].empty() || experiment.held_out.empty()) {
        continue;
      }
      const double before = left_of(experiment, calibrated[e], c);
      const double after = left_of(experiment, model[e], c);
      if (after > (1.0 + policy().scatter) * before && after > policy().chaotic * experiment.noise[c]) {
        return words::worse_record(experiment.name, after / before - 1.0, data.channels[c]);
      }
    }
    const std::vector<Band> before = error_by_frequency(data, calibrated, c);
    const std::vector<Band> after = error_by_frequency(data, model, c);
    const std::vector<Band> signal = signal_by_frequency(data, model, c);
    double whole = 0.0;
    for (const Band& band : signal) {
      whole += band.rms * band.rms;
    }
    for (std::size_t i = 0; i < after.size(); ++i) {
      const bool has_signal =
          signal[i].rms > kSignalOverNoise * signal[i].noise && signal[i].rms > kSignalShare * std::sqrt(whole);
      if (has_signal && policy().little_explained * after[i].rms > before[i].rms &&
          after[i].rms > policy().chaotic * after[i].noise) {
        return words::worse_band(data.channels[c], after[i].rms / before[i].rms - 1.0, after[i].from, after[i].to);
      }
    }
  }
  return "";
}

}  // namespace hotfire::explain
