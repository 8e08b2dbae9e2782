// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::findings {

/// Physics that findings are about. Each can be taken out of everything that the findings run (`without`).
enum class Physics {
  load_spring,            ///< actuator and structure give way under load
  soft_stiffness,         ///< the actuator is softer under small loads
  friction,               ///< of the gimbal bearing
  friction_follows_load,  ///< its level is mu N r; without, it is that of full thrust whatever the thrust
  friction_vector,        ///< one bristle vector over both axes; without, a friction of its own on each
  stribeck,               ///< static friction above that of sliding
  bearing_compliance,     ///< the bearing gives way in torsion
  vibration,              ///< of the bearing
  unloaded_structure,     ///< without thrust the structure is softer
  misalignment,           ///< of the thrust
  modes,                  ///< the structure moves dynamically; without, by its static flexibility alone
  string_motion,          ///< strings are read where the structure carries them and where they really are
};

/// "soft_stiffness".
std::string_view physics_name(Physics physics);

/// What the findings run: the shipped parameter sets, representative and tuned to the published frequencies (each file says
/// which numbers are), and what has been taken out of them.
struct Bench {
  std::filesystem::path folder;
  ModelFile lab;      ///< one axis, an actuator that drives a simulator of the engine's mass
  VehicleFile stage;  ///< one engine with two axes on the core stage, at hot fire
  std::optional<Physics> removed{};

  bool has(Physics physics) const { return removed != physics; }
  VehicleFile hot_fire() const { return stage; }
  VehicleFile ambient() const { return with_thrust(stage, 0.0); }
};

/// Reads lab.toml and core-stage.toml of a folder. Throws FileError.
Bench load_bench(const std::filesystem::path& folder);

/// The bench with physics taken out of its parameter sets, and noted for findings that build plants of their own.
Bench without(Bench bench, Physics physics);

}  // namespace hotfire::findings
