// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "tools/study/reference/wild_law.hpp"

namespace hotfire::study {

/// One hydraulic axis with effects, written from docs/physics.md alone and integrated by SUNDIALS CVODE: what the model and
/// the finder are judged by. Nothing of model/ is used here. A zero, or an infinite limit, means that the effect is absent.
struct ReferenceAxis {
  // Declared, physics.md section 1.
  double rated_flow = 3.155e-3;
  double valve_frequency = 377.0;
  double valve_damping = 0.8;
  double position_gain = 86.2;
  double position_feedback = 1.0;
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

  /// Elastic, then slipping, friction: the seal of the piston [N].
  struct Slip {
    double level = 0.0;
    double stiffness = 0.0;
    double static_ratio = 1.0;
    double stribeck = 1.0;
    double gives_way = 1e8;  ///< rate at which it yields beyond its level [1/s]: v / gives_way is the excess stretch
  };
  Slip seal;

  /// Rigid friction of the gimbal [N m], as a viscous law that is all but a step: level tanh(speed / creep). In stick it
  /// creeps at less than a few times `creep`, 1e-6 of what a sensor sees in a second.
  struct Coulomb {
    double level = 0.0;
    double creep = 1e-7;  ///< [rad/s]
  };
  Coulomb coulomb;

  /// Bristle, physics.md section 3; Dahl with ratio 1 and no damping.
  struct Bristle {
    double level = 0.0;
    double stiffness = 0.0;
    double static_ratio = 1.0;
    double stribeck = 1.0;
    double damping = 0.0;
    double damping_dies_at = 1.0;     ///< v_d [rad/s]
    double vibration_ratio = 1.0;     ///< gamma2
    double vibration_velocity = 1.0;  ///< v_s2 [rad/s]
  };
  Bristle bristle;                ///< of the gimbal
  Bristle seal_bristle;           ///< of the piston
  double gimbal_stiffness = 0.0;  ///< of a torsional spring in series with a Dahl `bristle` [N m/rad]; 0: none, rigid

  // Load spring.
  double backlash = 0.0;  ///< half-width [m]
  double arm_linear = 0.0;
  double arm_quadratic = 0.0;
  /// The moment arm as the plane geometry has it: an actuator of this length between a fixed point and one on the engine,
  /// both seen from the pivot under `angle`, with the declared arm at zero. Length 0: the law above.
  struct Linkage {
    double length = 0.0;  ///< [m]
    double angle = 0.0;   ///< [rad]
  };
  Linkage linkage;
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
  double cross_stiffness = 0.0;  ///< torque against this axis per angle of the engine about its other axis [N m/rad]
  double cross_damping = 0.0;    ///< ... per rate [N m s/rad]

  /// What a channel reads: x -> x + quadratic x^2 + cubic x^3 + bumps, then a lag.
  struct Bump {
    double at = 0.0;
    double width = 1.0;
    double height = 0.0;
  };
  struct Sensor {
    double lag = 0.0;  ///< [s]
    double quadratic = 0.0;
    double cubic = 0.0;
    std::vector<Bump> bumps;  ///< local wear of a potentiometer's track, height e^{-((x - at) / width)^2}
  };
  Sensor piston_sensor;
  Sensor engine_sensor;

  // In no list of effects.
  struct Unlisted {
    double dead_time = 0.0;    ///< delay per size of the held command [s/rad]
    double command_lag = 0.0;  ///< first-order, of the command [s]
    double null_offset = 0.0;  ///< of the torque motor [1]
    double null_drift = 0.0;   ///< rate of the torque motor's null [1/s], from the first row on
    double gain_drift = 0.0;   ///< opening = x_v (1 + gain_drift t) [1/s], from the first row on
    double slew = std::numeric_limits<double>::infinity();  ///< largest rate of the spool [1/s]
    double relief_from = 0.0;                               ///< load pressure beyond which a valve across it opens [Pa]
    double relief = 0.0;                                    ///< its flow per pressure [m^3/(s Pa)]
    double flow_curvature = 0.0;                            ///< opening = x_v (1 + flow_curvature x_v^2)
    double supply_droop = 0.0;                              ///< supply pressure lost per flow [Pa s/m^3]
    double supply_recovery = 0.0;                           ///< time constant of the supply [s]
    double aeration = 0.0;                                  ///< share of the bulk modulus lost at no load pressure
    double aeration_pressure = 1.0;                         ///< load pressure over which it comes back [Pa]
    double cushion = 0.0;             ///< further piston damping per distance beyond `cushion_from` [N s/m^2]
    double cushion_from = 0.0;        ///< [m]
    double creep_stiffness = 0.0;     ///< of the part of the load spring that creeps [N/m]
    double creep_time = 1.0;          ///< [s]
    double spring_damping = 0.0;      ///< of the load spring, in parallel with it [N s/m]
    double spring_drift = 0.0;        ///< the load spring's force is k d (1 + spring_drift t) [1/s], from the first row on
    Slip joint;                       ///< a joint beside the load spring that sticks, then slips, over the deflection [N]
    double orifice_damping = 0.0;     ///< of the piston, orifice_damping v |v| [N s^2/m^2]
    double friction_growth = 0.0;     ///< the bristle's level is level (1 + friction_growth beta^2) [1/rad^2]
    double friction_drift = 0.0;      ///< ... and level (1 + friction_drift t) [1/s], from the first row on
    double seal_squeeze = 0.0;        ///< the seal's level is level (1 + seal_squeeze |p_L|) [1/Pa]
    double periodic_torque = 0.0;     ///< amplitude of a sine on the engine [N m], from the first row on
    double periodic_frequency = 0.0;  ///< [Hz]
    double hose = 0.0;                ///< torque per angle of the other axis beyond where a hose is taut [N m/rad]
    double hose_slack = 0.0;          ///< that angle [rad]; below it the hose hangs
    double wiper_play = 0.0;          ///< half of the play between the piston and its sensor's wiper [m]
    double hum = 0.0;                 ///< amplitude of a sine that the engine's sensor reads [rad], from the first row on
    double hum_frequency = 0.0;       ///< [Hz]
  };
  Unlisted unlisted;

  /// A law drawn at random; null: none.
  std::shared_ptr<const WildLaw> wild;
};

/// The rows of a reference run: piston [m] and engine [rad] as their sensors read them, load pressure [Pa].
using ReferenceRows = std::vector<std::array<double, 3>>;

/// What a controller makes of a command that is asked for, from the row read last: the command that is sent [rad]. Before
/// the first row it reads zeros.
using Controller = std::function<double(double asked, const std::array<double, 3>& reading)>;

/// What laws may be drawn over, at the end of each row.
using QuantityRows = std::vector<WildQuantities>;

/// Some ten times what an axis takes without a drawn law.
inline constexpr long kMostEvaluations = 2000;

/// Piston, engine and load pressure under `commands` [rad], each held for `sample` seconds. Starts at rest under a zero
/// command, and waits `settling` seconds before the first command. Row i is read at the *end* of the time in which command i
/// is held. CVODE (BDF) with relative tolerance `tolerance`, started afresh at every edge of the command. What it
/// took is added to `evaluations`, without those for CVODE's Jacobian. With a `controller` the axis runs under what that
/// makes of the commands. Throws std::runtime_error if CVODE gives up, or if a drawn law makes the axis so stiff or so
/// restless that it takes more than `kMostEvaluations` evaluations a row.
ReferenceRows integrate_reference(const ReferenceAxis& axis, const std::vector<double>& commands, double sample,
                                  double settling, double tolerance = 1e-10, long* evaluations = nullptr,
                                  const Controller& controller = {}, QuantityRows* quantities = nullptr);

/// The two axes of one engine together, coupled by `cross_stiffness`, `cross_damping` and the hose; otherwise the same. Both
/// have as many commands.
std::array<ReferenceRows, 2> integrate_reference_pair(const std::array<ReferenceAxis, 2>& axes,
                                                      const std::array<std::vector<double>, 2>& commands, double sample,
                                                      double settling, double tolerance = 1e-10,
                                                      long* evaluations = nullptr);

}  // namespace hotfire::study
