// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "model/vehicle.hpp"
#include "tools/findings/parameters.hpp"
#include "tools/findings/rows.hpp"
#include "tools/interface/plant/normal.hpp"

namespace hotfire::findings {

namespace {

using Friction = model::BearingFriction<double>;
using Pair = model::Pair<double>;
using Taos = model::Taos<double>;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Mean friction along pitch over its level, under an imposed slip, after a tenth of the steps.
template <class Slip>
double mean_friction(const Friction& friction, int steps, double h, Slip&& slip) {
  Pair deflection;
  double sum = 0.0;
  for (int k = -steps / 10; k < steps; ++k) {
    const Pair velocity = slip((k + 0.5) * h);
    const Pair torque = friction.torque(deflection, {velocity, velocity, {}, h});
    sum += k < 0 ? 0.0 : torque.pitch;
  }
  return sum / (steps * friction.coulomb_torque);
}

/// A vibration about pitch: of the bearing's slip [rad/s], or of a torque on the engine [N m].
struct Vibration {
  double frequency = 0.0;
  double slip = 0.0;
  double torque = 0.0;
};

/// Mean friction torque of the shipped bearing at hot fire while the engine slides slowly about pitch [kN m], over a whole
/// number of cycles.
double friction_in_plant(TaosParameters parameters, double rate, const Vibration& vibration) {
  constexpr double kPlantStep = 2.5e-4;
  constexpr int kSettling = 6000;
  constexpr int kSteps = 8000;
  parameters.gimbals[0].vibration.frequency = std::max(1.0, vibration.frequency);
  parameters.gimbals[0].vibration.pitch_velocity = vibration.slip;
  const auto plant = std::make_unique<Taos>(parameters, kPlantStep);
  const auto state = std::make_unique<Taos::State>(plant->steady({}));
  double sum = 0.0;
  for (int k = 0; k < kSettling + kSteps; ++k) {
    const double time = (k + 0.5) * kPlantStep;
    Taos::Inputs inputs;
    inputs.commands = {rate * time, 0.0};
    inputs.torque[0] = vibration.torque * std::sin(kTurn * vibration.frequency * time);
    plant->step(*state, inputs);
    sum += k < kSettling ? 0.0 : state->gimbals[0].torque.pitch;
  }
  return 1e-3 * sum / kSteps;
}

void closed_forms(const Bench& bench, Outcome& outcome, analysis::Curve& sine, analysis::Curve& closed_sine) {
  // Rigid friction; sizes do not matter to a ratio.
  const Friction rigid{0, 2e4};
  const double amplitude = bench.has(Physics::vibration) ? 0.1 : 0.0;  // rad/s
  for (const double ratio : {0.1, 0.5, 0.95}) {
    const double mean = mean_friction(rigid, 20000, 1e-4, [&](double t) {
      return Pair{0.1 * ratio + amplitude * std::sin(kTurn * 10.0 * t), 0.0};
    });
    const double closed = 2.0 / std::numbers::pi * std::asin(ratio);
    outcome.figures.push_back(
        near(fmt::format("rigid law, sine along the motion, v/V = {}", ratio), mean, closed, 0.03, ""));
    sine.x.push_back(ratio);
    sine.y.push_back(mean);
  }
  for (double ratio = 0.0; ratio < 1.0; ratio += 0.02) {
    closed_sine.x.push_back(ratio);
    closed_sine.y.push_back(2.0 / std::numbers::pi * std::asin(ratio));
  }
  Normal gaussian(7);
  for (const double ratio : {0.5, 2.0}) {
    const double both = mean_friction(rigid, 400000, 1e-4, [&](double) {
      const double along = gaussian();
      return Pair{0.1 * ratio + amplitude * along, amplitude * gaussian()};
    });
    const double q = 0.25 * ratio * ratio;
    outcome.figures.push_back(near(
        fmt::format("rigid law, Gaussian in two dimensions, v/s = {}", ratio), both,
        std::sqrt(std::numbers::pi / 8.0) * ratio * std::exp(-q) * (std::cyl_bessel_i(0.0, q) + std::cyl_bessel_i(1.0, q)),
        0.03, ""));
  }
}

}  // namespace

Outcome friction_under_vibration(const Bench& bench) {
  const TaosParameters hot = std::get<TaosParameters>(bench.hot_fire().parameters);
  const double on = bench.has(Physics::vibration) ? 1.0 : 0.0;
  Outcome outcome;
  analysis::Curve sine{"sine", {}, {}, true};
  analysis::Curve closed_sine{"(2/pi) asin(v/V)", {}, {}};
  closed_forms(bench, outcome, sine, closed_sine);

  // LuGre in the plant; 20 and 40 Hz have whole numbers of cycles in the mean.
  constexpr double kRate = 0.02;
  const double still = friction_in_plant(hot, kRate, {});
  const auto over_still = [&](const Vibration& vibration) { return friction_in_plant(hot, kRate, vibration) / still; };
  constexpr double kTravel = 4e-3;  // rad
  constexpr double kTorque = 4e5;   // N m
  const double slow = over_still({20.0, on * kTurn * 20.0 * kTravel, 0.0});
  const double fast = over_still({40.0, on * kTurn * 40.0 * kTravel, 0.0});
  const double fast_of_equal_speed = over_still({40.0, on * kTurn * 20.0 * kTravel, 0.0});
  outcome.figures.push_back({"LuGre in the plant, slip of 4 mrad at 20 Hz, over none", slow, 0.0, 0.1, ""});
  outcome.figures.push_back({"40 Hz over 20 Hz, equal travel", fast / slow, 0.35, 0.65, ""});
  outcome.figures.push_back({"40 Hz over 20 Hz, equal speed", fast_of_equal_speed / slow, 1.05, 1.5, ""});
  const double pushed_slow = over_still({20.0, 0.0, on * kTorque});
  const double pushed_fast = over_still({40.0, 0.0, on * kTorque});
  outcome.figures.push_back({"LuGre in the plant, torque of 0.4 MN m at 20 Hz, over none", pushed_slow, 0.0, 0.2, ""});
  constexpr double kSmallTravel = 5e-4;  // rad: less than the 1.1 mrad that the torsion of the bearing takes under friction
  outcome.figures.push_back(
      {"slip of 0.5 mrad at 20 Hz, over none", over_still({20.0, on * kTurn * 20.0 * kSmallTravel, 0.0}), 0.6, 0.9, ""});
  outcome.figures.push_back({"40 Hz over 20 Hz, equal torque", pushed_fast / pushed_slow, 4.0, 12.0, ""});

  // [GF]'s law for what vibration does on the mean.
  TaosParameters averaged = hot;
  auto& friction = averaged.gimbals[0].friction;
  friction.choose(Friction::Law::vibrated_lugre);
  friction.vibration_ratio = bench.has(Physics::vibration) ? 0.4 : 1.0;
  friction.vibration_velocity = 0.02;
  for (const double rate : {0.01, 0.04}) {
    const double left = friction_in_plant(averaged, rate, {}) / friction_in_plant(hot, rate, {});
    outcome.figures.push_back(near(fmt::format("gamma2 law in the plant at {:g} rad/s, over none", rate), left,
                                   1.0 - 0.6 * std::exp(-rate / 0.02), 0.03, ""));
  }
  outcome.picture = {"F11: mean friction under a sine of speed amplitude V",
                     "sliding speed v over V",
                     false,
                     {{"mean friction over its level", {sine, closed_sine}}}};
  outcome.note =
      "\"Higher frequency content is more important\" [GF] holds for equal amplitude of the slip. At equal slip "
      "velocity, the higher frequency has the smaller amplitude. The torsion of the bearing takes a larger part "
      "of it, so friction falls less. At equal torque, the velocity falls as 1/f, and so does the reduction of "
      "friction. The torsion under friction is 1.1 mrad. A smaller amplitude of 0.5 mrad still lowers friction "
      "by a quarter.";
  return outcome;
}

}  // namespace hotfire::findings
