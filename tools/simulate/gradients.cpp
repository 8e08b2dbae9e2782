// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/gradients.hpp"

#include <ceres/jet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "model/key_text.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/simulate/open_loop.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire {

namespace {

/// Parameters that one run differentiates by: a dual number of this many parts fills the vector registers.
constexpr int kAtOnce = 4;
using Dual = ceres::Jet<double, kAtOnce>;

/// Calls `f(key, value)` for every scalar parameter that acts.
template <class Parameters, class F>
void visit_acting(Parameters& parameters, F&& f) {
  std::vector<int> options;
  model::visit_effects(parameters, [&]<class E>(std::size_t, const auto& values) { options.push_back(values.option); });
  model::visit_parameters(parameters, [&](const model::Key& key, const auto& field, auto& value) {
    const bool acts = !key.is_effect || (parameters.effects.active[key.effect_index] &&
                                         model::is_used(field.options, options[key.effect_index]));
    if (acts) {
      f(std::string(model::KeyText(key, field.name).view()), value);
    }
  });
}

template <class Parameters>
std::vector<std::string> keys_of(const Parameters& parameters) {
  std::vector<std::string> keys;
  visit_acting(parameters, [&](const std::string& key, const auto&) { keys.push_back(key); });
  return keys;
}

/// The parameters with a dual part for each of `keys`.
template <class DualParameters, class Parameters>
DualParameters with_dual_parts(const Parameters& parameters, std::span<const std::string> keys) {
  auto dual = with_scalar<DualParameters>(parameters);
  visit_acting(dual, [&](const std::string& key, Dual& value) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (keys[k] == key) {
        value.v[static_cast<Eigen::Index>(k)] = 1.0;
      }
    }
  });
  return dual;
}

template <class Plant, class DualPlant>
std::vector<ChannelSlopes> differentiated(const typename Plant::Parameters& parameters, const Record& inputs,
                                          std::span<const std::string> keys) {
  const int steps = steps_in_row<Plant>(parameters, inputs.period);
  std::vector<ChannelSlopes> channels;
  channels.reserve(Plant::channels.size());
  for (const std::string_view name : Plant::channels) {
    channels.push_back({std::string(name), std::vector<double>(inputs.rows * keys.size())});
  }
  for (std::size_t first = 0; first < keys.size(); first += kAtOnce) {
    const auto some = keys.subspan(first, std::min<std::size_t>(kAtOnce, keys.size() - first));
    const DualPlant plant(with_dual_parts<typename DualPlant::Parameters>(parameters, some), inputs.period / steps);
    auto state = start_of(plant, inputs);
    const bool finite = run_record(plant, inputs, state, steps, [&](std::size_t row, const auto& readings) {
      for (std::size_t c = 0; c < readings.size(); ++c) {
        for (std::size_t k = 0; k < some.size(); ++k) {
          channels[c].slopes[row * keys.size() + first + k] = readings[c].v[static_cast<Eigen::Index>(k)];
        }
      }
    });
    if (!finite) {
      throw FileError(fmt::format("{}: the model runs away: its parameters make it unstable for this {}",
                                  inputs.path.string(), Plant::input_channel));
    }
  }
  return channels;
}

}  // namespace

std::vector<ChannelSlopes> gradients(const ModelFile& model, const Record& inputs, const std::vector<std::string>& keys) {
  const std::vector<std::string> acting =
      std::visit([](const auto& parameters) { return keys_of(parameters); }, model.parameters);
  for (const std::string& key : keys) {
    if (std::find(acting.begin(), acting.end(), key) == acting.end()) {
      throw UsageError(fmt::format("{} is not a parameter that acts in the model; {}", key,
                                   suggestion(key, std::vector<std::string_view>(acting.begin(), acting.end()))));
    }
  }
  return std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        using Plant = PlantOf<Parameters, double>;
        require_channel(inputs, std::string(Plant::input_channel), "the model is driven by it");
        return differentiated<Plant, PlantOf<Parameters, Dual>>(parameters, inputs, keys);
      },
      model.parameters);
}

}  // namespace hotfire
