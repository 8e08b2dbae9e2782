#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/findings/one_axis.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/reduction.hpp"
#include "tools/structure/synthetic.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/stiffness.hpp"

namespace hotfire::findings {

namespace {

constexpr int kLocations = 8;
constexpr unsigned kSeed = 20230203;  // of the vehicle that is shipped
constexpr double kShare = 0.02;       // of the load flexibility that is in the vehicle's modes; the rest is local

/// Four hot-fire engines without friction on the synthetic vehicle, reduced; `local` stiffness differs by location.
struct Stage {
  VehicleFile vehicle;
  Eigen::MatrixXd flexibility;  ///< static, of the modes
  ModeSet reduced;
};

Stage stage_of(const Sets& sets) {
  ModeSet full = synthetic_vehicle(kSeed, 120);
  full.shape *= std::sqrt(kShare);
  Stage stage;
  stage.flexibility = static_flexibility(full);
  stage.reduced = reduce(full, {}).modes;
  ModelFile hot = sets.hot_fire;
  const SimplexParameters& axis = axis_of(hot);
  MasvParameters parameters;
  for (std::size_t i = 0; i < kLocations; ++i) {
    parameters.axes[i].servovalve = axis.servovalve;
    parameters.axes[i].actuator = axis.actuator;
    parameters.axes[i].engine = axis.engine;
    // Eight locations a few percent apart, as [SD] fig. 11 has them.
    const double spread = 1.0 + 0.02 * (static_cast<double>(i) - 3.5);
    parameters.axes[i].structure.stiffness = spread * axis.structure.stiffness / (1.0 - kShare);
  }
  stage.vehicle.name = "stage";
  stage.vehicle.parameters = parameters;
  return stage;
}

/// Puts the modes into the vehicle, or, static, their flexibility alone.
void set_modes(Stage& stage, bool dynamic) {
  auto& modes = std::get<MasvParameters>(stage.vehicle.parameters).modes;
  modes = {};
  if (!dynamic) {
    modes.residual = stage.flexibility;
    return;
  }
  modes.modes = stage.reduced.modes();
  for (int k = 0; k < modes.modes; ++k) {
    modes.frequency[static_cast<std::size_t>(k)] = stage.reduced.frequency(k);
    modes.damping_ratio[static_cast<std::size_t>(k)] = stage.reduced.damping_ratio(k);
    modes.shape.col(k) = stage.reduced.shape.col(k);
  }
  modes.residual = stage.reduced.residual;
}

trials::ChannelSweep piston_sweep(const Stage& stage, const std::string& axis) {
  const auto command = trials::stepped_sines({{trials::radians(0.05), trials::spaced(8.2, 10.2, 25)}}, 1.5);
  trials::SweepGoal goal;
  goal.axis = axis;
  goal.moment_arm = moment_arm_of(stage.vehicle, axis);
  goal.lowest = 7.0;
  goal.highest = 12.0;
  return trials::analyse_sweep(simulate(stage.vehicle, trials::command_record(command, "command." + axis)), goal).front();
}

}  // namespace

Outcome stiffness_by_location(const Sets& sets) {
  Stage stage = stage_of(sets);
  set_modes(stage, true);
  const auto& parameters = std::get<MasvParameters>(stage.vehicle.parameters);
  const std::vector<std::string> axes = axis_names(4);
  Outcome outcome;
  analysis::Curve by_notch{"from the notch", {}, {}, true};
  analysis::Curve by_modes{"modal integral", {}, {}};
  for (int i = 0; i < kLocations; ++i) {
    const auto& axis = parameters.axes[static_cast<std::size_t>(i)];
    const std::string& name = axes[static_cast<std::size_t>(i)];
    const trials::ChannelSweep sweep = piston_sweep(stage, name);
    const trials::LoadSpring spring = trials::load_spring_of(stage.vehicle, name);
    const double total = analysis::total_stiffness(spring.load, sweep.notch ? sweep.notch->frequency : kNone);
    const double from_notch = analysis::beside(axis.actuator.stiffness, total);
    const double from_modes = 1.0 / (1.0 / axis.structure.stiffness + stage.flexibility(i, i));
    outcome.figures.push_back(near(fmt::format("load stiffness of {}, notch against modal integral", name),
                                   1e-6 * from_notch, 1e-6 * from_modes, 0.02, "MN/m"));
    by_notch.x.push_back(i + 1.0);
    by_notch.y.push_back(1e-6 * from_notch);
    by_modes.x.push_back(i + 1.0);
    by_modes.y.push_back(1e-6 * from_modes);
  }
  outcome.picture = {
      "F12: load stiffness by location", "location", false, {{"load stiffness [MN/m]", {by_notch, by_modes}}}};
  outcome.note = fmt::format(
      "Synthetic vehicle of 120 modes, reduced to {}, which carry 2 % of the load flexibility; 98 % are local to the attach "
      "points. One "
      "actuator is commanded at a time. The modes' share decides how far this holds: with 10 % some location is off by 12 "
      "%, and with all "
      "of the flexibility in modes that cross the band there is no one notch to take a stiffness from.",
      stage.reduced.modes());
  return outcome;
}

Outcome static_or_dynamic(const Sets& sets) {
  Stage stage = stage_of(sets);
  Outcome outcome;
  double largest = 0.0;
  for (int port = 0; port < kLocations; ++port) {
    for (int k = 0; k < stage.reduced.modes(); ++k) {
      const double w = 2.0 * std::numbers::pi * stage.reduced.frequency(k);
      const double own = stage.reduced.shape(port, k) / w;
      largest = std::max(largest, own * own / stage.flexibility(port, port));
    }
  }
  outcome.figures.push_back({"largest share of one mode in the modes' flexibility", 100.0 * largest, 0.0, 10.0, "%"});
  std::vector<trials::ChannelSweep> drawn;
  for (const std::string name : {"pitch1", "yaw1", "pitch2", "yaw4"}) {
    set_modes(stage, true);
    trials::ChannelSweep dynamic = piston_sweep(stage, name);
    set_modes(stage, false);
    trials::ChannelSweep still = piston_sweep(stage, name);
    outcome.figures.push_back(near(fmt::format("notch of {}, dynamic against static structure", name),
                                   dynamic.notch ? dynamic.notch->frequency : kNone,
                                   still.notch ? still.notch->frequency : kNone, 0.02, "Hz"));
    if (name == "pitch1") {
      dynamic.channel = "dynamic";
      still.channel = "static";
      drawn = {dynamic, still};
    }
  }
  outcome.picture = trials::bode_chart("F15: piston of engine 1 pitch on a dynamic and on a static vehicle", drawn);
  outcome.note = "The same vehicle as in F12, in place of its modes their static flexibility.";
  return outcome;
}

}  // namespace hotfire::findings
