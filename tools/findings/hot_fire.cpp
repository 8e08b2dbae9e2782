#include <fmt/format.h>

#include <cmath>

#include "model/effects/gimbal_friction.hpp"
#include "tools/analysis/step_response.hpp"
#include "tools/findings/one_axis.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

ModelFile without_friction(ModelFile model) {
  set_active<model::GimbalFriction>(axis_of(model), false);
  return model;
}

double lag(const trials::ChannelSweep& sweep, double frequency) {
  return std::arg(nearest(sweep, frequency).gain) * 180.0 / std::numbers::pi;
}

/// Gain of a channel at 2 Hz under one amplitude [dB].
double gain_at(const ModelFile& model, const char* channel, double amplitude) {
  const auto sweeps = swept(model, trials::stepped_sines({{amplitude, {2.0}}}), 1.0, 14.0);
  return analysis::gain_decibels(trials::find_sweep(sweeps, channel, amplitude)->response.front());
}

std::vector<analysis::StepResponse> engine_steps(const ModelFile& model, const Record& command, Record* kept = nullptr) {
  const Record record = simulate(model, command);
  if (kept != nullptr) {
    *kept = record;
  }
  return analysis::step_responses(command.find("command")->values, record.find("engine")->values, record.period, 1.0);
}

constexpr double kFriction = 45e3;  // N m, physics.md section 4

/// The piston's response in pitch of an engine with two axes on a bearing of this torsional stiffness [N m/rad], rigid if it
/// is zero, whose friction is all but rigid.
trials::ChannelSweep on_bearing(double torsion, const char* name) {
  TaosParameters parameters;
  for (auto& axis : parameters.axes) {
    axis.structure.stiffness = 1.05e8;
  }
  model::GimbalParameters<double>& gimbal = parameters.gimbals[0];
  gimbal.friction.coulomb_torque = kFriction;
  gimbal.friction.stiffness = 5e8;
  gimbal.bearing.thrust = 1.86e6;
  gimbal.compliant = torsion > 0.0;
  gimbal.stiffness.diagonal() << 2e9, 2e9, 2e9, torsion, torsion, torsion;
  VehicleFile vehicle;
  vehicle.parameters = parameters;
  trials::SweepGoal goal;
  goal.axis = "pitch";
  goal.moment_arm = moment_arm_of(vehicle, goal.axis);
  goal.lowest = 7.0;
  goal.highest = 14.0;
  const Record command = trials::command_record(trials::stepped_sines(trials::green_run_sines()), "command.pitch");
  trials::ChannelSweep sweep = trials::joined_sweep(trials::analyse_sweep(simulate(vehicle, command), goal), "piston", goal);
  sweep.channel = name;
  return sweep;
}

double depth_of(const trials::ChannelSweep& sweep) { return sweep.notch ? sweep.notch->depth : 0.0; }

}  // namespace

Outcome hot_fire_sweep(const Sets& sets) {
  const GreenRun with = green_run(sets.hot_fire);
  const GreenRun without = green_run(without_friction(sets.hot_fire));
  Outcome outcome;
  outcome.figures.push_back(
      near("notch of the piston", with.piston.notch ? with.piston.notch->frequency : kNone, 9.5, 0.02, "Hz"));
  for (const double frequency : {1.0, 2.0, 4.0, 6.0}) {
    const auto loss = [&](const trials::ChannelSweep& on, const trials::ChannelSweep& off) {
      return analysis::gain_decibels(nearest(on, frequency)) - analysis::gain_decibels(nearest(off, frequency));
    };
    outcome.figures.push_back({fmt::format("engine's gain at {} Hz against no friction", frequency),
                               loss(with.engine, without.engine), -6.0, -0.2, "dB"});
    outcome.figures.push_back({fmt::format("piston's gain at {} Hz against no friction", frequency),
                               loss(with.piston, without.piston), -6.0, -0.1, "dB"});
  }
  for (const double frequency : {1.0, 2.0}) {
    outcome.figures.push_back({fmt::format("engine's phase at {} Hz against no friction", frequency),
                               lag(with.engine, frequency) - lag(without.engine, frequency), -30.0, -2.0, "deg"});
  }
  outcome.figures.push_back(
      {"engine's gain at 2 Hz, 0.1 deg against 0.4 deg",
       gain_at(sets.hot_fire, "engine", trials::radians(0.1)) - gain_at(sets.hot_fire, "engine", trials::radians(0.4)),
       -20.0, -1.0, "dB"});
  auto smooth = without;
  smooth.piston.channel += ", no friction";
  smooth.engine.channel += ", no friction";
  outcome.picture =
      trials::bode_chart("F7: Green Run profile, hot fire", {with.piston, smooth.piston, with.engine, smooth.engine});
  return outcome;
}

Outcome hot_fire_step(const Sets& sets) {
  const Record command =
      trials::command_record(trials::steps({trials::radians(0.6), trials::radians(0.4), trials::radians(0.2)}, 2.0));
  Record record;
  const auto with = engine_steps(sets.hot_fire, command, &record);
  const auto without = engine_steps(without_friction(sets.hot_fire), command);
  Outcome outcome;
  for (std::size_t k = 0; k < with.size(); k += 4) {
    const std::string name = fmt::format("{:.1f} deg", trials::degrees(with[k].to));
    outcome.figures.push_back(
        {fmt::format("overshoot of the engine at {}", name), 100.0 * with[k].overshoot, 0.0, 5.0, "%"});
    outcome.figures.push_back(
        {fmt::format("overshoot without friction at {}", name), 100.0 * without[k].overshoot, 8.0, 40.0, "%"});
  }
  outcome.figures.push_back({"hesitation at 0.2 deg", 1e3 * with[8].hesitation, 40.0, 200.0, "ms"});
  outcome.figures.push_back({"hesitation at 0.2 deg without friction", 1e3 * without[8].hesitation, 0.0, 30.0, "ms"});
  outcome.figures.push_back(
      {"rise time at 0.2 deg over that at 0.6 deg", with[8].rise_time / with[0].rise_time, 1.2, 5.0, ""});
  outcome.figures.push_back(
      {"rise time of the return over the deflection at 0.2 deg", with[9].rise_time / with[8].rise_time, 1.05, 3.0, ""});
  outcome.picture = trials::time_chart("F8: steps, hot fire", record, "");
  return outcome;
}

Outcome notch_and_gimbal(const Sets& sets) {
  // Section 3 of physics.md: 45 kN m on the reference axis at hot-fire load stiffness.
  ModelFile model = without_effects(sets.hot_fire);
  SimplexParameters& axis = axis_of(model);
  axis = SimplexParameters{};
  axis.structure.stiffness = 1.05e8;
  set_active<model::GimbalFriction>(axis, true);
  auto& friction = effect_of<model::GimbalFriction>(axis);
  friction.option = 2;
  friction.coulomb_torque = kFriction;
  const auto depth = [&](double stiffness, const char* name, trials::ChannelSweep& kept) {
    friction.stiffness = stiffness;
    kept = green_run(model).piston;
    kept.channel = name;
    kept.notch = analysis::find_notch(kept.response, 7.0, 14.0);
    return depth_of(kept);
  };
  trials::ChannelSweep rigid;
  trials::ChannelSweep compliant;
  Outcome outcome;
  outcome.figures.push_back(
      {"notch under its upper shoulder, rigid gimbal", depth(5e8, "rigid gimbal", rigid), 0.0, 3.0, "dB"});
  const double soft = kFriction / trials::radians(0.15);
  outcome.figures.push_back(
      {"notch under its upper shoulder, compliant gimbal", depth(soft, "compliant gimbal", compliant), 6.0, 40.0, "dB"});
  const trials::ChannelSweep rigid_bearing = on_bearing(0.0, "two axes, rigid bearing");
  const trials::ChannelSweep compliant_bearing = on_bearing(soft, "two axes, compliant bearing");
  outcome.figures.push_back({"the same of two axes, rigid bearing", depth_of(rigid_bearing), 0.0, 3.0, "dB"});
  outcome.figures.push_back({"the same of two axes, compliant bearing", depth_of(compliant_bearing), 6.0, 40.0, "dB"});
  outcome.picture =
      trials::bode_chart("F9: piston with 45 kN m of gimbal friction", {rigid, compliant, rigid_bearing, compliant_bearing});
  outcome.note =
      "One axis has bearing and bristle in series as one stiffness: 5e8 N m/rad against 45 kN m over 0.15 deg, physics.md "
      "section 4. Of two axes the bristle keeps 5e8 N m/rad, and the bearing's 6x6 stiffness is the compliance.";
  return outcome;
}

}  // namespace hotfire::findings
