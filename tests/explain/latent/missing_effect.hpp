// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>

#include "tests/explain/readings.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"
#include "tools/simulate/simulate.hpp"

// Records of a model that holds an effect which the declared one does not.
namespace hotfire::test {

inline constexpr double kPistonNoise = 8e-6;
inline constexpr double kEngineNoise = 6e-5;

/// 20 s at 500 Hz, read from `truth` with sensor noise. `command_at` gives the command at a time.
template <class Command>
Record record_under(const ModelFile& truth, const Command& command_at) {
  Record record;
  record.name = "sweep.csv";
  record.path = record.name;
  record.period = 2e-3;
  record.rows = 10000;
  Channel command{"command", "rad", {}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    command.values.push_back(command_at(static_cast<double>(row) * record.period));
  }
  record.channels.push_back(command);
  const Record modelled = simulate(truth, record);
  std::mt19937_64 random(7);
  add_readings(record, modelled, {{"piston", kPistonNoise}, {"engine", kEngineNoise}}, random);
  return record;
}

/// The same under a swept sine and steps of up to half a degree.
inline Record record_of(const ModelFile& truth, double scale = 1.0) {
  return record_under(truth, [scale](double t) {
    const double sweep = 5e-3 * std::sin(2.0 * std::numbers::pi * (0.3 * t + 0.2 * t * t));
    const double step = t > 12.0 ? 4e-3 * (std::fmod(t, 4.0) < 2.0 ? 1.0 : -1.0) : 0.0;
    return scale * (t < 0.5 ? 0.0 : sweep + step);
  });
}

inline ModelFile declared() {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", kPistonNoise}, {"engine", kEngineNoise}};
  model.tolerance = {{"servovalve.position_gain", 0.03}, {"engine.inertia", 0.02}, {"structure.stiffness", 0.05}};
  return model;
}

/// The declared model with one effect, its first fields at `values`.
template <class E>
ModelFile with_effect(std::initializer_list<double> values, int option = 0) {
  ModelFile model = declared();
  add_effect<E>(std::get<SimplexParameters>(model.parameters), [&](auto& effect) {
    effect.option = option;
    auto value = values.begin();
    for (const auto& field : std::remove_cvref_t<decltype(effect)>::fields()) {
      if (value != values.end() && model::is_used(field.options, option)) {
        effect.*field.member = *value++;
      }
    }
  });
  return model;
}

/// Data of the records of `truth` under the declared model.
inline explain::Dataset data_of(const ModelFile& truth, std::size_t copies = 1) {
  return explain::make_dataset(declared(), std::vector<Record>(copies, record_of(truth)));
}

/// The declared model about its declared values.
inline explain::Fitted about_declared() {
  const ModelFile model = declared();
  explain::Fitted about;
  about.base = model.parameters;
  about.free = explain::declared_parameters(about.base, model.tolerance);
  about.u.assign(about.free.size(), 0.0);
  return about;
}

}  // namespace hotfire::test
