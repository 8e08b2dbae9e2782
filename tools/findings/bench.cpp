// SPDX-License-Identifier: Apache-2.0
#include "tools/findings/bench.hpp"

#include <fmt/format.h>

#include "model/effects/gimbal/gimbal_compliance.hpp"
#include "model/effects/gimbal/gimbal_friction.hpp"
#include "model/effects/load/soft_stiffness.hpp"
#include "tools/files/text/error.hpp"
#include "tools/findings/parameters.hpp"

namespace hotfire::findings {

namespace {

constexpr double kRigid = 1e12;  // N/m: what a spring is that does not give

/// What is taken out of one axis, alone or of the stage.
template <class Parameters>
void remove_from_axis(Parameters& axis, Physics physics) {
  if (physics == Physics::load_spring) {
    axis.actuator.stiffness = axis.structure.stiffness = kRigid;
  } else if (physics == Physics::soft_stiffness) {
    set_active<model::SoftStiffness>(axis, false);
  }
}

/// The friction of the bearing as one of each axis for itself, behind the same torsional spring.
void split_friction(TaosParameters& parameters) {
  auto& gimbal = parameters.gimbals[0];
  const auto& bearing = gimbal.friction;
  for (auto& axis : parameters.axes) {
    set_active<model::GimbalFriction>(axis, true);
    auto& own = effect_of<model::GimbalFriction>(axis);
    own.option = bearing.option;
    own.coulomb_torque = bearing.sliding_torque(gimbal.bearing.thrust + gimbal.bearing.dead_load);
    own.stiffness = bearing.stiffness;
    own.static_ratio = bearing.static_ratio;
    own.stribeck_velocity = bearing.stribeck_velocity;
    own.damping = bearing.damping;
    if (gimbal.compliant) {
      set_active<model::GimbalCompliance>(axis, true);
      effect_of<model::GimbalCompliance>(axis).stiffness = gimbal.stiffness(4, 4);
    }
  }
  gimbal.friction.coulomb_torque = gimbal.friction.coefficient = 0.0;
}

void remove_from_stage(TaosParameters& stage, Physics physics) {
  auto& gimbal = stage.gimbals[0];
  auto& friction = gimbal.friction;
  switch (physics) {
    case Physics::friction:
      friction.coulomb_torque = friction.coefficient = 0.0;
      for (auto& axis : stage.axes) {
        set_active<model::GimbalFriction>(axis, false);
        set_active<model::GimbalCompliance>(axis, false);
      }
      break;
    case Physics::friction_follows_load:
      friction.coulomb_torque = friction.sliding_torque(gimbal.bearing.thrust + gimbal.bearing.dead_load);
      friction.coefficient = 0.0;
      break;
    case Physics::friction_vector:
      split_friction(stage);
      break;
    case Physics::stribeck:
      friction.static_ratio = 1.0;
      break;
    case Physics::bearing_compliance:
      gimbal.compliant = false;
      break;
    case Physics::unloaded_structure:
      gimbal.bearing.unloaded_structure = 1.0;
      break;
    case Physics::misalignment:
      gimbal.bearing.pitch_misalignment = gimbal.bearing.yaw_misalignment = 0.0;
      break;
    default:
      for (auto& axis : stage.axes) {
        remove_from_axis(axis, physics);
      }
  }
}

}  // namespace

std::string_view physics_name(Physics physics) {
  constexpr std::array<std::string_view, 12> kNames{"load_spring",           "soft_stiffness",  "friction",
                                                    "friction_follows_load", "friction_vector", "stribeck",
                                                    "bearing_compliance",    "vibration",       "unloaded_structure",
                                                    "misalignment",          "modes",           "string_motion"};
  return kNames[static_cast<std::size_t>(physics)];
}

Bench load_bench(const std::filesystem::path& folder) {
  Bench bench{folder, load_model(folder / "lab.toml"), load_vehicle(folder / "core-stage.toml")};
  axis_of(bench.lab);
  if (!std::holds_alternative<TaosParameters>(bench.stage.parameters)) {
    throw FileError(
        fmt::format("{}: topology: the core stage of the findings is one engine with two axes; allowed: \"taos\"",
                    bench.stage.path.string()));
  }
  return bench;
}

Bench without(Bench bench, Physics physics) {
  remove_from_axis(axis_of(bench.lab), physics);
  remove_from_stage(std::get<TaosParameters>(bench.stage.parameters), physics);
  bench.removed = physics;
  return bench;
}

}  // namespace hotfire::findings
