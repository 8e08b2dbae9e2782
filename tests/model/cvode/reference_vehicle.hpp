// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::test {

using study::ReferenceAxis;

/// Engines with two hydraulic axes each on compliant bearings and one modal structure, written from physics.md sections 1 to
/// 3 alone, by vector mechanics: what the model is judged by. Nothing of model/ is used here.
struct ReferenceVehicle {
  using Vector = Eigen::Vector3d;
  using Pair = Eigen::Vector2d;

  /// One bristle vector over both angles. Its sliding level is level + coefficient radius |N|.
  struct Friction {
    double level = 0.0;  ///< [N m]
    double coefficient = 0.0;
    double radius = 0.13;  ///< [m]
    double stiffness = 0.0;
    double static_ratio = 1.0;
    double stribeck = 1.0;
    double damping = 0.0;
    double vibration_ratio = 1.0;     ///< gamma2 at rated thrust
    double vibration_velocity = 1.0;  ///< v_s2 [rad/s]
    double viscous = 0.0;             ///< sigma2 [N m s/rad]
    double exponent = 1.0;            ///< of Dahl's law, without a static ratio and damping
  };

  struct Engine {
    std::array<ReferenceAxis, 2> axes;  ///< pitch, yaw: declared values, dead band, softness and torque from the
                                        ///< other axis, and nothing else
    bool declared_arms = false;         ///< `arm` of the axes at any angle: the attach points are not read
    std::array<Vector, 2> on_engine;    ///< attach points at zero angles, from the gimbal's centre
    std::array<Vector, 2> on_vehicle;
    double thrust = 0.0;               ///< declared [N]
    double rated_thrust = 0.0;         ///< at which gamma2 and the attach points are as declared; 0: at any
    double dead_load = 0.0;            ///< along the thrust [N]
    Pair misalignment = Pair::Zero();  ///< arms of the thrust against positive angles [m]
    double unloaded_structure = 1.0;   ///< stiffness of the attach points without thrust, over that under rated thrust
    double loss_time = 1e-3;
    Eigen::Matrix<double, 6, 6> bearing_compliance = Eigen::Matrix<double, 6, 6>::Zero();
    double unloaded_stiffness = 1.0;  ///< of the bearing in translation without load, over that under load
    double seat_scale = 1e5;          ///< load over which it rises [N]
    Friction friction;
    /// Between the halves of the bearing, on the vehicle's half; the friction is between block and engine's half. Zero:
    /// none.
    double block_mass = 0.0;                                                                ///< along x, y, z [kg]
    double block_inertia = 0.0;                                                             ///< about pitch and yaw [kg m^2]
    double vehicle_side = 0.5;                                                              ///< share of the compliance
    Eigen::Matrix<double, 5, 5> block_stiffness = Eigen::Matrix<double, 5, 5>::Identity();  ///< x, y, z, pitch, yaw
  };
  std::vector<Engine> engines;

  /// Shapes of a mode, pitch and yaw of every engine.
  struct Mode {
    double frequency = 0.0;  ///< [Hz]
    double damping = 0.0;
    std::vector<double> attach;
    std::vector<double> rotation;
  };
  std::vector<Mode> modes;

  /// What drives a vehicle over one sample.
  struct Inputs {
    std::vector<double> commands;  ///< of all axes [rad]
    std::vector<double> thrust{};  ///< of all engines, beyond the declared one [N]; empty: none
    std::vector<Vector> force{};   ///< on all engines, at their gimbals' centres [N]; empty: none
    std::vector<double> torque{};  ///< on the engines, towards positive angles of all axes [N m]; empty: none
  };

  /// Where a run starts: of every engine the eight states of both axes and the displacements of bearing and block; the
  /// modes.
  struct Start {
    struct Engine {
      std::array<std::array<double, 8>, 2> axes{};
      std::array<double, 6> bearing{};
      std::array<double, 5> block{};  ///< x, y, z against the vehicle, pitch and yaw in space
    };
    std::vector<Engine> engines;
    std::vector<double> modes;
  };
};

/// Piston and engine of every axis at the end of each sample of `sample` seconds, the inputs held between samples. As
/// `study::integrate_reference`. What it took is added to `evaluations`: evaluations of the equations, without those for
/// CVODE's Jacobian.
std::vector<std::vector<double>> integrate_reference(const ReferenceVehicle& vehicle, const ReferenceVehicle::Start& start,
                                                     const std::vector<ReferenceVehicle::Inputs>& inputs, double sample,
                                                     double tolerance = 1e-10, long* evaluations = nullptr);

}  // namespace hotfire::test
