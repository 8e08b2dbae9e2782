// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/findings/parameters.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

const TaosParameters& parameters_of(const VehicleFile& vehicle) { return std::get<TaosParameters>(vehicle.parameters); }

/// A triangle of the command in pitch, four seconds a period.
constexpr double kPeak = 0.05;  // rad, over one second: two and a half times the Stribeck velocity
constexpr std::size_t kRows = 4000;
constexpr std::size_t kPeriods = 2;  // under each thrust; the last counts

/// The triangle beside one in yaw that is `yaw` times as large, under one thrust after the other.
Record triangles(const std::vector<double>& thrusts, double yaw = 0.0) {
  std::vector<double> command;
  std::vector<double> thrust;
  for (const double level : thrusts) {
    for (std::size_t row = 0; row < kPeriods * kRows; ++row) {
      const double turn = static_cast<double>(row % kRows) / kRows;
      command.push_back(kPeak * (turn < 0.25 ? 4.0 * turn : turn < 0.75 ? 2.0 - 4.0 * turn : 4.0 * turn - 4.0));
      thrust.push_back(level);
    }
  }
  std::vector<double> across = command;
  std::for_each(across.begin(), across.end(), [yaw](double& value) { value *= yaw; });
  Record record = trials::command_record(std::move(command), "command.pitch");
  record.channels.push_back({"command.yaw", "rad", std::move(across)});
  record.channels.push_back({"thrust", "N", std::move(thrust)});
  return record;
}

/// Half the difference of the torque that the pressure in pitch gives the engine, on its way up and down through zero [N m]:
/// friction and what is viscous.
double resistance(const VehicleFile& vehicle, const Record& record, std::size_t level) {
  const std::vector<double>& pressure = record.find("load_pressure.pitch")->values;
  const std::vector<double>& engine = record.find("engine.pitch")->values;
  const std::size_t first = (kPeriods * (level + 1) - 1) * kRows;
  const auto mean_on_the_way = [&](bool up) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t row = first + 1; row < first + kRows; ++row) {
      const bool rises = engine[row] > engine[row - 1];
      if (std::abs(engine[row]) < 0.4 * kPeak && rises == up) {
        sum += pressure[row];
        ++count;
      }
    }
    return sum / count;
  };
  const double area = parameters_of(vehicle).axes[0].actuator.piston_area;
  return 0.5 * (mean_on_the_way(true) - mean_on_the_way(false)) * area * moment_arm_of(vehicle, "pitch");
}

}  // namespace

Outcome thrust_and_friction(const Bench& bench) {
  const VehicleFile vehicle = bench.hot_fire();
  const auto& gimbal = parameters_of(vehicle).gimbals[0];
  const double full = gimbal.bearing.thrust;
  const Record record = simulate(vehicle, triangles({0.0, 0.5 * full, full}));
  // What the shipped file says, whatever has been taken out of the model.
  constexpr double kCoefficient = 0.08;
  constexpr double kRadius = 0.13;
  const auto law = [&](double thrust) {
    return 1e-3 * kCoefficient * kRadius *
           (std::abs(thrust + gimbal.bearing.dead_load) - std::abs(gimbal.bearing.dead_load));
  };
  const double still = resistance(vehicle, record, 0);
  Outcome outcome;
  outcome.figures.push_back(near("friction that half the thrust adds, against mu N r",
                                 1e-3 * (resistance(vehicle, record, 1) - still), law(0.5 * full), 0.01, "kN m"));
  outcome.figures.push_back(near("friction that full thrust adds, against mu N r",
                                 1e-3 * (resistance(vehicle, record, 2) - still), law(full), 0.01, "kN m"));
  const auto trim = [&](double thrust) {
    const Record rest = simulate(with_thrust(vehicle, thrust), trials::command_record({0.0, 0.0}, "command.pitch"));
    return 1e3 * trials::degrees(rest.find("engine.pitch")->values.front());
  };
  outcome.figures.push_back({"trim that full thrust adds", trim(full) - trim(0.0), 38.0, 53.0, "mdeg"});
  outcome.picture = trials::time_chart("F18: thrust from zero by halves to full", record, "pitch");
  outcome.note =
      "One model file is run once, with the thrust as a channel of the input. Friction is half of the difference"
      " of the load pressure between the two directions of motion. Viscous damping cancels in the difference "
      "between two thrusts. The trim is the angle at zero command. It comes from a misaligned thrust and the "
      "compliance of the bearing.";
  return outcome;
}

Outcome friction_vector(const Bench& bench) {
  const VehicleFile vehicle = bench.hot_fire();
  const VehicleFile frictionless = without(bench, Physics::friction).hot_fire();
  const double full = parameters_of(vehicle).gimbals[0].bearing.thrust;
  const auto friction = [&](double yaw) {
    const Record input = triangles({full}, yaw);
    return resistance(vehicle, simulate(vehicle, input), 0) - resistance(frictionless, simulate(frictionless, input), 0);
  };
  const double alone = friction(0.0);
  Outcome outcome;
  analysis::Curve model_curve{"model", {0.0}, {1.0}, true};
  analysis::Curve law{"v_pitch / |v|", {}, {}};
  for (const double yaw : {0.5, 1.0, 1.5}) {
    const double left = friction(yaw) / alone;
    outcome.figures.push_back(near(fmt::format("friction in pitch, yaw at {:g} of pitch, over that of pitch alone", yaw),
                                   left, 1.0 / std::hypot(1.0, yaw), 0.03, ""));
    model_curve.x.push_back(yaw);
    model_curve.y.push_back(left);
  }
  for (double ratio = 0.0; ratio <= 1.55; ratio += 0.05) {
    law.x.push_back(ratio);
    law.y.push_back(1.0 / std::hypot(1.0, ratio));
  }
  outcome.picture = {"F10: friction in pitch while yaw moves",
                     "rate of yaw over rate of pitch",
                     false,
                     {{"friction in pitch over that of pitch alone", {model_curve, law}}}};
  outcome.note = "Both commands are triangles at hot fire. Friction is the load pressure minus that without friction.";
  return outcome;
}

Outcome one_file(const Bench& bench) {
  Outcome outcome;
  std::vector<trials::ChannelSweep> drawn;
  const auto at = [&](const VehicleFile& model, const char* name) {
    const auto command = trials::stepped_sines({{trials::radians(0.8), trials::spaced(5.4, 11.6, 80)}});
    drawn.push_back(*trials::find_sweep(swept(model, "pitch", command, 5.4, 11.6), "piston", trials::radians(0.8)));
    drawn.back().channel = name;
    return notch_of(drawn.back());
  };
  const double ambient = at(bench.ambient(), "thrust 0");
  const double hot = at(bench.hot_fire(), "full thrust");
  outcome.figures.push_back(near("notch of the piston without thrust", ambient, 6.5, 0.03, "Hz"));
  outcome.figures.push_back(near("notch of the piston under full thrust", hot, 9.5, 0.03, "Hz"));
  outcome.figures.push_back(near("shift by the thrust alone", hot / ambient, 9.5 / 6.5, 0.03, ""));
  outcome.picture = trials::bode_chart("F19: one file, 0.8 deg, its thrust switched", drawn);
  outcome.note = "Only the thrust differs between the two runs. The structure of empty tanks follows it.";
  return outcome;
}

}  // namespace hotfire::findings
