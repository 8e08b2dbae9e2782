// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/linear_flow.hpp"

#include <array>
#include <atomic>
#include <memory>
#include <tuple>
#include <type_traits>

#include "model/numerics/delay_line.hpp"
#include "model/numerics/members.hpp"
#include "model/numerics/memory.hpp"
#include "model/numerics/perturbed.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/experiment_run.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire::explain {

namespace {

/// A run beside those with each state and each port changed, and as many more as fill the registers.
using FlowNumber = model::Perturbed<16>;
static_assert(kFlowStates + kPorts <= FlowNumber::kChanges);
/// Change of a state or a port over its scale, for a difference quotient: far below where a flow bends, and so far above
/// what a run rounds by that the quotient is off by 1e-9 of itself.
constexpr double kChange = 1e-6;
using PlainPlant = model::Simplex<double>;
using ChangedPlant = model::Simplex<FlowNumber>;

/// Inputs of the model at the ports, in their order.
constexpr std::array kPortInput{ChangedPlant::kValveCommand, ChangedPlant::kFlow, ChangedPlant::kPistonForce,
                                ChangedPlant::kSpringForce, ChangedPlant::kEngineTorque};

/// The plant beside those with a changed input at one port each.
class PortedPlant : public ChangedPlant {
 public:
  PortedPlant(const Parameters& parameters, double h, const FlowScales& scales) : ChangedPlant(parameters, h) {
    for (int i = 0; i < kFlowStates; ++i) {
      response_(i) = FlowNumber(0.0);
      for (int port = 0; port < kPorts; ++port) {
        const double response = input_response()(i, kPortInput[static_cast<std::size_t>(port)]).value();
        response_(i).set_changed(kFlowStates + port, kChange * response * scales.input(port));
      }
    }
  }

  template <class... Around>
  void step(State& state, const FlowNumber& command, const Around&... around) const noexcept {
    ChangedPlant::step(state, command, around...);
    respond(state);
  }

  /// Of a step that is taken pass by pass.
  void finish(State& state, const Advance& advance) const noexcept {
    ChangedPlant::finish(state, advance);
    respond(state);
  }

 private:
  void respond(State& state) const noexcept { state.y += response_; }

  Eigen::Matrix<FlowNumber, kFlowStates, 1> response_;  ///< of the changed inputs in one step
};

/// Drops the changes of what an effect remembers, member by member: they are of a row that is past.
template <class T>
void forget_changes(T& member);

/// A delay of the command or of a reading: no state of the plant acts on itself through one.
template <std::size_t kCapacity>
void forget_changes(model::DelayLine<FlowNumber, kCapacity>& /*line*/) {}

void forget_changes(model::MemoryState<FlowNumber>& memory) {
  memory = model::MemoryState<FlowNumber>(model::MemoryState<double>(memory));
}

template <class T, std::size_t kSize>
void forget_changes(std::array<T, kSize>& members) {
  for (T& member : members) {
    forget_changes(member);
  }
}

template <class T>
void forget_changes(T& member) {
  if constexpr (std::is_same_v<T, FlowNumber>) {
    member = FlowNumber(member.value());
  } else if constexpr (!std::is_arithmetic_v<T>) {
    static_assert(std::is_aggregate_v<T>);  // another type gets an overload above
    std::apply([](auto&... members) { (forget_changes(members), ...); }, model::tied(member));
  }
}

/// The same of all effects that act.
template <class Parameters, class List>
void forget_changes(const Parameters& effects, model::EffectStates<FlowNumber, List>& states) {
  List::for_each([&]<class E, std::size_t I>() {
    if (effects.active[I]) {
      forget_changes(std::get<I>(states.values));
    }
  });
  forget_changes(states.outputs);
}

/// Reads the flow of the row that ends off the state, and starts that of the next.
RowFlow take_flow(const PortedPlant& plant, ChangedPlant::State& state, const FlowScales& scales) {
  RowFlow flow;
  for (int i = 0; i < kFlowStates; ++i) {
    const double value = state.y(i).value();
    const double per_change = 1.0 / (kChange * scales.state(i));
    for (int j = 0; j < kFlowStates; ++j) {
      flow.transition(i, j) = (state.y(i).changed(j) - value) * per_change;
    }
    for (int port = 0; port < kPorts; ++port) {
      flow.response(i, port) = (state.y(i).changed(kFlowStates + port) - value) * per_change;
    }
    state.y(i) = FlowNumber(value);
    state.y(i).set_changed(i, value + kChange * scales.state(i));
  }
  for (int i = 0; i < state.inputs.size(); ++i) {
    forget_changes(state.inputs(i));
  }
  forget_changes(state.spring_force);
  forget_changes(state.built_up);
  forget_changes(plant.parameters().effects, state.effects);
  return flow;
}

}  // namespace

bool RowFlow::forget(const StateSet& states) {
  bool is_new = false;
  for (int i = 0; i < kFlowStates; ++i) {
    if (states(i) && !forgets(i)) {
      is_new = true;
      forgets(i) = true;
      transition.row(i).setZero();
      response.row(i).setZero();
    }
  }
  return is_new;
}

FlowScales flow_scales(const PlainPlant::Parameters& parameters) {
  const auto& valve = parameters.servovalve;
  const auto& actuator = parameters.actuator;
  const double speed = valve.rated_flow / actuator.piston_area;
  const double stroke = 1.0 / valve.position_gain;
  const double force = actuator.piston_area * actuator.supply_pressure;
  FlowScales scales;
  scales.time = stroke / speed;
  scales.state << 1.0, valve.natural_frequency, actuator.supply_pressure, actuator.supply_pressure, stroke, speed,
      stroke / actuator.moment_arm, speed / actuator.moment_arm;
  scales.input << 1.0, valve.rated_flow, force, force, force * actuator.moment_arm;
  scales.reading = {stroke, stroke / actuator.moment_arm, actuator.supply_pressure};
  return scales;
}

std::vector<Flow> linear_flow(const Dataset& data, const PlainPlant::Parameters& parameters, const FlowScales& scales,
                              Resolution resolution, unsigned threads) {
  std::vector<Flow> flows(data.experiments.size());
  std::atomic<bool> finite{true};
  parallel_for(data.experiments.size(), threads, [&](std::size_t e) {
    const Experiment& experiment = data.experiments[e];
    const int steps = steps_at(resolution, model::steps_per_period<PlainPlant>(parameters, experiment.period));
    const PortedPlant plant(with_scalar<ChangedPlant::Parameters>(parameters), experiment.period / steps, scales);
    const auto start = start_of<FlowNumber>(data, e, {}, [](std::size_t) { return FlowNumber(0.0); });
    auto state = std::make_unique<ChangedPlant::State>(initial_state(plant, data, experiment, start));
    flows[e].rows.reserve(experiment.rows());
    flows[e].states.reserve(experiment.rows());
    flows[e].piston_command.reserve(experiment.rows());
    const auto sink = [&](std::size_t row, const auto&) {
      const RowFlow flow = take_flow(plant, *state, scales);
      if (row > 0) {
        flows[e].rows.push_back(flow);
      }
      flows[e].states.emplace_back();
      for (int i = 0; i < kFlowStates; ++i) {
        flows[e].states.back()(i) = state->y(i).value();
      }
      flows[e].piston_command.push_back(state->inputs(ChangedPlant::kCommand).value());
      finite = finite && flow.transition.allFinite() && flow.response.allFinite();
    };
    if (!run_experiment(plant, data, experiment, *state, steps, sink)) {
      finite = false;
    }
  });
  if (!finite) {
    flows.clear();
  }
  return flows;
}

}  // namespace hotfire::explain
