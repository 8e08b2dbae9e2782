// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// Continuous states of a hydraulic axis, in the order of model::AxisStates.
inline constexpr int kFlowStates = 8;
/// Those that channels read.
inline constexpr std::array<int, 3> kReadState{model::AxisStates::kPiston, model::AxisStates::kAngle,
                                               model::AxisStates::kPressure};
/// Places at which something may act on them that no combination of the others replaces: torque motor, oil, piston, load
/// spring and engine.
inline constexpr int kPorts = 5;
enum class Port { torque_motor, oil, piston, spring, engine };

using StateSet = Eigen::Array<bool, kFlowStates, 1>;

/// From one row of a record to the next, along a simulation: deviation+ = transition deviation + response input, with the
/// input of every port held over the row. Both without unit: states and inputs over `FlowScales`.
struct RowFlow {
  Eigen::Matrix<double, kFlowStates, kFlowStates> transition;
  Eigen::Matrix<double, kFlowStates, kPorts> response;
  StateSet forgets = StateSet::Constant(false);  ///< states that it leaves unknown

  /// Forgets states. True if one of them was remembered before.
  bool forget(const StateSet& states);
};

/// Sizes of states and inputs, all from the declared model: supply pressure, full flow, and what full opening does.
struct FlowScales {
  Eigen::Matrix<double, kFlowStates, 1> state;
  Eigen::Matrix<double, kPorts, 1> input;
  std::array<double, 3> reading{};  ///< by channel
  double time = 0.0;                ///< time constant of the position servo [s]
};

FlowScales flow_scales(const model::Simplex<double>::Parameters& parameters);

/// The flow along one experiment, and the simulation that it is linear about.
struct Flow {
  std::vector<RowFlow> rows;                                  ///< from every row to the next
  std::vector<Eigen::Matrix<double, kFlowStates, 1>> states;  ///< simulated, in SI units, a row each
  std::vector<double> piston_command;                         ///< R beta_c after the effects of the command [m], a row each
};

/// The flow of every experiment along its simulation under `parameters`, by narrow difference quotients; what effects
/// remember is held at what it is there. Empty if a state did not stay finite.
std::vector<Flow> linear_flow(const Dataset& data, const model::Simplex<double>::Parameters& parameters,
                              const FlowScales& scales, Resolution resolution, unsigned threads);

}  // namespace hotfire::explain
