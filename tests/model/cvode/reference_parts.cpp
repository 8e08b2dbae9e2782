// SPDX-License-Identifier: Apache-2.0
#include "tests/model/cvode/reference_parts.hpp"

#include <algorithm>
#include <cmath>

namespace hotfire::test {

using study::beyond;
using study::sign;
void reference_hydraulics(const ReferenceAxis& axis, double valve_command, const double* y, double* derivative) {
  derivative[kReferenceSpool] = y[kReferenceSpoolRate];
  derivative[kReferenceSpoolRate] = axis.valve_frequency * axis.valve_frequency * (valve_command - y[kReferenceSpool]) -
                                    2.0 * axis.valve_damping * axis.valve_frequency * y[kReferenceSpoolRate];

  const double lapped = beyond(y[kReferenceSpool], axis.deadband);
  const double opening = lapped * (1.0 + axis.asymmetry * sign(lapped));
  const double p = y[kReferencePressure];
  const double turbulent = axis.orifice_leak * p * std::sqrt(axis.supply / (std::abs(p) + 1e-3 * axis.supply));
  const double flow = axis.rated_flow * opening * std::sqrt(std::max(0.0, 1.0 - sign(opening) * p / axis.supply));
  derivative[kReferencePressure] =
      4.0 * axis.bulk_modulus / axis.volume *
      (flow - axis.area * y[kReferencePistonRate] - (axis.leakage + axis.laminar_leak) * p - turbulent);
  derivative[kReferenceWashout] = axis.pressure_corner * (p - y[kReferenceWashout]);
}

}  // namespace hotfire::test
