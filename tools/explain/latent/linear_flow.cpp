// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/linear_flow.hpp"

#include <ceres/jet.h>

#include <array>
#include <atomic>
#include <memory>
#include <tuple>
#include <type_traits>

#include "model/numerics/delay_line.hpp"
#include "model/numerics/members.hpp"
#include "model/numerics/memory.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/experiment_run.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire::explain {

namespace {

/// A lane for every state and every port.
using FlowDual = ceres::Jet<double, kFlowStates + kPorts>;
using PlainPlant = model::Simplex<double>;
using DualPlant = model::Simplex<FlowDual>;

/// Inputs of the model at the ports, in their order.
constexpr std::array kPortInput{DualPlant::kValveCommand, DualPlant::kFlow, DualPlant::kPistonForce, DualPlant::kSpringForce,
                                DualPlant::kEngineTorque};

/// The plant with an input of size zero at every port, of which it carries the derivative.
class PortedPlant : public DualPlant {
 public:
  PortedPlant(const Parameters& parameters, double h, const FlowScales& scales) : DualPlant(parameters, h) {
    for (int port = 0; port < kPorts; ++port) {
      for (int i = 0; i < kFlowStates; ++i) {
        response_(i, port) = input_response()(i, kPortInput[static_cast<std::size_t>(port)]).a * scales.input(port);
      }
    }
  }

  template <class... Around>
  void step(State& state, const FlowDual& command, const Around&... around) const noexcept {
    DualPlant::step(state, command, around...);
    respond(state);
  }

  /// Of a step that is taken pass by pass.
  void finish(State& state, const Advance& advance) const noexcept {
    DualPlant::finish(state, advance);
    respond(state);
  }

 private:
  void respond(State& state) const noexcept {
    for (int i = 0; i < kFlowStates; ++i) {
      state.y(i).v.template tail<kPorts>() += response_.row(i).transpose();
    }
  }

  Eigen::Matrix<double, kFlowStates, kPorts> response_;
};

/// Drops the derivatives of what an effect remembers, member by member: they are with respect to a row that is past.
template <class T>
void forget_slopes(T& member);

/// A delay of the command or of a reading: no state of the plant acts on itself through one.
template <std::size_t kCapacity>
void forget_slopes(model::DelayLine<FlowDual, kCapacity>& /*line*/) {}

void forget_slopes(model::MemoryState<FlowDual>& memory) {
  memory = model::MemoryState<FlowDual>(model::MemoryState<double>(memory));
}

template <class T, std::size_t kSize>
void forget_slopes(std::array<T, kSize>& members) {
  for (T& member : members) {
    forget_slopes(member);
  }
}

template <class T>
void forget_slopes(T& member) {
  if constexpr (std::is_same_v<T, FlowDual>) {
    member.v.setZero();
  } else if constexpr (!std::is_arithmetic_v<T>) {
    static_assert(std::is_aggregate_v<T>);  // another type gets an overload above
    std::apply([](auto&... members) { (forget_slopes(members), ...); }, model::tied(member));
  }
}

/// The same of all effects that act.
template <class Parameters, class List>
void forget_slopes(const Parameters& effects, model::EffectStates<FlowDual, List>& states) {
  List::for_each([&]<class E, std::size_t I>() {
    if (effects.active[I]) {
      forget_slopes(std::get<I>(states.values));
    }
  });
  forget_slopes(states.outputs);
}

/// Reads the flow of the row that ends off the state, and starts that of the next.
RowFlow take_flow(const PortedPlant& plant, DualPlant::State& state, const FlowScales& scales) {
  RowFlow flow;
  for (int i = 0; i < kFlowStates; ++i) {
    for (int j = 0; j < kFlowStates; ++j) {
      flow.transition(i, j) = state.y(i).v(j) / scales.state(i);
    }
    for (int port = 0; port < kPorts; ++port) {
      flow.response(i, port) = state.y(i).v(kFlowStates + port) / scales.state(i);
    }
    state.y(i).v.setZero();
    state.y(i).v(i) = scales.state(i);
  }
  for (int i = 0; i < state.inputs.size(); ++i) {
    state.inputs(i).v.setZero();
  }
  state.spring_force.v.setZero();
  state.built_up.v.setZero();
  forget_slopes(plant.parameters().effects, state.effects);
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
                              unsigned threads) {
  std::vector<Flow> flows(data.experiments.size());
  std::atomic<bool> finite{true};
  parallel_for(data.experiments.size(), threads, [&](std::size_t e) {
    const Experiment& experiment = data.experiments[e];
    const int fine = model::steps_per_period<PlainPlant>(parameters, experiment.period);
    const int steps = (fine + 1) / 2;
    const PortedPlant plant(with_scalar<DualPlant::Parameters>(parameters), experiment.period / steps, scales);
    const auto start = start_of<FlowDual>(data, e, {}, [](std::size_t) { return FlowDual(0.0); });
    auto state = std::make_unique<DualPlant::State>(initial_state(plant, data, experiment, start));
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
        flows[e].states.back()(i) = state->y(i).a;
      }
      flows[e].piston_command.push_back(state->inputs(DualPlant::kCommand).a);
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
