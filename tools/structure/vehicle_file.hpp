// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "model/vehicle.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/rig/fault_file.hpp"
#include "tools/structure/vehicle_sensors.hpp"

namespace hotfire {

using TaosParameters = model::Taos<double>::Parameters;
using MasvParameters = model::Masv<double>::Parameters;

/// What the file of a vehicle says about the values of one axis; keys are those of a file with one axis (`ModelFile`).
struct AxisDeclaration {
  std::map<std::string, double> noise;      ///< rms by channel ("piston"); absent: estimated
  std::map<std::string, double> tolerance;  ///< relative one-sigma by key ("engine.inertia"); absent: exact
  std::vector<std::string> left_out;        ///< declared parameters that the file does not give
};

/// A model of several axes as its TOML file declares it, in SI.
struct VehicleFile {
  std::filesystem::path path;
  std::string name;
  std::variant<TaosParameters, MasvParameters> parameters;
  VehicleSensors sensors;               ///< what a simulation reads through
  std::vector<AxisDeclaration> axes{};  ///< in the order of `axis_names`
  std::filesystem::path modes_table{};  ///< where the modes come from; empty if there are none
};

/// True for a TOML file whose topology is that of several axes, "taos" or "masv". Throws FileError if it cannot be read.
bool is_vehicle(const std::filesystem::path& path);

/// The same of the text of a model file; `path` represents the file in messages.
bool is_vehicle(std::string text, const std::filesystem::path& path);

/// Reads and checks a model file of several axes (contract.md). The parts and effects of `[servovalve]`, `[actuator]`,
/// `[structure]`, `[engine]` and `[effects.NAME]` are those of every axis; `[actuator.pitch]` is what differs on the pitch
/// axes and `[actuator.pitch2]` on that of engine 2. So do `[effects.NAME.pitch]` and `[sensors.pitch]`; an effect that has
/// tables of axes only is active on these alone. A tolerance is that of every axis, `engine.inertia`, or of one,
/// `engine.pitch.inertia`.
///
/// `[attach.pitch]` and `[attach.pitch2]` are attach points in space; in a file without `[attach]` the arms are the declared
/// `actuator.moment_arm` at any angle. `[gimbal]` with `[gimbal.friction]`, `[gimbal.vibration]` and `stiffness`, a 6x6
/// matrix, is the bearing of every engine, and `[modes]` names a mode table beside the file. Without it the structure is the
/// springs of the axes. `[sensors.piston]` and `[strings]`: vehicle_sensors.hpp.
///
/// Throws FileError naming file, line, key, value and what is allowed: what load_model and load_modes refuse, a stiffness
/// matrix that is not 6x6, symmetric and positive definite, attach points that coincide or have no arm, a mode table of
/// another number of engines or with more modes than the plant has room for.
VehicleFile load_vehicle(const std::filesystem::path& path);

/// The same of the text of a model file; `path` represents the file in messages, and a mode table is read from beside it.
VehicleFile parse_vehicle(std::string text, const std::filesystem::path& path);

/// The vehicle with another thrust of every engine [N]: what makes ambient and hot fire one file. Throws UsageError for one
/// below zero.
VehicleFile with_thrust(VehicleFile vehicle, double thrust);

/// What faults can be declared on the plant of a vehicle: its actuators are its axes, in their order.
FaultyPlant faulty_plant(const VehicleFile& vehicle);

/// The TOML text of a vehicle: what its axes have in common once, what differs in tables of the axes; otherwise as
/// `model_text`. `load_vehicle` reads it back bit for bit. A mode table is named by its full path.
std::string vehicle_text(const VehicleFile& vehicle);

}  // namespace hotfire
