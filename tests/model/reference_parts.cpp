#include "tests/model/reference_parts.hpp"

#include <limits>

namespace hotfire::test {
namespace {

/// Deflection of actuator and load in series under a force F >= 0.
double soft_deflection(const ReferenceAxis& axis, double force) {
  const double k = axis.actuator_stiffness;
  const double low = axis.low_stiffness;
  const double scale = axis.load_scale;
  double own = 0.0;
  if (axis.soft == ReferenceAxis::Soft::compliance) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * -std::expm1(-force / scale);
  } else if (axis.soft == ReferenceAxis::Soft::stiffness) {
    own = scale / k * std::log((k * std::exp(force / scale) - (k - low)) / low);
  } else if (axis.soft == ReferenceAxis::Soft::saturation) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * std::tanh(force / scale);
  } else {
    for (std::size_t i = 0; i < axis.stiffness_table.size(); ++i) {
      const bool last = i + 1 == axis.stiffness_table.size();
      const double from = axis.stiffness_table[i][0];
      const double to = last ? std::numeric_limits<double>::infinity() : axis.stiffness_table[i + 1][0];
      const double here = 1.0 / axis.stiffness_table[i][1];
      const double next = last ? here : 1.0 / axis.stiffness_table[i + 1][1];
      own += std::clamp(force - from, 0.0, to - from) * 0.5 * (here + next);
    }
  }
  return own + force / axis.load_stiffness;
}

}  // namespace

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

double reference_spring_force(const ReferenceAxis& axis, double deflection) {
  const double total = 1.0 / (1.0 / axis.actuator_stiffness + 1.0 / axis.load_stiffness);
  const double played = beyond(deflection, axis.backlash);
  if (axis.soft == ReferenceAxis::Soft::none) {
    return total * played;
  }
  // Bisection: the force lies between none and that of the stiff branch.
  const double wanted = std::abs(played);
  double low = 0.0;
  double high = total * wanted;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) {
      break;
    }
    (soft_deflection(axis, middle) < wanted ? low : high) = middle;
  }
  return sign(played) * high;
}

}  // namespace hotfire::test
