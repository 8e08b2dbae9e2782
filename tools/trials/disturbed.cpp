#include "tools/trials/disturbed.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "model/step_size.hpp"
#include "tools/files/error.hpp"
#include "tools/simulate/run.hpp"
#include "tools/trials/profiles.hpp"

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

SimplexParameters locked(SimplexParameters parameters) {
  for (const auto& field : model::Actuator<double>::fields()) {
    if (field.name == "piston_mass" || field.name == "piston_damping") {
      parameters.actuator.*field.member = field.upper;
    }
  }
  parameters.servovalve.rated_flow = 1e-6;
  return parameters;
}

Record hammer_direct(const DirectParameters& parameters, const Hammer& blow) {
  using Mass = model::Direct<double>;
  const int steps = model::steps_per_period(kPeriod);
  const Mass plant(parameters, kPeriod / steps);
  auto state = plant.moving(0.0, blow.impulse / parameters.mass.inertia);
  const std::vector<double> none(static_cast<std::size_t>(blow.seconds / kPeriod), 0.0);
  Record record = command_record(none, "force");
  std::vector<double> position;
  const bool finite =
      run(plant, none, state, steps, [&](std::size_t, const auto& readings) { position.push_back(readings[0]); });
  if (!finite) {
    throw FileError("the model runs away after the blow: its parameters make it unstable");
  }
  record.channels.push_back({"position", "", std::move(position)});
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

Record quiescent(const ModelFile& model, const Quiescence& ambient) {
  const auto* simplex = std::get_if<SimplexParameters>(&model.parameters);
  if (simplex == nullptr) {
    throw UsageError("a quiescent test is for a hydraulic axis, topology simplex");
  }
  // A white torque of one-sided density D has impulses of variance D / 2 * period.
  const double size = std::sqrt(0.5 * ambient.torque_density * kPeriod);
  std::mt19937 random(ambient.seed);
  const auto uniform = [&random] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  return run_disturbed(*simplex, ambient.seconds, [&](std::size_t) {
    // Box and Muller, so that every machine has the same impulses.
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return size * radius * std::cos(2.0 * std::numbers::pi * uniform());
  });
}

}  // namespace hotfire::trials
