// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/baseline.hpp"

#include <cmath>

#include "tools/explain/inference/residual_statistics.hpp"
#include "tools/explain/report/errors_json.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

using nlohmann::json;

/// Two errors that differ by less than this share are the same.
constexpr double kSame = 0.02;

/// The rows of a prediction that a thinned dataset has.
Prediction of_rows(const Prediction& full, const Dataset& data, const Dataset& thin) {
  Prediction result(full.size());
  for (std::size_t e = 0; e < full.size(); ++e) {
    const auto every = static_cast<std::size_t>(std::lround(thin.experiments[e].period / data.experiments[e].period));
    for (const std::vector<double>& channel : full[e]) {
      std::vector<double>& rows = result[e].emplace_back();
      for (std::size_t row = 0; row < channel.size(); row += every) {
        rows.push_back(channel[row]);
      }
    }
  }
  return result;
}

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

json baseline_json(const BlackBox& box, const Dataset& data, const Prediction& explained) {
  if (!box.is_there()) {
    return nullptr;
  }
  const Dataset thin = for_black_box(data);
  const Prediction by_box = simulated(box, thin);
  const Prediction by_model = of_rows(explained, data, thin);
  const Goodness of_box = goodness(thin, by_box);
  const Goodness of_model = goodness(thin, by_model);
  json baseline{{"kind", "linear"}, {"period", box.period}, {"channels", json::object()}};
  std::string text;
  bool is_better = false;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!box.channels[c]) {
      continue;
    }
    const LinearModel& model = *box.channels[c];
    const double left = of_box.held_out[c].rms;
    const double explained_left = of_model.held_out[c].rms;
    json& channel = baseline["channels"][data.channels[c]];
    channel = errors_of(of_box.held_out[c]);
    channel["order"] = model.order();
    channel["delay"] = static_cast<double>(model.delay) * box.period;
    text += " " + words::baseline_channel(data.channels[c], static_cast<std::size_t>(model.order()),
                                          static_cast<double>(model.delay) * box.period, left, explained_left);
    if (left < (1.0 - kSame) * explained_left) {
      is_better = true;
      text += " " + where(thin, by_model, by_box, c);
    }
  }
  baseline["better_than_explained"] = is_better;
  baseline["sentence"] = words::baseline(is_better) + text;
  return baseline;
}

void add_baseline(const BlackBox& box, const Dataset& record, json& channels) {
  const Dataset thin = for_black_box(record);
  constexpr double kSamePeriod = 1e-6;
  if (!box.is_there() || std::abs(thin.experiments.front().period - box.period) > kSamePeriod * box.period) {
    return;
  }
  const Goodness reached = goodness(thin, simulated(box, thin));
  for (std::size_t c = 0; c < record.channels.size(); ++c) {
    if (box.channels[c] && record.used[c]) {
      channels[record.channels[c]]["black_box"] = errors_of(reached.fitted[c]);
    }
  }
}

}  // namespace hotfire::explain
