#pragma once

#include <array>
#include <limits>
#include <vector>

namespace hotfire::test {

/// One hydraulic axis with effects, written from physics.md alone and integrated by SUNDIALS CVODE: what the model is judged
/// by. Nothing of model/ is used here. A zero, or an infinite limit, means that the effect is absent.
struct ReferenceAxis {
  // Declared, physics.md section 1.
  double rated_flow = 3.155e-3;
  double valve_frequency = 377.0;
  double valve_damping = 0.8;
  double position_gain = 86.2;
  double pressure_gain = 1e-7;
  double pressure_corner = 6.283;
  double area = 0.0160;
  double supply = 20.684e6;
  double bulk_modulus = 1.034e9;
  double volume = 4.72e-3;
  double leakage = 2e-12;
  double piston_mass = 50.0;
  double piston_damping = 2e4;
  double actuator_stiffness = 1.2e8;
  double arm = 0.7544;
  double load_stiffness = 5.75e7;
  double inertia = 9490.0;
  double damping = 1.2e4;
  double duct_stiffness = 4e5;

  // Command path.
  double delay = 0.0;                                           ///< [s]
  double rate_limit = std::numeric_limits<double>::infinity();  ///< [rad/s]

  // Valve and oil.
  double play = 0.0;      ///< half-width between valve command and spool
  double deadband = 0.0;  ///< half-width
  double asymmetry = 0.0;
  double laminar_leak = 0.0;
  double orifice_leak = 0.0;

  // Elastic, then slipping, friction: the seal of the piston [N], and a stiff stand-in for rigid Coulomb friction [N m].
  struct Slip {
    double level = 0.0;
    double stiffness = 0.0;
    double static_ratio = 1.0;
    double stribeck = 1.0;
    double gives_way = 1e8;  ///< rate at which it yields beyond its level [1/s]: v / gives_way is the excess stretch
  };
  Slip seal;
  Slip coulomb;

  /// Bristle, physics.md section 3; Dahl with ratio 1 and no damping.
  struct Bristle {
    double level = 0.0;
    double stiffness = 0.0;
    double static_ratio = 1.0;
    double stribeck = 1.0;
    double damping = 0.0;
    double damping_dies_at = 1.0;  ///< v_d [rad/s]
  };
  Bristle bristle;       ///< of the gimbal
  Bristle seal_bristle;  ///< of the piston

  // Load spring.
  double backlash = 0.0;  ///< half-width [m]
  double arm_linear = 0.0;
  double arm_quadratic = 0.0;
  enum class Soft { none, compliance, stiffness, saturation, table };
  Soft soft = Soft::none;
  double low_stiffness = 0.0;
  double load_scale = 1.0;
  std::vector<std::array<double, 2>> stiffness_table;  ///< load, tangent stiffness

  // Structure and engine.
  double mode_frequency = 0.0;  ///< [Hz]
  double mode_damping = 0.0;
  double mode_shape = 0.0;
  double duct_cubic = 0.0;
  double torque_offset = 0.0;
};

/// Piston [m], engine [rad] and load pressure [Pa] at the end of each sample of `sample` seconds, the commands [rad] held
/// between samples. Starts at rest under a zero command, and waits `settling` seconds before the first sample.
/// CVODE (BDF) with a relative tolerance of 1e-10, started afresh at every edge of the command. Throws std::runtime_error if
/// CVODE gives up.
std::vector<std::array<double, 3>> integrate_reference(const ReferenceAxis& axis, const std::vector<double>& commands,
                                                       double sample, double settling);

}  // namespace hotfire::test
