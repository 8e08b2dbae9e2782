// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "tools/analysis/resonance.hpp"
#include "tools/analysis/welch.hpp"
#include "tools/findings/parameters.hpp"
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
constexpr double kShare = 0.34;       // of the load flexibility that is in the vehicle's modes; the rest is local

/// Four hot-fire engines without friction on the synthetic vehicle, reduced; `local` stiffness differs by location.
struct Stage {
  VehicleFile vehicle;
  Eigen::MatrixXd flexibility;  ///< static, of the modes
  ModeSet reduced;
};

Stage stage_of(const Bench& bench) {
  ModeSet full = synthetic_vehicle(kSeed, 120);
  full.shape *= std::sqrt(kShare);
  Stage stage;
  stage.flexibility = static_flexibility(full);
  stage.reduced = reduce(full, {}).modes;
  const auto& axis = std::get<TaosParameters>(bench.stage.parameters).axes[0];
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

enum class Modes { dynamic, at_rest, none };

/// Puts the modes into the vehicle, or, at rest, their flexibility alone.
void set_modes(Stage& stage, Modes kind) {
  auto& modes = std::get<MasvParameters>(stage.vehicle.parameters).modes;
  modes = {};
  if (kind == Modes::at_rest) {
    modes.residual = stage.flexibility;
  }
  if (kind != Modes::dynamic) {
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

/// Piston and engine of one axis, it alone commanded, in their steady state under sines of all frequencies at once: the
/// stage is as good as linear under them, so that each sine has the response that it would have alone, once it has settled.
struct SteadyResponse {
  trials::ChannelSweep piston;
  trials::ChannelSweep engine;
  double unsettled = 0.0;  ///< largest change of the piston's gain from the repeat before, over its largest gain
};

SteadyResponse steady_response(const Stage& stage, const std::string& axis) {
  constexpr double kLowest = 7.4;
  constexpr double kHighest = 14.0;
  constexpr double kHighestNotch = 12.0;
  // Lines 0.025 Hz apart, four within the width of a mode of half a percent damping. In one repeat it fades to 1e-4.
  constexpr double kRepeat = 40.0;
  constexpr int kRepeats = 3;
  const std::vector<double> command = trials::multisine(trials::radians(0.05), kLowest, kHighest, kRepeat, kRepeats, 1);
  const Record record = simulate(stage.vehicle, trials::command_record(command, trials::channel_of("command", axis)));
  const std::size_t rows = command.size() / kRepeats;
  const auto response = [&](const std::string& channel, std::size_t repeat) {
    const std::vector<double>& output = record.find(trials::channel_of(channel, axis))->values;
    return analysis::periodic_response(std::span(command).subspan(repeat * rows, rows),
                                       std::span(output).subspan(repeat * rows, rows), record.period, kLowest, kHighest);
  };
  SteadyResponse steady;
  steady.piston = {"piston", 0.0, response("piston", kRepeats - 1), {}, {}};
  steady.piston.notch = analysis::find_notch(steady.piston.response, kLowest, kHighestNotch);
  steady.engine = {"engine", 0.0, response("engine", kRepeats - 1), {}, {}};
  const analysis::FrequencyResponse before = response("piston", kRepeats - 2);
  double change = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    change = std::max(change, std::abs(steady.piston.response[k].gain - before[k].gain));
    largest = std::max(largest, std::abs(before[k].gain));
  }
  steady.unsettled = change / largest;
  return steady;
}

trials::ChannelSweep piston_sweep(const Stage& stage, const std::string& axis) {
  return steady_response(stage, axis).piston;
}

/// The least and the largest share that the modes in the vehicle have of the load flexibility of a location.
std::pair<double, double> shares_in_modes(const Stage& stage) {
  const auto& parameters = std::get<MasvParameters>(stage.vehicle.parameters);
  double least = 1.0;
  double most = 0.0;
  for (int port = 0; port < kLocations; ++port) {
    double moving = 0.0;
    for (int k = 0; k < parameters.modes.modes; ++k) {
      const double w = 2.0 * std::numbers::pi * parameters.modes.frequency[static_cast<std::size_t>(k)];
      moving += parameters.modes.shape(port, k) * parameters.modes.shape(port, k) / (w * w);
    }
    const double local = 1.0 / parameters.axes[static_cast<std::size_t>(port)].structure.stiffness;
    const double share = moving / (local + stage.flexibility(port, port));
    least = std::min(least, share);
    most = std::max(most, share);
  }
  return {least, most};
}

}  // namespace

Outcome stiffness_by_location(const Bench& bench) {
  Stage stage = stage_of(bench);
  set_modes(stage, bench.has(Physics::modes) ? Modes::dynamic : Modes::none);
  const auto& parameters = std::get<MasvParameters>(stage.vehicle.parameters);
  const std::vector<std::string> axes = axis_names(4);
  Outcome outcome;
  analysis::Curve by_notch{"from the notch", {}, {}, true};
  analysis::Curve by_modes{"modal integral", {}, {}};
  double mean = 0.0;
  double square = 0.0;
  double unsettled = 0.0;
  for (int i = 0; i < kLocations; ++i) {
    const auto& axis = parameters.axes[static_cast<std::size_t>(i)];
    const std::string& name = axes[static_cast<std::size_t>(i)];
    const SteadyResponse steady = steady_response(stage, name);
    unsettled = std::max(unsettled, steady.unsettled);
    const trials::LoadSpring spring = trials::load_spring_of(stage.vehicle, name);
    const double total = analysis::total_stiffness(spring.load, notch_of(steady.piston));
    const double from_notch = analysis::beside(axis.actuator.stiffness, total);
    const double from_modes = 1.0 / (1.0 / axis.structure.stiffness + stage.flexibility(i, i));
    const double ratio = from_notch / from_modes;
    outcome.figures.push_back({fmt::format("load stiffness of {}, notch over modal integral", name), ratio, 0.8, 2.0, ""});
    mean += ratio / kLocations;
    square += ratio * ratio / kLocations;
    by_notch.x.push_back(i + 1.0);
    by_notch.y.push_back(1e-6 * from_notch);
    by_modes.x.push_back(i + 1.0);
    by_modes.y.push_back(1e-6 * from_modes);
  }
  const auto [least, most] = shares_in_modes(stage);
  outcome.figures.push_back({"least share of the load flexibility in moving modes", 100.0 * least, 30.0, 60.0, "%"});
  outcome.figures.push_back({"largest share", 100.0 * most, 30.0, 60.0, "%"});
  outcome.figures.push_back({"mean over the locations", mean, 1.05, 1.35, ""});
  outcome.figures.push_back({"scatter over the locations", 100.0 * std::sqrt(square - mean * mean), 10.0, 40.0, "%"});
  outcome.figures.push_back({"change of a response in 40 s more, largest", 100.0 * unsettled, 0.0, 0.1, "%"});
  outcome.picture = {
      "F12: load stiffness by location", "location", false, {{"load stiffness [MN/m]", {by_notch, by_modes}}}};
  outcome.note = fmt::format(
      "The synthetic vehicle has 120 modes, reduced to {}. The rest of the load flexibility is local to the "
      "attach points. All sines of 7.4 to 14 Hz, 0.025 Hz apart, act at once, and the response is read after 80 "
      "s. A mode of 0.5 % damping settles in 22 s. Without friction and soft stiffness the stage is nearly "
      "linear under them. One actuator is commanded at a time. The deepest notch is read. It need not be that of"
      " the load: modes that cross the band have their own notches. A stiffness from a notch multiplies the "
      "shift of the notch by 2 K_L / K_T, which is about four here. The total stiffness goes with the square, "
      "and the stiffness of the actuator is subtracted. So the 13 % of F15 at one location are 80 % of "
      "stiffness. The scatter is larger than that of [SD fig. 11], whose vehicle must have fewer modes that the "
      "actuators excite. [SD 2.4] fits the curve of a one-axis model to the whole response. One deep notch of a "
      "mode disturbs that fit less. It is not repeated here.",
      stage.reduced.modes());
  return outcome;
}

Outcome static_or_dynamic(const Bench& bench) {
  Stage stage = stage_of(bench);
  const Modes moving = bench.has(Physics::modes) ? Modes::dynamic : Modes::at_rest;
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
  constexpr double kNearly = 0.06;  // what still counts as the same frequency
  double mean = 0.0;
  double furthest = 0.0;
  double same = 0.0;
  for (const std::string& name : axis_names(4)) {
    set_modes(stage, moving);
    trials::ChannelSweep dynamic = piston_sweep(stage, name);
    set_modes(stage, Modes::at_rest);
    trials::ChannelSweep still = piston_sweep(stage, name);
    const double ratio = notch_of(dynamic) / notch_of(still);
    outcome.figures.push_back({fmt::format("notch of {}, dynamic over static structure", name), ratio, 0.9, 1.2, ""});
    mean += ratio / kLocations;
    furthest = std::max(furthest, std::abs(ratio - 1.0));
    same += std::abs(ratio - 1.0) < kNearly ? 1.0 : 0.0;
    if (name == "pitch3") {
      dynamic.channel = "dynamic";
      still.channel = "static";
      drawn = {dynamic, still};
    }
  }
  outcome.figures.push_back({"mean over the locations", mean, 0.97, 1.06, ""});
  // Eight of eight would be a structure whose modes do not matter, fewer than six no finding.
  outcome.figures.push_back({"locations where both are within 6 %", same, 6.0, 7.0, ""});
  outcome.figures.push_back({"largest difference", 100.0 * furthest, 6.0, 25.0, "%"});
  outcome.picture = trials::bode_chart("F15: piston of engine 3 pitch on a dynamic and on a static vehicle", drawn);
  outcome.note =
      "Vehicle and steady state are those of F12. The static structure has the static flexibility of the modes "
      "in their place. \"Nearly the same frequency\" [SD] holds to 6 % at seven of the eight locations. It does "
      "not hold for the pitch of engine 3, which is drawn: there the deepest notch is that of a mode.";
  return outcome;
}

Outcome engine_phase(const Bench& bench) {
  Stage stage = stage_of(bench);
  set_modes(stage, bench.has(Physics::modes) ? Modes::dynamic : Modes::at_rest);
  trials::ChannelSweep dynamic = steady_response(stage, "pitch1").engine;
  set_modes(stage, Modes::at_rest);
  trials::ChannelSweep still = steady_response(stage, "pitch1").engine;
  double furthest = 0.0;
  for (const analysis::ResponsePoint& point : still.response) {
    if (point.frequency >= 9.0) {
      furthest = std::max(furthest, std::abs(phase_between(dynamic, still, point.frequency)));
    }
  }
  Outcome outcome;
  outcome.figures.push_back({"largest change of the engine's phase, 9 to 14 Hz", furthest, 10.0, 120.0, "deg"});
  dynamic.channel = "dynamic";
  still.channel = "static";
  outcome.picture = trials::bode_chart("F20: engine 1 in pitch on a dynamic and on a static vehicle", {dynamic, still});
  outcome.note = "Vehicle and steady state are those of F12.";
  return outcome;
}

}  // namespace hotfire::findings
