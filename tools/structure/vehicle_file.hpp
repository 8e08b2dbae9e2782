#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "model/vehicle.hpp"
#include "tools/structure/vehicle_sensors.hpp"

namespace hotfire {

using TaosParameters = model::Taos<double>::Parameters;
using MasvParameters = model::Masv<double>::Parameters;

/// A model of several axes as its TOML file declares it, in SI.
struct VehicleFile {
  std::filesystem::path path;
  std::string name;
  std::variant<TaosParameters, MasvParameters> parameters;
  VehicleSensors sensors;
};

/// True for a TOML file whose topology is that of several axes, "taos" or "masv". Throws FileError if it cannot be read.
bool is_vehicle(const std::filesystem::path& path);

/// The names of the axes in order, as channels end and tables are named: pitch, yaw for one engine; pitch1, yaw1, pitch2 ...
std::vector<std::string> axis_names(int engines);

/// Reads and checks a model file of several axes (contract.md). The parts and effects of `[servovalve]`, `[actuator]`,
/// `[structure]`, `[engine]` and `[effects.NAME]` are those of every axis; `[actuator.pitch]` is what differs on the pitch
/// axes and
/// `[actuator.pitch2]` on that of engine 2. `[attach.pitch]` and `[attach.pitch2]` are attach points, `[gimbal]` with
/// `[gimbal.friction]`, `[gimbal.vibration]` and `stiffness`, a 6x6 matrix, the bearing of every engine, and `[modes]` names
/// a mode table beside the file. Without it the structure is the springs of the axes. `[sensors]` and `[strings]`:
/// vehicle_sensors.hpp.
///
/// Throws FileError naming file, line, key, value and what is allowed: what load_model and load_modes refuse, a stiffness
/// matrix that is not 6x6, symmetric and positive definite, attach points that coincide or have no arm, a mode table of
/// another number of engines or with more modes than the plant has room for.
VehicleFile load_vehicle(const std::filesystem::path& path);

}  // namespace hotfire
