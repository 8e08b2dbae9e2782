#pragma once

#include <algorithm>
#include <cmath>

#include "tests/model/reference_axis.hpp"

namespace hotfire::test {

/// The equations of physics.md section 1 that the references of one axis and of two have in common.

/// States of one hydraulic axis, in the order in which a reference keeps them.
enum ReferenceState {
  kReferenceSpool,
  kReferenceSpoolRate,
  kReferencePressure,
  kReferenceWashout,
  kReferencePiston,
  kReferencePistonRate,
  kReferenceAngle,
  kReferenceAngleRate,
  kReferenceStates
};

inline double clamp_to(double x, double limit) { return std::clamp(x, -limit, limit); }
inline double sign(double x) { return (x > 0.0) - (x < 0.0); }
inline double beyond(double x, double limit) { return x - clamp_to(x, limit); }

inline double stribeck(double level, double ratio, double at, double v) {
  return level * (1.0 + (ratio - 1.0) * std::exp(-(v / at) * (v / at)));
}

/// Derivatives of spool, load pressure and washout under a valve command.
void reference_hydraulics(const ReferenceAxis& axis, double valve_command, const double* y, double* derivative);

/// Force of the load spring, with play and softness, at a deflection.
double reference_spring_force(const ReferenceAxis& axis, double deflection);

}  // namespace hotfire::test
