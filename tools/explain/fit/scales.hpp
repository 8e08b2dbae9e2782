// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/data/plants.hpp"

namespace hotfire::explain {

/// Sizes by which fields are scaled. Of `direct`, whose units follow the record's own: of the quantities in the record. Of a
/// hydraulic axis: of the declared rig over those of the reference axis, for which fields have their typical values.
struct Scales {
  double force = 1.0;
  double position = 1.0;
  double time = 1.0;
  double metre = 1.0;
  double second = 1.0;
  double pascal = 1.0;
  double command = 1.0;
};

/// Of a `direct` mass: rms force, rms position about its mean, and rms position over rms velocity, of all experiments
/// together. Of a joint or an electromechanical actuator the same, of the motion and the force that its model predicts, and
/// the rms command of its motor. Of a hydraulic axis: stroke of full opening 1 / K_e, the time A / (Q_r K_e) in which the
/// servo makes it, and the supply pressure.
Scales scales_of(const ModelParameters& declared, const Dataset& data);

/// Time constant of the position loop [s], A / (Q_r K_e).
double servo_time(const SimplexParameters& declared);

/// The size of a unit that is a product of powers of force, position, time, command, m, s, Hz, Pa, N, kg, rad and 1, such as
/// "force.time/position^2"; 1 for any other.
double size_of_unit(std::string_view unit, const Scales& scales);

/// The motion across the joint of a structure in modal coordinates by row, as its model predicts it: no sensor reads it.
struct JointMotion {
  std::vector<double> position;
  std::vector<double> rate;
};

JointMotion joint_motion(const Dataset& data, const Experiment& experiment, const ModalParameters& parameters);

/// What moves the load of an electromechanical actuator by row, as its model predicts it: a record may have its motor only.
struct LoadMotion {
  std::vector<double> position;
  std::vector<double> rate;
  std::vector<double> force;    ///< of the motor, counted at the load
  std::vector<double> command;  ///< of the motor
  std::vector<double> twist;    ///< of the transmission
};

LoadMotion load_motion(const Dataset& data, const Experiment& experiment, const ElectromechanicalParameters& parameters);

}  // namespace hotfire::explain
