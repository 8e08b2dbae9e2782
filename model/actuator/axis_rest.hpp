// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/actuator/axis.hpp"
#include "model/numerics/root.hpp"

namespace hotfire::model {

// Where an axis rests: the members of `Axis` that belong to its set-up.

namespace detail {

inline constexpr double kRestWidth = 1e-6;  ///< m, rad: far below what a sensor sees

}  // namespace detail

template <class S, class List>
template <class Around>
typename Axis<S, List>::State Axis<S, List>::settled(const S& command, const Around& around,
                                                     const std::optional<double>& piston) const {
  State state;
  Signal<S> commanded{command, h_};
  settle<Site::command>(parameters_.effects, state.effects, commanded);
  pass_through<Site::command>(parameters_.effects, acting_, state.effects, commanded, Keep::no);
  state.inputs(kCommand) = parameters_.actuator.moment_arm * commanded.value;
  const auto flow_at = [&](const S& at) {
    state.y(kPiston) = at;
    const auto force_at = [&](const S& angle) { return excess_force(state, angle, around); };
    state.y(kAngle) = root_of_decreasing<S>(at / parameters_.actuator.moment_arm, detail::kRestWidth, force_at);
    excess_force(state, state.y(kAngle), around);
    return net_flow(state, around);
  };
  const S& fed = parameters_.servovalve.position_feedback;
  if (value_of(fed) > 0.0) {
    flow_at(root_of_decreasing<S>(state.inputs(kCommand) / fed, detail::kRestWidth, flow_at));
    if (piston) {
      rest_in_play(state, *piston, flow_at);
    }
  } else {
    flow_at(S(piston.value_or(0.0)));
  }
  evaluate(state, at_rest(state), around, Keep::no);
  const std::array<S, 3> truth{state.y(kPiston), state.y(kAngle), state.y(kPressure)};
  const Surroundings<S> seen = around_state(state, state.y, state.clock.at(h_));
  for (std::size_t channel = 0; channel < truth.size(); ++channel) {
    settle_channel<S, List>(static_cast<int>(channel), parameters_.effects, state.effects,
                            Signal<S>{truth[channel], h_, state.clock.at(h_), S{0.0}, &seen});
  }
  measure(state);
  return state;
}

/// A play in the valve keeps the spool where it is until the valve's command has crossed the play: an axis may rest at any
/// piston position that needs no more. Moves the rest in `state`, which comes from the middle of the play, to where the
/// piston was seen, or to the end of the play on that side.
template <class S, class List>
template <class FlowAt>
void Axis<S, List>::rest_in_play(State& state, double piston, FlowAt&& flow_at) const {
  constexpr double kFar = 2.0;  // valve command: beyond full command and any play
  const auto come_from = [&](const S& before) {
    return model::come_from<Site::valve_command>(parameters_.effects, state.effects, before);
  };
  if (std::abs(piston - value_of(state.y(kPiston))) <= detail::kRestWidth || !come_from(S{-kFar})) {
    return;
  }
  const S seen(piston);
  if (value_of(flow_at(seen)) > 0.0) {  // the spool is as far closed as the play allows, and the piston still extends
    flow_at(root_of_decreasing<S>(seen, detail::kRestWidth, flow_at));
    return;
  }
  come_from(S{kFar});
  if (value_of(flow_at(seen)) < 0.0) {
    flow_at(root_of_decreasing<S>(seen, detail::kRestWidth, flow_at));
    return;
  }
  const auto lost_flow = [&](const S& before) {
    come_from(before);
    return S(-flow_at(seen));
  };
  const S before = root_of_decreasing<S>(torque_motor(state, state.y), detail::kRestWidth, lost_flow);
  lost_flow(before);
}

/// At rest at `angle` and the piston of `state`: the force of the load spring beyond what the engine's torques need [N].
/// Leaves angle, force and the structure's deflection in `state`.
template <class S, class List>
template <class Around>
S Axis<S, List>::excess_force(State& state, const S& angle, const Around& around) const noexcept {
  const auto& effects = parameters_.effects;
  const S nominal = parameters_.actuator.moment_arm;
  state.y(kAngle) = angle;
  const Surroundings<S> seen = around_state(state, state.y, mid_step(state));
  // Keeps what the springs remember of their force, so that the search in them starts near it.
  const Spring<S> still = spring_around(
      around, Spring<S>{state.y(kPiston) - nominal * angle, angle, nominal, nominal, stiffness_,
                        parameters_.actuator.stiffness, parameters_.structure.stiffness, h_, seen.time, &seen});
  settle<Site::load_spring>(effects, state.effects, still);
  Spring<S> geometry = still;
  pass_through<Site::load_spring>(effects, acting_, state.effects, geometry, Keep::yes);
  Motion<S> motion{angle, S{0.0}, S{0.0}, engine_compliance_, h_};
  motion.seen = &seen;
  look_around(around, motion);
  const S torque = sum_over<Site::engine_torque>(effects, acting_, state.effects, motion, Keep::no);
  const S needed = (parameters_.engine.duct_stiffness * angle + torque_around(around, torque)) / geometry.arm;
  state.spring_force = needed;
  settle<Site::structure>(effects, state.effects, AttachPoint<S>{needed, h_});
  evaluate(state, at_rest(state), around, Keep::no);
  return state.spring_force - needed;
}

/// At rest under the load in `state`: what flows into the extend chamber [m^3/s]. Leaves pressure and spool in `state`.
template <class S, class List>
template <class Around>
S Axis<S, List>::net_flow(State& state, const Around& around) const noexcept {
  state.y(kPressure) = (state.spring_force + state.inputs(kPistonForce)) / parameters_.actuator.piston_area;
  state.y(kWashout) = state.y(kPressure);
  evaluate(state, at_rest(state), around, Keep::no);
  state.y(kOpening) = torque_motor(state, state.y) + state.inputs(kValveCommand);
  settle<Site::valve>(parameters_.effects, state.effects, Signal<S>{state.y(kOpening), h_});
  const Surroundings<S> seen = around_state(state, state.y, mid_step(state));
  settle<Site::flow>(parameters_.effects, state.effects,
                     hydraulics(state, state.y(kOpening), state.y(kPressure), seen, Keep::no));
  evaluate(state, at_rest(state), around, Keep::no);
  return parameters_.servovalve.rated_flow * state.y(kOpening) + state.inputs(kFlow) -
         parameters_.actuator.leakage * state.y(kPressure);
}

}  // namespace hotfire::model
