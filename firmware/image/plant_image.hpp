// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "firmware/plant/declared_faults.hpp"
#include "firmware/plant/recorded_loads.hpp"
#include "model/direct.hpp"
#include "model/electromechanical.hpp"
#include "model/imposed_motion.hpp"
#include "model/modal.hpp"
#include "model/sensors/vehicle_sensors.hpp"
#include "model/simplex.hpp"
#include "model/vehicle.hpp"

namespace hotfire::firmware {

using TaosRig = model::InstrumentedVehicle<model::Taos<double>>;
using MasvRig = model::InstrumentedVehicle<model::Masv<double>>;
using PlantParameters = std::variant<model::Simplex<double>::Parameters, model::Direct<double>::Parameters,
                                     model::ImposedMotion<double>::Parameters, model::Modal<double>::Parameters,
                                     model::Electromechanical<double>::Parameters, TaosRig, MasvRig>;

/// A plant, or why there is none: file, line, key, value and what is allowed.
struct PlantImage {
  std::optional<PlantParameters> parameters;
  std::string error;
  std::vector<PlayedFault> faults{};  ///< that the plant plays
  LoadRecord recorded{};              ///< disturbances that it plays
  std::string text{};                 ///< the image itself
};

/// Reads a plant image: what `hotfire plant` makes of a model file, so that the real-time executable needs no TOML and no
/// units. Text, one `key value` a line, keys as in the model file, SI, numbers usually in hexadecimal floating point so that
/// they arrive bit for bit:
///
///     schema 1
///     topology simplex
///     engine.inertia 0x1.289p+13
///     effects.gimbal_friction.law lugre
///     effects.gimbal_friction.coulomb_torque 0x1.77p+13
///     effects.soft_stiffness.load.0 0x0p+0
///
/// A vehicle has those of its axes, then its engines, sensors, modes and residual flexibility (`model::visit_vehicle_keys`);
/// a column of a matrix is one line, commas between its numbers:
///
///     schema 1
///     topology masv
///     pitch1.engine.inertia 0x1.289p+13
///     yaw4.attach.engine_x -0x1.3333333333333p-2
///     engine1.constant_arms no
///     engine1.gimbal.stiffness1 0x1.dcd65p+30,0x0p+0,0x0p+0,0x0p+0,0x0p+0,0x0p+0
///     modes.count 2
///     mode1.frequency 0x1.0cccccccccccdp+2
///
/// Faults that the plant plays follow, from 0 on, with the keys of their kind:
///
///     fault.0.kind biased
///     fault.0.from 0x1p+1
///     fault.0.to inf
///     fault.0.actuator 0
///     fault.0.channel piston
///     fault.0.value 0x1p-9
///
/// So do the disturbances of a record, each with all its rows in one line:
///
///     disturbance.period 0x1.0624dd2f1a9fcp-10
///     disturbance.rows 2
///     disturbance.0.kind torque
///     disturbance.0.place 1
///     disturbance.0.values 0x1.388p+13,0x1.388p+14
///
/// Every parameter of every part is there, and every parameter of an effect that is active. Strict: an unknown, repeated or
/// missing key, a value that is not a number, NaN or outside its bounds, a table that does not rise, is refused with its
/// line; attach points, a gimbal or an effect whose values contradict each other, with their prefix.
PlantImage read_plant_image(const std::string& path);

/// The same from text; `name` represents the file in messages.
PlantImage parse_plant_image(const std::string& text, const std::string& name);

}  // namespace hotfire::firmware
