// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/files/text/error.hpp"
#include "tools/study/cases/profiles.hpp"

namespace hotfire::study {
namespace {

/// v_d of physics.md section 3, half of the passivity bound.
double damping_dies_at(double level, double damping) {
  return damping > 0.0 ? 2.0 * std::sqrt(2.0 * std::numbers::e) * level / damping : 1.0;
}

void plan_gimbal_friction(Plan& plan, Random& random, std::uint64_t seed) {
  const double level = random.uniform(5e3, 12e3);
  plan.values["coulomb_torque"] = level;
  if (seed % 4 == 0) {
    plan.law = "coulomb";
    plan.axis.coulomb.level = level;
    return;
  }
  const double stiffness = random.log_uniform(5e6, 2e7);
  plan.values["stiffness"] = stiffness;
  if (seed % 4 == 2) {
    plan.law = "dahl";
    plan.axis.bristle = {level, stiffness, 1.0, 1.0, 0.0, 1.0};
    return;
  }
  const bool vibrates = seed % 4 == 3;
  plan.law = vibrates ? "vibrated_lugre" : "lugre";
  const double ratio = random.uniform(1.1, 1.4);
  const double stribeck = random.log_uniform(3e-3, 2e-2);
  const double damping = random.uniform(300.0, 1500.0);
  plan.values["static_ratio"] = ratio;
  plan.values["stribeck_velocity"] = stribeck;
  plan.values["damping"] = damping;
  plan.axis.bristle = {level, stiffness, ratio, stribeck, damping, damping_dies_at(level, damping)};
  if (vibrates) {
    const double left = random.uniform(0.3, 0.7);
    const double velocity = random.log_uniform(5e-3, 3e-2);
    plan.values["vibration_ratio"] = plan.axis.bristle.vibration_ratio = left;
    plan.values["vibration_velocity"] = plan.axis.bristle.vibration_velocity = velocity;
    plan.axis.bristle.damping_dies_at = damping_dies_at(left * level, damping);
  }
}

/// The declared model has the friction of a rigid gimbal; the true one sits on a spring.
void plan_gimbal_compliance(Plan& plan, Random& random, std::uint64_t) {
  const double level = random.uniform(6e3, 12e3);
  const double bristle = random.log_uniform(5e7, 2e8);
  const double spring = level / (random.uniform(0.03, 0.1) * kDegree);
  plan.axis.bristle = {level, bristle, 1.0, 1.0, 0.0, 1.0};
  plan.without.bristle = plan.axis.bristle;
  plan.axis.gimbal_stiffness = spring;
  plan.values["stiffness"] = spring;
  plan.declared_effects = fmt::format(
      "[effects.gimbal_friction]\nlaw = \"dahl\"\ncoulomb_torque = {:.10g}\nstiffness = {:.10g}\n\n", level, bristle);
}

void plan_piston_friction(Plan& plan, Random& random, std::uint64_t seed) {
  const double level = random.uniform(3e3, 8e3);
  const double ratio = random.uniform(1.0, 1.4);
  const double stribeck = random.log_uniform(5e-3, 2e-2);
  const double stiffness = random.log_uniform(3e8, 1e9);
  plan.values = {
      {"coulomb_force", level}, {"static_ratio", ratio}, {"stribeck_velocity", stribeck}, {"stiffness", stiffness}};
  if (seed % 2 == 0) {
    plan.law = "elastoplastic";
    plan.axis.seal = {level, stiffness, ratio, stribeck, 1e7};
  } else {
    plan.law = "lugre";
    plan.axis.seal_bristle = {level, stiffness, ratio, stribeck, 0.0, 1.0};
  }
}

void plan_soft_stiffness(Plan& plan, Random& random, std::uint64_t seed) {
  using Soft = ReferenceAxis::Soft;
  constexpr std::array laws{std::pair{Soft::stiffness, "stiffness"}, std::pair{Soft::saturation, "saturation"},
                            std::pair{Soft::compliance, "compliance"}};
  plan.axis.soft = laws[seed % laws.size()].first;
  plan.law = laws[seed % laws.size()].second;
  plan.axis.low_stiffness = plan.values["low_stiffness"] = random.uniform(2.5e7, 4.5e7);
  plan.axis.load_scale = plan.values["load_scale"] = random.uniform(6e3, 15e3);
}

void plan_leakage(Plan& plan, Random& random, std::uint64_t seed) {
  const bool laminar = seed % 2 == 1;
  plan.law = laminar ? "laminar" : "orifice";
  (laminar ? plan.axis.laminar_leak : plan.axis.orifice_leak) = plan.values["coefficient"] =
      laminar ? random.log_uniform(2e-11, 1e-10) : random.log_uniform(5e-12, 3e-11);
}

void plan_structural_mode(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.mode_frequency = plan.values["frequency"] = random.log_uniform(3.5, 11.0);
  plan.axis.mode_damping = plan.values["damping_ratio"] = random.uniform(0.01, 0.03);
  plan.axis.mode_shape = plan.values["shape"] = random.uniform(2e-3, 5e-3);
}

void plan_variable_moment_arm(Plan& plan, Random& random, std::uint64_t) {
  plan.in_model_terms = false;
  plan.axis.linkage.length = plan.values["actuator_length"] = random.uniform(1.0, 2.0);
  plan.axis.linkage.angle = plan.values["lever_angle"] = random.uniform(92.0, 120.0) * kDegree;
}

void plan_sensor_lag(Plan& plan, Random& random, std::uint64_t seed) {
  plan.law = seed % 2 == 1 ? "engine" : "piston";
  (seed % 2 == 1 ? plan.axis.engine_sensor : plan.axis.piston_sensor).lag = plan.values["time_constant"] =
      random.uniform(2e-3, 1e-2);
}

void plan_sensor_nonlinearity(Plan& plan, Random& random, std::uint64_t seed) {
  const bool piston = seed % 2 == 1;
  plan.law = piston ? "piston" : "engine";
  ReferenceAxis::Sensor& sensor = piston ? plan.axis.piston_sensor : plan.axis.engine_sensor;
  sensor.quadratic = plan.values["quadratic"] = random.sign() * random.uniform(0.05, 0.2);
  sensor.cubic = plan.values["cubic"] = random.sign() * random.uniform(0.5, 2.0);
}

void plan_track_wear(Plan& plan, Random& random, std::uint64_t) {
  for (int i = 0; i < 3; ++i) {
    const double at = (i == 0 ? 0.0 : random.sign()) * random.uniform(0.002, 0.02);
    plan.axis.piston_sensor.bumps.push_back({at, random.uniform(8e-4, 3e-3), random.sign() * random.uniform(1e-4, 3e-4)});
  }
  plan.values["bumps"] = 3;
}

/// Dry friction of the gimbal that one of the unlisted effects then changes.
void plan_dry_friction(Plan& plan, Random& random) {
  const double level = plan.values["coulomb_torque"] = random.uniform(4e3, 8e3);
  plan.axis.bristle = {level, random.log_uniform(5e6, 2e7), 1.0, 1.0, 0.0, 1.0};
}

void plan_position_dependent_friction(Plan& plan, Random& random, std::uint64_t) {
  plan_dry_friction(plan, random);
  // Twice to four times the level at 4 deg, which only the ramps reach.
  plan.axis.unlisted.friction_growth = plan.values["growth"] = random.uniform(1.0, 3.0) / (16.0 * kDegree * kDegree);
}

void plan_friction_drift(Plan& plan, Random& random, std::uint64_t) {
  plan_dry_friction(plan, random);
  // Half to twice the level more at the end of the longest record, 60 s.
  plan.axis.unlisted.friction_drift = plan.values["rate"] = random.uniform(0.5, 2.0) / 60.0;
}

/// The valve opens on with the spool: 1 + 3 c x_v^2 stays positive up to x_v = 1.
void plan_flow_gain_curvature(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.flow_curvature = plan.values["curvature"] =
      random.sign() > 0.0 ? random.uniform(0.3, 0.9) : -random.uniform(0.15, 0.3);
}

void plan_aerated_oil(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.aeration = plan.values["share"] = random.uniform(0.8, 0.95);
  plan.axis.unlisted.aeration_pressure = plan.values["pressure"] = random.uniform(1e6, 4e6);
}

void plan_cushion(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.cushion = plan.values["damping_per_distance"] = random.log_uniform(1e7, 1e8);
  plan.axis.unlisted.cushion_from = plan.values["from"] = random.uniform(0.01, 0.04);
}

void plan_seal_squeeze(Plan& plan, Random& random, std::uint64_t) {
  const double level = plan.values["coulomb_force"] = random.uniform(1e3, 3e3);
  plan.axis.seal = {level, random.log_uniform(3e8, 1e9), 1.0, 1.0, 1e7};
  // Two to five times the level more under the pressure that the ducts ask for at 4 deg.
  plan.axis.unlisted.seal_squeeze = plan.values["squeeze"] = random.uniform(2.0, 5.0) / 2.3e6;
}

void plan_creep(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.creep_stiffness = plan.values["stiffness"] = random.uniform(1.5e7, 3.5e7);
  plan.axis.unlisted.creep_time = plan.values["time_constant"] = random.log_uniform(0.3, 2.0);
}

/// A joint that carries a part of what the spring does until it slips.
void plan_joint_slip(Plan& plan, Random& random, std::uint64_t) {
  const double level = plan.values["slip_force"] = random.log_uniform(2e3, 8e3);
  plan.axis.unlisted.joint = {level, plan.values["stiffness"] = random.log_uniform(1e7, 4e7), 1.0, 1.0, 1e7};
}

void plan_engine_hum(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.hum = plan.values["amplitude"] = random.log_uniform(4e-4, 2e-3);
  plan.axis.unlisted.hum_frequency = plan.values["frequency"] = random.uniform(20.0, 120.0);
}

void plan_supply_sag(Plan& plan, Random& random, std::uint64_t) {
  // A fifth to a half of the supply at half of the rated flow.
  plan.axis.unlisted.supply_droop = plan.values["droop"] = random.uniform(0.4, 1.0) * 20.684e6 / 3.155e-3;
  plan.axis.unlisted.supply_recovery = plan.values["time_constant"] = random.log_uniform(0.05, 0.5);
}

void plan_periodic_torque(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.periodic_torque = plan.values["amplitude"] = random.log_uniform(6e3, 2.5e4);
  plan.axis.unlisted.periodic_frequency = plan.values["frequency"] = random.uniform(1.3, 17.0);
}

// What is drawn is what the sensor shows at several times its noise; case.cpp draws again where it does not.
constexpr std::array kListed{
    StudiedEffect{"command_delay", "command",
                  [](Plan& p, Random& r, std::uint64_t) { p.axis.delay = p.values["delay"] = r.uniform(3e-3, 12e-3); }},
    StudiedEffect{"rate_limit", "command",
                  [](Plan& p, Random& r, std::uint64_t) { p.axis.rate_limit = p.values["rate"] = r.uniform(0.08, 0.35); }},
    StudiedEffect{
        "valve_deadband", "valve",
        [](Plan& p, Random& r, std::uint64_t) { p.axis.deadband = p.values["half_width"] = r.uniform(0.01, 0.05); }},
    StudiedEffect{"valve_hysteresis", "valve_command",
                  [](Plan& p, Random& r, std::uint64_t) { p.axis.play = p.values["half_width"] = r.uniform(5e-3, 3e-2); }},
    StudiedEffect{"valve_asymmetry", "valve",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.asymmetry = p.values["asymmetry"] = r.sign() * r.uniform(0.05, 0.25);
                  }},
    StudiedEffect{"leakage", "flow", plan_leakage},
    StudiedEffect{"piston_friction", "piston", plan_piston_friction},
    StudiedEffect{"soft_stiffness", "load_spring", plan_soft_stiffness},
    StudiedEffect{
        "backlash", "load_spring",
        [](Plan& p, Random& r, std::uint64_t) { p.axis.backlash = p.values["half_width"] = r.uniform(5e-5, 3e-4); }},
    StudiedEffect{"structural_mode", "structure", plan_structural_mode},
    StudiedEffect{"gimbal_friction", "engine_torque", plan_gimbal_friction},
    StudiedEffect{"gimbal_compliance", "engine_torque", plan_gimbal_compliance},
    StudiedEffect{
        "duct_hardening", "engine_torque",
        [](Plan& p, Random& r, std::uint64_t) { p.axis.duct_cubic = p.values["cubic"] = r.log_uniform(1e7, 6e7); }},
    StudiedEffect{"torque_offset", "engine_torque",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.torque_offset = p.values["torque"] = r.sign() * r.log_uniform(1e4, 4e4);
                  }},
    StudiedEffect{"variable_moment_arm", "load_spring", plan_variable_moment_arm},
    StudiedEffect{"sensor_lag", "sensor", plan_sensor_lag},
    StudiedEffect{"sensor_nonlinearity", "sensor", plan_sensor_nonlinearity}};

constexpr std::array kUnlisted{
    StudiedEffect{"position_dependent_friction", "engine_torque", plan_position_dependent_friction, "gimbal_friction"},
    StudiedEffect{"flow_gain_curvature", "valve|flow", plan_flow_gain_curvature},
    // More flow into a stiffer oil and less into a softer one are the same pressure rate.
    StudiedEffect{"aerated_oil", "pressure|flow", plan_aerated_oil}, StudiedEffect{"cushion", "piston", plan_cushion},
    StudiedEffect{"seal_squeeze", "piston", plan_seal_squeeze, "piston_friction"},
    StudiedEffect{"creeping_spring", "load_spring|structure", plan_creep},
    StudiedEffect{"spring_damping", "load_spring|structure",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.spring_damping = p.values["damping"] = r.log_uniform(5e4, 5e5);
                  }},
    StudiedEffect{"spring_drift", "load_spring|structure",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.spring_drift = p.values["rate"] = r.sign() * r.uniform(3e-3, 8e-3);
                  }},
    StudiedEffect{"joint_slip", "load_spring|structure", plan_joint_slip},
    StudiedEffect{"orifice_damping", "piston",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.orifice_damping = p.values["damping"] = r.log_uniform(5e5, 5e6);
                  }},
    StudiedEffect{"track_wear", "sensor.piston|sensor", plan_track_wear},
    StudiedEffect{"wiper_play", "sensor.piston|sensor",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.wiper_play = p.values["half_width"] = r.log_uniform(5e-5, 3e-4);
                  }},
    StudiedEffect{"engine_hum", "sensor.engine|sensor", plan_engine_hum},
    // A shifted null of the torque motor is a shifted command, K_e R beta_c, and a shifted spool.
    StudiedEffect{"null_drift", "valve_command|command|valve",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.null_drift = p.values["rate"] = r.sign() * r.uniform(3e-4, 1.5e-3);
                  }},
    StudiedEffect{"gain_drift", "valve|flow",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.gain_drift = p.values["rate"] = r.sign() * r.uniform(3e-3, 8e-3);
                  }},
    StudiedEffect{"friction_drift", "engine_torque", plan_friction_drift, "gimbal_friction"},
    StudiedEffect{"supply_sag", "flow|valve", plan_supply_sag},
    StudiedEffect{"relief_valve", "flow|pressure",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.relief_from = p.values["from"] = r.log_uniform(5e5, 1.5e6);
                    p.axis.unlisted.relief = p.values["flow_per_pressure"] = r.log_uniform(1e-10, 2e-9);
                  }},
    StudiedEffect{
        "spool_slew", "valve|valve_command|flow",
        [](Plan& p, Random& r, std::uint64_t) { p.axis.unlisted.slew = p.values["rate"] = r.log_uniform(1.0, 40.0); }},
    StudiedEffect{"null_offset", "valve_command|command|valve",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.null_offset = p.values["offset"] = r.sign() * r.uniform(5e-3, 5e-2);
                  }},
    StudiedEffect{"command_lag", "command",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.command_lag = p.values["time_constant"] = r.log_uniform(3e-3, 2e-2);
                  }},
    StudiedEffect{"amplitude_dead_time", "command",
                  [](Plan& p, Random& r, std::uint64_t) {
                    p.axis.unlisted.dead_time = p.values["delay_per_angle"] = r.uniform(0.1, 0.4) / kDegree * 0.01;
                  }},
    StudiedEffect{"periodic_torque", "engine_torque|structure", plan_periodic_torque}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kPairs{{{"gimbal_friction", "soft_stiffness"},
                                                                                {"command_delay", "valve_deadband"},
                                                                                {"piston_friction", "structural_mode"},
                                                                                {"backlash", "valve_asymmetry"},
                                                                                {"duct_hardening", "sensor_lag"},
                                                                                {"torque_offset", "valve_hysteresis"},
                                                                                {"leakage", "rate_limit"},
                                                                                {"variable_moment_arm", "gimbal_friction"},
                                                                                {"sensor_nonlinearity", "valve_deadband"},
                                                                                {"structural_mode", "soft_stiffness"}}};

}  // namespace

std::span<const StudiedEffect> listed_effects() { return kListed; }
std::span<const StudiedEffect> unlisted_effects() { return kUnlisted; }
std::span<const std::pair<std::string_view, std::string_view>> studied_pairs() { return kPairs; }

bool is_listed(const StudiedEffect& effect) {
  return std::any_of(kListed.begin(), kListed.end(),
                     [&](const StudiedEffect& listed) { return listed.name == effect.name; });
}

const StudiedEffect& studied_effect(std::string_view name) {
  std::string names;
  for (const auto list : {listed_effects(), unlisted_effects()}) {
    for (const StudiedEffect& effect : list) {
      if (effect.name == name) {
        return effect;
      }
      names += fmt::format("{}{}", names.empty() ? "" : ", ", effect.name);
    }
  }
  throw UsageError(fmt::format("\"{}\" is not an effect of the study; these are: {}", name, names));
}

}  // namespace hotfire::study
