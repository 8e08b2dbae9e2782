// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/disturbed.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "model/numerics/step_size.hpp"
#include "tools/files/text/error.hpp"
#include "tools/interface/plant/normal.hpp"
#include "tools/simulate/run.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

namespace {

using Axis = model::Simplex<double>;

/// Runs an uncommanded axis; `impulse(row)` [N m s] hits the engine after each row.
template <class Impulse>
Record run_disturbed(const SimplexParameters& parameters, double seconds, Impulse&& impulse) {
  const int steps = model::steps_per_period(kPeriod);
  const Axis plant(parameters, kPeriod / steps);
  auto state = plant.steady(0.0);
  Record record = command_record(std::vector<double>(static_cast<std::size_t>(seconds / kPeriod), 0.0));
  std::vector<double> piston;
  std::vector<double> engine;
  for (std::size_t row = 0; row < record.rows; ++row) {
    piston.push_back(Axis::measured(state)[0]);
    engine.push_back(Axis::measured(state)[1]);
    state.y(Axis::kAngleRate) += impulse(row) / parameters.engine.inertia;
    for (int k = 0; k < steps; ++k) {
      plant.step(state, 0.0);
    }
  }
  record.channels.push_back({"piston", "m", std::move(piston)});
  record.channels.push_back({"engine", "rad", std::move(engine)});
  return record;
}

/// Locks the actuator of an axis: a piston of the largest mass and damping on a valve without flow.
template <class Parameters>
Parameters locked(Parameters parameters) {
  for (const auto& field : model::Actuator<double>::fields()) {
    if (field.name == "piston_mass" || field.name == "piston_damping") {
      parameters.actuator.*field.member = field.upper;
    }
  }
  parameters.servovalve.rated_flow = 1e-6;
  return parameters;
}

/// Uncommanded rows of a model of several axes.
Record silence(const std::string& axis, double seconds) {
  return command_record(std::vector<double>(static_cast<std::size_t>(seconds / kPeriod), 0.0), channel_of("command", axis));
}

/// Angular momentum of a white torque after each row [N m s]: of one-sided density D the variance is D / 2 * period.
class RandomTorque {
 public:
  explicit RandomTorque(const Quiescence& ambient)
      : size_(std::sqrt(0.5 * ambient.torque_density * kPeriod)), normal_(ambient.seed) {}

  double operator()() { return size_ * normal_(); }

 private:
  double size_;
  Normal normal_;
};

Record hammer_direct(const DirectParameters& parameters, const Hammer& blow) {
  using Mass = model::Direct<double>;
  const int steps = model::steps_per_period<Mass>(parameters, kPeriod);
  const Mass plant(parameters, kPeriod / steps);
  auto state = plant.moving(0.0, blow.impulse / parameters.mass.inertia, 0.0);
  const std::vector<double> none(static_cast<std::size_t>(blow.seconds / kPeriod), 0.0);
  Record record = command_record(none, "force");
  for (const std::string_view channel : Mass::channels) {
    record.channels.push_back({std::string(channel), "", {}});
  }
  const bool finite = run(plant, none, state, steps, [&](std::size_t, const auto& readings) {
    for (std::size_t channel = 0; channel < readings.size(); ++channel) {
      record.channels[channel + 1].values.push_back(readings[channel]);
    }
  });
  if (!finite) {
    throw FileError("the model runs away after the blow: its parameters make it unstable");
  }
  return record;
}

}  // namespace

Record hammer(const ModelFile& model, const Hammer& blow) {
  if (const auto* direct = std::get_if<DirectParameters>(&model.parameters)) {
    return hammer_direct(*direct, blow);
  }
  if (const auto* simplex = std::get_if<SimplexParameters>(&model.parameters)) {
    return run_disturbed(locked(*simplex), blow.seconds, [&](std::size_t row) { return row == 0 ? blow.impulse : 0.0; });
  }
  throw UsageError("a hammer test is for a model of one axis, topology simplex or direct");
}

std::vector<double> swing(const Record& record, const std::string& channel) {
  require_channel(record, channel, "the analysis needs it");
  std::vector<double> values = record.find(channel)->values;
  const double rest = values.front();
  std::for_each(values.begin(), values.end(), [rest](double& value) { value -= rest; });
  return values;
}

Record quiescent(const ModelFile& model, const Quiescence& ambient) {
  const auto* simplex = std::get_if<SimplexParameters>(&model.parameters);
  if (simplex == nullptr) {
    throw UsageError("a quiescent test is for a hydraulic axis, topology simplex");
  }
  RandomTorque torque(ambient);
  return run_disturbed(*simplex, ambient.seconds, [&](std::size_t) { return torque(); });
}

Record hammer(const VehicleFile& model, const std::string& axis, const Hammer& blow) {
  const std::size_t hit = axis_index(model, axis);
  VehicleFile held = model;
  std::visit(
      [](auto& parameters) {
        for (auto& own : parameters.axes) {
          own = locked(own);
        }
      },
      held.parameters);
  const Record inputs = silence(axis, blow.seconds);
  VehicleRun run;
  run.impulses.assign(hit + 1, std::vector<double>(inputs.rows, 0.0));
  run.impulses[hit][0] = blow.impulse;
  return simulate(held, inputs, run);
}

Record quiescent(const VehicleFile& model, const std::string& axis, const Quiescence& ambient) {
  axis_index(model, axis);
  const Record inputs = silence(axis, ambient.seconds);
  const std::size_t axes = std::visit([](const auto& parameters) { return parameters.axes.size(); }, model.parameters);
  VehicleRun run;
  run.seed = ambient.seed;
  run.impulses.assign(axes, std::vector<double>(inputs.rows));
  RandomTorque torque(ambient);
  for (std::vector<double>& own : run.impulses) {
    std::generate(own.begin(), own.end(), std::ref(torque));
  }
  return simulate(model, inputs, run);
}

}  // namespace hotfire::trials
