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

}  // namespace

Dataset make_dataset(const ModelFile& model, const std::vector<Record>& records) {
  Dataset data;
  std::string input;
  std::visit(
      [&](const auto& parameters) {
        using Plant = typename ChannelsOf<std::remove_cvref_t<decltype(parameters)>>::Plant;
        for (const auto channel : Plant::channels) {
          data.channels.emplace_back(channel);
        }
        input = Plant::input_channel;
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
  if (const auto* mass = std::get_if<DirectParameters>(&model.parameters)) {
    for (Experiment& experiment : data.experiments) {
      experiment.start_state =
          start_state(*mass, experiment.input, experiment.measured.front(), experiment.period, data.noise.front());
    }
  } else {
    for (Experiment& experiment : data.experiments) {
      experiment.first_scored = rows_to_forget_start(std::get<SimplexParameters>(model.parameters), experiment.input,
                                                     experiment.measured, experiment.period, data.noise);
      std::erase_if(experiment.held_out, [&](const Block& block) { return block.first < experiment.first_scored; });
    }
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
