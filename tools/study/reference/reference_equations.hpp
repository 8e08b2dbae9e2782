// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::study {

/// The states of the reference axis. Those after the engine's exist only with their effect.
enum ReferenceState {
  kSpool,
  kSpoolRate,
  kPressure,
  kWashout,
  kPiston,
  kPistonRate,
  kAngle,
  kAngleRate,
  kPlay,
  kSeal,
  kBristle,
  kSealBristle,
  kMode,
  kModeRate,
  kPistonReading,
  kEngineReading,
  kSupplyDroop,
  kCreep,
  kJoint,
  kWiper,
  kCommand,
  kWild0,  ///< of a drawn law's memory, `WildMemory::kMostStates` of them
  kWild1,
  kWild2,
  kWild3,
  kStates
};

using StateVector = std::array<double, kStates>;

/// What a state is measured in; tolerances are a tiny part of it.
inline constexpr StateVector kStateScale{0.01, 1.0,  1e6,  1e6, 0.01, 0.1,  0.01, 0.1,  0.01, 1e-5, 1e-4, 1e-5, 0.1,
                                         1.0,  0.01, 0.01, 1e6, 1e-4, 1e-5, 1e-4, 0.01, 1.0,  1.0,  1.0,  1.0};

inline double clamp_to(double x, double limit) { return std::clamp(x, -limit, limit); }
inline double sign(double x) { return (x > 0.0) - (x < 0.0); }
inline double beyond(double x, double limit) { return x - clamp_to(x, limit); }

inline double stribeck(double level, double ratio, double at, double v) {
  return level * (1.0 + (ratio - 1.0) * std::exp(-(v / at) * (v / at)));
}

/// Force of the load spring [N], with play and softness, at a deflection [m].
double spring_force(const ReferenceAxis& axis, double deflection);

/// The states that an axis has, in order.
std::vector<ReferenceState> states_of(const ReferenceAxis& axis);

/// An axis and what drives it in the present interval.
struct ReferenceProblem {
  const ReferenceAxis& axis;
  std::vector<ReferenceState> states;
  double command = 0.0;        ///< what is asked for in this interval [rad]
  double command_start = 0.0;  ///< value of a limited command at its beginning
  double start_time = 0.0;
  double first_row = 0.0;    ///< when the record begins
  double other_angle = 0.0;  ///< of the engine about its other axis; zero for an axis alone
  double other_rate = 0.0;
  WildRows wild_rows{};  ///< what a drawn law keeps of the rows
};

/// The command behind the rate limit.
double command_at(const ReferenceProblem& problem, double t);

/// Valve command of the torque motor at a command [rad], before saturation, `elapsed` s into the record.
double torque_motor(const ReferenceAxis& axis, double command, double elapsed, const StateVector& y);

/// The axis' equations. The states it does not have are zero in `y`, and what comes out for them is not used.
StateVector derivative(const ReferenceProblem& problem, double t, const StateVector& y);

/// What laws are drawn over.
WildQuantities quantities_at(const ReferenceProblem& problem, double t, const StateVector& y);

/// Informs the axis' drawn law that a row begins.
void begin_row(ReferenceProblem& problem, double t, const StateVector& y);

/// What the three channels read.
std::array<double, 3> readings(const ReferenceProblem& problem, double t, const StateVector& y);

}  // namespace hotfire::study
