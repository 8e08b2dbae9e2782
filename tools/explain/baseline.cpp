// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/baseline.hpp"

#include <algorithm>
#include <cmath>

#include "tools/explain/inference/residual_statistics.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

/// Two errors that differ by less than this share are the same.
constexpr double kSame = 0.02;

/// The frequencies and the amplitudes at which one model leaves more than the other, in a sentence.
std::string where(const Dataset& data, const Prediction& worse, const Prediction& better, std::size_t channel) {
  const std::vector<Band> of_worse = error_by_frequency(data, worse, channel);
  const std::vector<Band> of_better = error_by_frequency(data, better, channel);
  double from = 0.0;
  double to = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < of_worse.size(); ++i) {
    const double more = of_worse[i].rms * of_worse[i].rms - of_better[i].rms * of_better[i].rms;
    if (more > most) {
      most = more;
      from = of_worse[i].from;
      to = of_worse[i].to;
    }
  }
  const std::vector<AmplitudeRange> ranges_of_worse = error_by_amplitude(data, worse, channel);
  const std::vector<AmplitudeRange> ranges_of_better = error_by_amplitude(data, better, channel);
  most = 0.0;
  double least_amplitude = 0.0;
  double most_amplitude = 0.0;
  for (std::size_t i = 0; i < ranges_of_worse.size(); ++i) {
    const double more =
        (std::pow(ranges_of_worse[i].rms, 2) - std::pow(ranges_of_better[i].rms, 2)) * ranges_of_worse[i].seconds;
    if (more > most) {
      most = more;
      least_amplitude = ranges_of_worse[i].from;
      most_amplitude = ranges_of_worse[i].to;
    }
  }
  return words::baseline_difference(from, to, least_amplitude, most_amplitude);
}

}  // namespace

std::optional<Baseline> baseline_of(const BlackBox& box, const Dataset& data, const Prediction& explained) {
  if (!box.is_there()) {
    return std::nullopt;
  }
  const Dataset thin = for_black_box(data);
  const Prediction by_box = simulated(box, thin);
  const Prediction by_model = at_thinned_rows(explained, data, thin);
  const Goodness of_box = goodness(thin, by_box);
  const Goodness of_model = goodness(thin, by_model);
  Baseline baseline;
  baseline.period = box.period;
  std::string text;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!box.channels[c]) {
      continue;
    }
    const LinearModel& model = *box.channels[c];
    const double left = of_box.held_out[c].rms;
    const double explained_left = of_model.held_out[c].rms;
    const BaselineChannel& channel = baseline.channels.emplace_back(
        BaselineChannel{data.channels[c], of_box.held_out[c], model.order(), static_cast<double>(model.delay) * box.period});
    text += " " + words::baseline_channel(channel.name, channel.order, channel.delay, left, explained_left);
    if (left < (1.0 - kSame) * explained_left) {
      baseline.is_better = true;
      text += " " + where(thin, by_model, by_box, c);
    }
  }
  baseline.sentence = words::baseline(baseline.is_better) + text;
  return baseline;
}

void add_baseline(const BlackBox& box, const Dataset& record, std::vector<ChannelErrors>& channels) {
  const Dataset thin = for_black_box(record);
  constexpr double kSamePeriod = 1e-6;
  if (!box.is_there() || std::abs(thin.experiments.front().period - box.period) > kSamePeriod * box.period) {
    return;
  }
  const Goodness reached = goodness(thin, simulated(box, thin));
  for (std::size_t c = 0; c < record.channels.size(); ++c) {
    const auto own = std::ranges::find(channels, record.channels[c], &ChannelErrors::name);
    if (box.channels[c] && own != channels.end()) {
      own->black_box = reached.fitted[c];
    }
  }
}

}  // namespace hotfire::explain
