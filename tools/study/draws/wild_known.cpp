// SPDX-License-Identifier: Apache-2.0
#include "tools/study/draws/wild_draw.hpp"

namespace hotfire::study {
namespace {

using Shape = WildCurve::Shape;
using Kind = WildMemory::Kind;
using Argument = WildArgument;

/// Piston, engine and command go together but for what a finder is to identify.
bool is_position(Argument argument) {
  return argument == Argument::position || argument == Argument::angle || argument == Argument::command;
}

}  // namespace

bool is_known_effect(const WildLaw& law) {
  if (law.factor) {
    return *law.factor == law.argument && law.argument == Argument::time;
  }
  const Kind kind = law.memory.kind;
  const bool line = law.curve.shape == Shape::line;
  const bool sensor = law.site == WildSite::piston_sensor || law.site == WildSite::engine_sensor;
  if (line && kind == Kind::none) {
    return true;  // a gain
  }
  if (law.argument == Argument::time && kind != Kind::none && kind != Kind::swing) {
    return true;  // a ramp or a curve of time, by another one
  }
  switch (law.site) {
    case WildSite::command:
      return law.argument == Argument::command && line && (kind == Kind::delay || kind == Kind::rate_limit);
    case WildSite::valve_command:
      return kind == Kind::plays && law.memory.plays.size() == 1 && law.replaces;
    case WildSite::valve:
      return law.argument == Argument::spool && law.curve.shape == Shape::dead_zone;
    case WildSite::piston:
    case WildSite::engine_torque:
      return is_position(law.argument) && law.memory.plays.size() == 1;
    case WildSite::load_spring:
      return law.argument == Argument::deflection &&
             (law.curve.shape == Shape::dead_zone || (kind == Kind::plays && law.memory.plays.size() == 1));
    default:
      return sensor && is_position(law.argument) && line &&
             (kind == Kind::delay || kind == Kind::first_order || kind == Kind::washout);
  }
}

std::string_view contained_effect(const WildLaw& law) {
  if (law.factor) {
    return "";
  }
  const bool odd =
      law.curve.shape == Shape::saturation || law.curve.shape == Shape::odd_power || law.curve.shape == Shape::dead_zone;
  const bool dry = (is_position(law.argument) && !law.memory.plays.empty()) ||
                   ((law.argument == Argument::rate || law.argument == Argument::angle_rate) &&
                    law.memory.kind == Kind::none && law.curve.shape == Shape::saturation);
  if (law.site == WildSite::piston && dry) {
    return "piston_friction";
  }
  if (law.site == WildSite::engine_torque && dry) {
    return "gimbal_friction";
  }
  // Only the torque motor lies between the two.
  if (law.site == WildSite::valve_command && law.argument == Argument::valve_command && law.memory.kind == Kind::none &&
      law.curve.shape == Shape::dead_zone) {
    return "valve_deadband";
  }
  // The table of that effect's law is any odd curve of the load.
  if (law.site == WildSite::load_spring && law.argument == Argument::deflection && law.memory.kind == Kind::none && odd) {
    return "soft_stiffness";
  }
  return "";
}

}  // namespace hotfire::study
