// SPDX-License-Identifier: Apache-2.0
#include "tools/python/vehicle_gradients.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <span>

#include "tools/explain/fit/parallel.hpp"
#include "tools/interface/plant/plant.hpp"
#include "tools/library/declared_plant.hpp"
#include "tools/simulate/excitation.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

namespace hotfire::python {

namespace {

/// A channel of the record that drives an input of the plant.
struct Driven {
  std::size_t input;
  Excitation excitation;
};

/// What `simulate` holds between rows, and what it interpolates.
Excitation::Between between_rows_of(const std::string& name) {
  return name.starts_with("command") || name.starts_with("thrust") ? Excitation::Between::held
                                                                   : Excitation::Between::interpolated;
}

std::vector<Driven> driven_inputs(const plant::Plant& plant, const Record& inputs) {
  std::vector<Driven> driven;
  for (std::size_t i = 0; i < plant.inputs().size(); ++i) {
    const std::string& name = plant.inputs()[i].name;
    if (const Channel* channel = inputs.find(name); channel != nullptr) {
      driven.push_back({i, Excitation(channel->values, plant.steps(), between_rows_of(name))});
    }
  }
  return driven;
}

/// The place of an axis's parameter in the table of the plant, which numbers the only engine as well.
std::size_t place_of(const plant::Plant& plant, const std::string& key) {
  const std::size_t dot = key.find('.');
  const bool numbered = key[dot - 1] >= '1' && key[dot - 1] <= '9';
  const std::string own = numbered ? key : key.substr(0, dot) + '1' + key.substr(dot);
  const auto found = std::find_if(plant.parameters().begin(), plant.parameters().end(),
                                  [&own](const plant::Variable& parameter) { return parameter.name == own; });
  return static_cast<std::size_t>(found - plant.parameters().begin());
}

/// Fills column `column` of every channel.
void differentiate(plant::Plant& plant, const Record& inputs, const std::string& key, std::size_t column,
                   std::size_t columns, std::vector<ChannelSlopes>& channels) {
  const std::vector<Driven> driven = driven_inputs(plant, inputs);
  const auto put = [&](std::size_t row, int step) {
    for (const Driven& own : driven) {
      plant.input_values()[own.input] = own.excitation(row, step);
    }
  };
  const std::array seeds{plant::Seed{plant::Seed::Kind::parameter, place_of(plant, key), 1.0}};
  std::vector<double> slopes(plant.outputs().size());
  put(0, 0);
  plant.start_slopes(inputs.start, seeds);
  for (std::size_t row = 0; row < inputs.rows; ++row) {
    plant.read_slopes(slopes);
    for (std::size_t c = 0; c < slopes.size(); ++c) {
      channels[c].slopes[row * columns + column] = slopes[c];
    }
    for (int step = 0; step < plant.steps(); ++step) {
      put(row, step);
      plant.step_slopes();
    }
  }
}

}  // namespace

std::vector<ChannelSlopes> vehicle_gradients(const VehicleFile& model, const Record& inputs,
                                             const std::vector<std::string>& keys, unsigned threads) {
  // Refuses what cannot be run, in its own words.
  simulate(model, inputs);
  const DeclaredPlant declared = declared_plant(model, inputs.period, VehicleRun{}.seed);
  const auto make = [&] { return plant::make_plant(declared.parameters, declared.setup); };
  std::vector<ChannelSlopes> channels;
  const std::unique_ptr<plant::Plant> named = make();
  for (const plant::Variable& output : named->outputs()) {
    channels.push_back({output.name, std::vector<double>(inputs.rows * keys.size())});
  }
  explain::parallel_for(keys.size(), threads, [&](std::size_t column) {
    differentiate(*make(), inputs, keys[column], column, keys.size(), channels);
  });
  return channels;
}

}  // namespace hotfire::python
