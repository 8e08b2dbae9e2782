// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/explain/data/hold_out.hpp"
#include "tools/explain/data/plants.hpp"
#include "tools/explain/data/smoothing.hpp"
#include "tools/explain/data/statistics.hpp"
#include "tools/explain/data/zeros.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

/// Shares the rows of an experiment out between fit and judgement.
void share_out(Experiment& experiment) {
  std::vector<Block> taken{{0, experiment.first_scored}};
  taken.insert(taken.end(), experiment.excluded.begin(), experiment.excluded.end());
  std::erase_if(experiment.held_out, [&](const Block& block) { return block.first < experiment.first_scored; });
  experiment.fitted = without(without({{0, experiment.rows()}}, experiment.held_out), taken);
  experiment.held_out = without(experiment.held_out, experiment.excluded);
  if (experiment.fitted.empty()) {
    throw UsageError(words::nothing_to_fit(experiment.name));
  }
}

/// A channel, `bridged` over the rows that the user excludes: a value that is missing elsewhere is an error.
std::vector<double> values_of(const Channel& channel, const Record& record, const std::vector<Block>& excluded) {
  for (const Block& kept : without({{0, channel.values.size()}}, excluded)) {
    for (std::size_t row = kept.first; row < kept.last; ++row) {
      if (std::isnan(channel.values[row])) {
        throw UsageError(
            words::missing_value(record.name, channel.name, record.start + static_cast<double>(row) * record.period));
      }
    }
  }
  return bridged(channel.values, excluded);
}

/// A record in the channels of the model, of which it marks those that the record has as used.
Experiment experiment_of(const Record& record, const std::string& input, const std::vector<Exclusion>& exclusions,
                         Dataset& data) {
  require_channel(record, input, words::drives_the_model());
  Experiment experiment;
  experiment.name = record.name;
  experiment.start = record.start;
  experiment.period = record.period;
  experiment.excluded = excluded_rows(record, exclusions);
  experiment.input_is_held = is_missing_somewhere(*record.find(input));
  experiment.input = held_where_missing(*record.find(input), record);
  require_units_of_one_motion(record);
  const bool is_hydraulic = input == model::Simplex<double>::input_channel;
  if (is_hydraulic) {
    const Channel* torque = record.find("torque");
    experiment.torque = torque != nullptr ? load_of(*torque, record, exclusions) : std::vector<double>{};
  }
  for (const Channel& channel : record.channels) {
    const bool is_input = channel.name == input || (channel.name == "torque" && is_hydraulic);
    if (!is_input && std::ranges::find(data.channels, channel.name) == data.channels.end()) {
      experiment.unused.push_back(channel.name);
    }
  }
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const Channel* channel = record.find(data.channels[c]);
    experiment.measured.emplace_back();
    if (channel != nullptr) {
      experiment.measured.back() = values_of(*channel, record, experiment.excluded);
      data.used[c] = true;
    }
  }
  if (std::ranges::all_of(experiment.measured, &std::vector<double>::empty)) {
    require_channel(record, fmt::format("{}", fmt::join(data.channels, " or ")), words::nothing_to_explain());
  }
  return experiment;
}

/// A record that shows more than this many times the noise that was declared, while another does not, is a louder one.
constexpr double kClearlyMore = 1.5;

/// Whether the declared noise of a channel is that of some record: then the others may be louder.
bool is_met_somewhere(const Dataset& data, std::size_t channel, double declared) {
  return std::ranges::any_of(data.experiments, [&](const Experiment& experiment) {
    return !experiment.measured[channel].empty() &&
           quiet_noise(kept_rows(experiment.measured[channel], experiment.excluded)) <= kClearlyMore * declared;
  });
}

/// The noise of every record and channel: declared, but for a louder record; or what third differences show where nothing is
/// declared, but not less than the floor. What a channel has over all records is the root of the mean square over their
/// rows.
void set_noise(const ModelFile& model, Dataset& data) {
  for (Experiment& experiment : data.experiments) {
    experiment.noise.assign(data.channels.size(), 1.0);
  }
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const auto declared = model.noise.find(data.channels[c]);
    const bool is_declared = declared != model.noise.end();
    const bool may_be_louder = is_declared && is_met_somewhere(data, c, declared->second);
    NoiseSource source = is_declared ? NoiseSource::declared : NoiseSource::estimated;
    double square = 0.0;
    double rows = 0.0;
    for (Experiment& experiment : data.experiments) {
      if (experiment.measured[c].empty()) {
        continue;
      }
      double& noise = experiment.noise[c];
      const std::vector<double> kept = kept_rows(experiment.measured[c], experiment.excluded);
      if (is_declared) {
        const bool is_louder = may_be_louder && quiet_noise(kept) > kClearlyMore * declared->second;
        noise = is_louder ? noise_from_differences(kept) : declared->second;
      } else {
        const NoiseFloor floor = noise_floor(kept);
        noise = noise_from_differences(kept);
        source = noise < floor.reportable ? NoiseSource::floor : source;
        noise = std::max(noise, floor.least);
      }
      square += noise * noise * static_cast<double>(experiment.rows());
      rows += static_cast<double>(experiment.rows());
    }
    data.noise_source.push_back(source);
    data.noise.push_back(rows > 0.0 ? std::sqrt(square / rows) : is_declared ? declared->second : 1.0);
  }
}

/// What a channel's zero may be off by: a share of the channel's largest half travel in any record.
void set_zero_deviations(const ModelFile& model, Dataset& data) {
  for (Experiment& experiment : data.experiments) {
    experiment.zero_deviation.assign(data.channels.size(), 0.0);
  }
  // A force-driven mass starts where it is measured.
  if (std::holds_alternative<DirectParameters>(model.parameters)) {
    return;
  }
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    double travel = 0.0;
    for (const Experiment& experiment : data.experiments) {
      if (!experiment.measured[c].empty()) {
        const auto [low, high] = std::ranges::minmax(experiment.measured[c]);
        travel = std::max(travel, 0.5 * (high - low));
      }
    }
    for (Experiment& experiment : data.experiments) {
      experiment.zero_deviation[c] = kZeroShare * travel;
    }
  }
}

}  // namespace

std::vector<Block> Experiment::scored() const {
  std::vector<Block> blocks = fitted;
  blocks.insert(blocks.end(), held_out.begin(), held_out.end());
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.first < b.first; });
  return blocks;
}

Dataset make_dataset(const ModelFile& model, const std::vector<Record>& records, const std::vector<Exclusion>& exclusions) {
  Dataset data;
  std::string input;
  std::visit(
      [&](const auto& parameters) {
        using Plant = PlantOf<decltype(parameters), double>;
        for (const auto channel : Plant::channels) {
          data.channels.emplace_back(channel);
        }
        input = Plant::input_channel;
      },
      model.parameters);
  data.input_is_path = std::holds_alternative<ImposedMotionParameters>(model.parameters);
  data.used.assign(data.channels.size(), false);

  data.experiments.reserve(records.size());
  const auto* motor = std::get_if<ElectromechanicalParameters>(&model.parameters);
  for (const Record& record : records) {
    if (motor != nullptr && has_position_loop(*motor)) {
      require_same_unit(record, "setpoint", "position");
    }
    data.experiments.push_back(experiment_of(record, input, exclusions, data));
  }
  hold_out(data.experiments);

  set_noise(model, data);
  set_zero_deviations(model, data);
  if (const auto* mass = std::get_if<DirectParameters>(&model.parameters)) {
    for (Experiment& experiment : data.experiments) {
      experiment.start_state =
          start_state(*mass, experiment.input, experiment.measured, experiment.period, experiment.noise);
    }
  } else if (const auto* modes = std::get_if<ModalParameters>(&model.parameters)) {
    for (Experiment& experiment : data.experiments) {
      experiment.first_scored = rows_to_forget_start(*modes, experiment.rows(), experiment.period);
    }
  } else if (motor != nullptr) {
    for (Experiment& experiment : data.experiments) {
      experiment.first_scored =
          rows_to_forget_start(*motor, experiment.input, experiment.measured, experiment.period, experiment.noise);
    }
  } else if (const auto* axis = std::get_if<SimplexParameters>(&model.parameters)) {
    for (Experiment& experiment : data.experiments) {
      experiment.first_scored =
          rows_to_forget_start(*axis, experiment.input, experiment.measured, experiment.period, experiment.noise);
    }
  }
  for (Experiment& experiment : data.experiments) {
    share_out(experiment);
  }
  return data;
}

void forget_start(Experiment& experiment, std::size_t rows) {
  experiment.first_scored = rows;
  share_out(experiment);
}

bool forget_moving_starts(const ModelParameters& model, const std::vector<std::vector<std::vector<double>>>& predicted,
                          Dataset& data) {
  const auto* axis = std::get_if<SimplexParameters>(&model);
  bool any = false;
  for (std::size_t e = 0; axis != nullptr && e < data.experiments.size(); ++e) {
    Experiment& experiment = data.experiments[e];
    const std::size_t memory = rows_of_memory(*axis, experiment.rows(), experiment.period);
    const bool is_bridged = std::ranges::any_of(experiment.excluded, [&](const Block& b) { return b.first < memory; });
    bool moves = false;
    for (std::size_t c = 0; experiment.first_scored == 0 && !is_bridged && c < experiment.measured.size(); ++c) {
      std::vector<double> left(experiment.measured[c]);
      for (std::size_t row = 0; row < left.size(); ++row) {
        left[row] -= predicted[e][c][row];
      }
      moves = moves || dies_out_at_start(left, memory, experiment.noise[c]);
    }
    if (moves) {
      any = true;
      forget_start(experiment, memory);
    }
  }
  return any;
}

std::vector<double> position_of(const Experiment& mass) {
  using Mass = model::Direct<double>;
  if (mass.measured.size() < Mass::channels.size()) {
    return mass.input;
  }
  if (!mass.measured[Mass::kPosition].empty()) {
    return mass.measured[Mass::kPosition];
  }
  const std::vector<double>& velocity = mass.measured[Mass::kVelocity];
  return integral_of(velocity.empty() ? integral_of(mass.measured[Mass::kAcceleration], mass.period) : velocity,
                     mass.period);
}

std::vector<double> load_of(const Channel& channel, const Record& record, const std::vector<Exclusion>& exclusions) {
  return values_of(channel, record, excluded_rows(record, exclusions));
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
      experiment.input[row] =
          data.input_is_path ? *first : std::accumulate(first, first + held, 0.0) / static_cast<double>(held);
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
    for (std::vector<double>* motion :
         {&experiment.torque, &experiment.other.angle, &experiment.other.rate, &experiment.other.force}) {
      thin_rows(*motion);
    }
    experiment.vehicle.for_each_series(thin_rows);
    experiment.period *= static_cast<double>(every);
    experiment.log_rows *= static_cast<int>(every);
    experiment.first_scored = kept(experiment.first_scored);
    thin_blocks(experiment.fitted);
    thin_blocks(experiment.held_out);
    thin_blocks(experiment.excluded);
  }
  return thin;
}

Dataset thinned_to_rows(const Dataset& data, double rows) {
  double all = 0.0;
  double seconds = 0.0;
  for (const Experiment& experiment : data.experiments) {
    all += static_cast<double>(experiment.rows());
    seconds += static_cast<double>(experiment.rows()) * experiment.period;
  }
  return all > rows ? thinned(data, seconds / rows) : data;
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
