#include "tools/explain/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/explain/statistics.hpp"

namespace hotfire::explain {

namespace {

constexpr double kBlockSeconds = 4.0;
constexpr std::size_t kFewestBlocks = 8;
constexpr std::size_t kHoldOutEvery = 4;

std::vector<Block> hold_out(std::size_t rows, double period, std::size_t shift) {
  const auto wanted = static_cast<std::size_t>(std::lround(static_cast<double>(rows) * period / kBlockSeconds));
  const std::size_t blocks = std::max(kFewestBlocks, wanted);
  std::vector<Block> held;
  for (std::size_t block = 0; block < blocks; ++block) {
    // The third of each four, shifted from record to record: never the first block, which holds the start.
    if ((block + shift) % kHoldOutEvery == 2 && block > 0) {
      held.push_back({rows * block / blocks, rows * (block + 1) / blocks});
    }
  }
  return held;
}

template <class Parameters>
struct ChannelsOf;
template <>
struct ChannelsOf<SimplexParameters> {
  using Plant = model::Simplex<double>;
};
template <>
struct ChannelsOf<DirectParameters> {
  using Plant = model::Direct<double>;
};

/// A force-driven mass plainly moves at the first row if its speed there is above a tenth of its rms speed; less than that a
/// record that starts at rest can show within the differences it is estimated from.
bool starts_at_rest(const std::vector<double>& position) {
  if (position.size() < 8) {
    return true;
  }
  double sum = 0.0;
  for (std::size_t i = 1; i < position.size(); ++i) {
    sum += (position[i] - position[i - 1]) * (position[i] - position[i - 1]);
  }
  const double rms = std::sqrt(sum / static_cast<double>(position.size() - 1));
  const double first = 0.5 * (position[2] - position[0]);
  return std::abs(first) <= 0.1 * rms;
}

}  // namespace

Dataset make_dataset(const ModelFile& model, const std::vector<Record>& records) {
  Dataset data;
  std::string input;
  bool is_direct = false;
  std::visit(
      [&](const auto& parameters) {
        using Plant = typename ChannelsOf<std::remove_cvref_t<decltype(parameters)>>::Plant;
        for (const auto channel : Plant::channels) {
          data.channels.emplace_back(channel);
        }
        input = Plant::input_channel;
        is_direct = Plant::topology == "direct";
      },
      model.parameters);
  data.used.assign(data.channels.size(), false);

  std::size_t shift = 0;
  for (const Record& record : records) {
    require_channel(record, input, "the model is driven by it");
    Experiment experiment;
    experiment.name = record.name;
    experiment.start = record.start;
    experiment.period = record.period;
    experiment.input = record.find(input)->values;
    bool any = false;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const Channel* channel = record.find(data.channels[c]);
      experiment.measured.push_back(channel != nullptr ? channel->values : std::vector<double>{});
      any = any || channel != nullptr;
      data.used[c] = data.used[c] || channel != nullptr;
    }
    if (!any) {
      require_channel(record, data.channels.front(), "without a measured channel there is nothing to explain");
    }
    experiment.held_out = hold_out(record.rows, record.period, shift++);
    if (is_direct) {
      experiment.at_rest = starts_at_rest(experiment.measured.front());
    }
    data.experiments.push_back(std::move(experiment));
  }

  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const auto declared = model.noise.find(data.channels[c]);
    data.noise_declared.push_back(declared != model.noise.end());
    if (declared != model.noise.end()) {
      data.noise.push_back(declared->second);
      continue;
    }
    std::vector<double> estimates;
    for (const Experiment& experiment : data.experiments) {
      if (!experiment.measured[c].empty()) {
        estimates.push_back(noise_from_differences(experiment.measured[c]));
      }
    }
    data.noise.push_back(estimates.empty() ? 1.0 : *std::min_element(estimates.begin(), estimates.end()));
  }
  return data;
}

std::vector<std::string> held_out_names(const Dataset& data) {
  std::vector<std::string> names;
  for (const Experiment& experiment : data.experiments) {
    for (const Block& block : experiment.held_out) {
      names.push_back(fmt::format("{}@{:.1f}-{:.1f}", experiment.name,
                                  experiment.start + static_cast<double>(block.first) * experiment.period,
                                  experiment.start + static_cast<double>(block.last) * experiment.period));
    }
  }
  return names;
}

}  // namespace hotfire::explain
