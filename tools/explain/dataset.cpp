#include "tools/explain/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/explain/statistics.hpp"
#include "tools/files/error.hpp"

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

/// The rows of `blocks` that are in none of `taken`; both ascending.
std::vector<Block> without(const std::vector<Block>& blocks, const std::vector<Block>& taken) {
  std::vector<Block> rest;
  for (Block block : blocks) {
    for (const Block& hole : taken) {
      if (hole.last <= block.first || hole.first >= block.last) {
        continue;
      }
      if (hole.first > block.first) {
        rest.push_back({block.first, hole.first});
      }
      block.first = std::min(block.last, hole.last);
    }
    if (block.last > block.first) {
      rest.push_back(block);
    }
  }
  return rest;
}

/// The rows of a record that its user excludes.
std::vector<Block> excluded_rows(const Record& record, const std::vector<Exclusion>& exclusions) {
  std::vector<Block> rows;
  for (const Exclusion& exclusion : exclusions) {
    if (exclusion.record != record.name) {
      continue;
    }
    const auto row_at = [&](double time) {
      return static_cast<std::size_t>(
          std::clamp(std::ceil((time - record.start) / record.period - 1e-6), 0.0, static_cast<double>(record.rows)));
    };
    rows.push_back({row_at(exclusion.from), row_at(exclusion.to)});
    if (rows.back().first == rows.back().last) {
      throw UsageError(fmt::format("--exclude {}@{:g}-{:g}: no row of the record lies there; it goes from {:g} to {:g} s",
                                   exclusion.record, exclusion.from, exclusion.to, record.start,
                                   record.start + static_cast<double>(record.rows - 1) * record.period));
    }
  }
  std::sort(rows.begin(), rows.end(), [](const Block& a, const Block& b) { return a.first < b.first; });
  return rows;
}

/// Shares the rows of an experiment out between fit and judgement.
void share_out(Experiment& experiment) {
  std::vector<Block> taken{{0, experiment.first_scored}};
  taken.insert(taken.end(), experiment.excluded.begin(), experiment.excluded.end());
  std::erase_if(experiment.held_out, [&](const Block& block) { return block.first < experiment.first_scored; });
  experiment.fitted = without(without({{0, experiment.rows()}}, experiment.held_out), taken);
  experiment.held_out = without(experiment.held_out, experiment.excluded);
  if (experiment.fitted.empty()) {
    throw UsageError(fmt::format("--exclude leaves no row of {} to fit", experiment.name));
  }
}

std::vector<std::string> names_of(const std::vector<Record>& records) {
  std::vector<std::string> names;
  names.reserve(records.size());
  for (const Record& record : records) {
    names.push_back(record.name);
  }
  return names;
}

void require_known_records(const std::vector<Exclusion>& exclusions, const std::vector<Record>& records) {
  for (const Exclusion& exclusion : exclusions) {
    if (std::none_of(records.begin(), records.end(), [&](const Record& r) { return r.name == exclusion.record; })) {
      throw UsageError(fmt::format("--exclude {}: no record of that name; there are: {}", exclusion.record,
                                   fmt::join(names_of(records), ", ")));
    }
  }
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

std::vector<Block> Experiment::scored() const {
  std::vector<Block> blocks = fitted;
  blocks.insert(blocks.end(), held_out.begin(), held_out.end());
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.first < b.first; });
  return blocks;
}

Exclusion exclusion_from(const std::string& text) {
  const auto at = text.rfind('@');
  const auto dash = at == std::string::npos ? at : text.find('-', at + 2);
  Exclusion exclusion;
  try {
    exclusion.record = text.substr(0, at);
    std::size_t used = 0;
    const std::string from = text.substr(at + 1, dash - at - 1);
    const std::string to = text.substr(dash + 1);
    exclusion.from = std::stod(from, &used);
    bool whole = used == from.size();
    exclusion.to = std::stod(to, &used);
    whole = whole && used == to.size();
    if (at != std::string::npos && dash != std::string::npos && whole && exclusion.to > exclusion.from) {
      return exclusion;
    }
  } catch (const std::logic_error&) {
    // Not a number: said below, with the form that is wanted.
  }
  throw UsageError(fmt::format("--exclude {}: write RECORD@FROM-TO with times in seconds, such as steps.csv@3.0-3.5", text));
}

Dataset make_dataset(const ModelFile& model, const std::vector<Record>& records, const std::vector<Exclusion>& exclusions) {
  require_known_records(exclusions, records);
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
    }
  }
  for (std::size_t e = 0; e < records.size(); ++e) {
    data.experiments[e].excluded = excluded_rows(records[e], exclusions);
    share_out(data.experiments[e]);
  }
  return data;
}

void fit_every_row(Dataset& data) {
  for (Experiment& experiment : data.experiments) {
    experiment.fitted = experiment.scored();
    experiment.held_out.clear();
  }
}

Dataset thinned(const Dataset& data, double period) {
  Dataset thin = data;
  for (Experiment& experiment : thin.experiments) {
    const auto every = static_cast<std::size_t>(std::max(1.0, std::floor(period / experiment.period * (1.0 + 1e-9))));
    if (every == 1) {
      continue;
    }
    const auto kept = [&](std::size_t row) { return (row + every - 1) / every; };
    const auto thin_blocks = [&](std::vector<Block>& blocks) {
      for (Block& block : blocks) {
        block = {kept(block.first), kept(block.last)};
      }
      std::erase_if(blocks, [](const Block& block) { return block.first == block.last; });
    };
    const std::vector<double> full = std::move(experiment.input);
    experiment.input.assign(kept(full.size()), 0.0);
    for (std::size_t row = 0; row < experiment.input.size(); ++row) {
      const auto first = full.begin() + static_cast<std::ptrdiff_t>(row * every);
      const auto held = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(every), full.end() - first);
      experiment.input[row] = std::accumulate(first, first + held, 0.0) / static_cast<double>(held);
    }
    const auto thin_rows = [&](std::vector<double>& values) {
      for (std::size_t row = 0; row * every < values.size(); ++row) {
        values[row] = values[row * every];
      }
      values.resize(kept(values.size()));
    };
    for (std::vector<double>& channel : experiment.measured) {
      thin_rows(channel);
    }
    for (std::vector<double>* motion : {&experiment.other.angle, &experiment.other.rate, &experiment.other.force}) {
      thin_rows(*motion);
    }
    experiment.period *= static_cast<double>(every);
    experiment.first_scored = kept(experiment.first_scored);
    thin_blocks(experiment.fitted);
    thin_blocks(experiment.held_out);
    thin_blocks(experiment.excluded);
  }
  return thin;
}

std::vector<std::string> held_out_names(const Dataset& data) {
  std::vector<std::string> names;
  for (const Experiment& experiment : data.experiments) {
    for (const Block& block : experiment.held_out) {
      names.push_back(
          fmt::format("{}@{:.1f}-{:.1f}", experiment.name, experiment.time_of(block.first), experiment.time_of(block.last)));
    }
  }
  return names;
}

}  // namespace hotfire::explain
