// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/structure/mode_table.hpp"
#include "tools/structure/vehicle_file.hpp"
#include "tools/trials/stiffness.hpp"

namespace hotfire::response {

/// How the actuators of a condition are loaded.
struct Loading {
  double bias = 0.0;       ///< constant load of every actuator [N]
  double amplitude = 0.0;  ///< of the engine's swing about it [rad]
};

/// One axis of a condition.
struct ConditionAxis {
  std::string name;                      ///< "pitch2"
  trials::LoadSpring spring;             ///< with the modal integral in its load stiffness
  trials::ResonanceStiffness stiffness;  ///< equivalent, about the bias [SD eq. 4-7]
  double damping = 0.0;                  ///< D_n, viscous, of the engine [N m s/rad]
};

/// A vehicle in one condition, such as ambient or hot fire: its structure as the plant has it, and its engines on springs.
struct Condition {
  std::string name;
  ModeSet modes;                    ///< of the structure; without modes it has none, and a residual of zero
  std::vector<ConditionAxis> axes;  ///< empty for a mode table alone
  Eigen::VectorXd local;            ///< flexibility of each attach point beside the modes: declared structure, thrust [m/N]
  Eigen::MatrixXd arms;             ///< of the actuators, a row each, about the angles at zero angles [m]
  Eigen::MatrixXd bearing;          ///< motion along the actuators per force of them: translation of the gimbals [m/N]
};

/// Reads a model of several axes (.toml), or a mode table (.csv), which has no engines. Throws FileError as load_vehicle and
/// load_modes do, and for a model of one axis.
Condition load_condition(const std::filesystem::path& path, const Loading& loading);

/// Displacement of every port per force on every port: the modes, and what is local to each attach point; without engines.
Eigen::MatrixXcd structure_response(const Condition& condition, double frequency);

/// How far the ends of each actuator move apart, and the engines turn, per force that pushes the ends of one apart, a column
/// a force, with every actuator as its equivalent spring on a piston at rest, and the engines on their gimbals [SD
/// fig. 2]. Friction is left out. The equations are those of physics.md section 2, linear, at zero angles:
///   (J s^2 + D s + K_n) beta - (D s + K_n) theta = A^T F,   (w, theta) = X (F, T),   T = (D s + K_n) (beta - theta),
///   q = A beta + w + B F,   F = E - K_act q,
/// E being the force from outside, q the motion, A the arms, X the modes and B what is local and in the bearing. A piston
/// that moves by x is a force K_act x.
struct ActuatorResponse {
  Eigen::MatrixXcd motion;  ///< q of each actuator [m/N]
  Eigen::MatrixXcd angle;   ///< beta of each axis [rad/N]
};
ActuatorResponse actuator_response(const Condition& condition, double frequency);

/// The load stiffness of an axis by the modal integral up to each mode's frequency: 1 / (what is local + residual + modes up
/// to there) [N/m]. Its last value is the condition's.
struct StiffnessByFrequency {
  std::vector<double> frequency;  ///< [Hz]; 0 without any mode, then rising
  std::vector<double> stiffness;
};
StiffnessByFrequency load_stiffness_by_frequency(const Condition& condition, int axis);

}  // namespace hotfire::response
