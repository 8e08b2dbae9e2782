// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/study/reference/reference_equations.hpp"

namespace hotfire::test {

using study::ReferenceAxis;

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

/// Derivatives of spool, load pressure and washout under a valve command.
void reference_hydraulics(const ReferenceAxis& axis, double valve_command, const double* y, double* derivative);

}  // namespace hotfire::test
