// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/direct.hpp"
#include "model/effects.hpp"
#include "tools/findings/parameters.hpp"
#include "tools/findings/rows.hpp"

namespace hotfire::findings {

namespace {

using Mass = model::Direct<double>;

constexpr double kStep = 1e-4;

/// The set of [Canudas de Wit et al. 1995], table I: 1 kg on a spring to ground.
Mass::Parameters textbook(double spring, bool stribeck) {
  Mass::Parameters parameters;
  parameters.mass = {1.0, 0.0, spring};
  auto& friction = effect_of<model::SlidingFriction>(parameters);
  friction.option = static_cast<int>(model::SlidingFriction::Law::lugre);
  friction.coulomb_forward = friction.coulomb_backward = 1.0;
  friction.viscous_forward = friction.viscous_backward = 0.4;
  friction.stiffness = 1e5;
  friction.static_ratio = stribeck ? 1.5 : 1.0;
  friction.stribeck_velocity = 1e-3;
  friction.damping = 316.2;
  set_active<model::SlidingFriction>(parameters, true);
  return parameters;
}

/// First peak of the friction while the applied force rises at `rate` [N/s]: what the mass does not take.
double break_away(double rate, bool stribeck) {
  const Mass plant(textbook(0.0, stribeck), kStep);
  Mass::State state = plant.at_rest(0.0);
  double peak = 0.0;
  double friction = 0.0;
  // Twice the sliding level: what has not broken away by then does not.
  for (int k = 0; friction >= 0.99 * peak && rate * k * kStep < 2.0; ++k) {
    const double before = state.y(1);
    const double force = rate * (k + 0.5) * kStep;
    plant.step(state, force);
    friction = force - (state.y(1) - before) / kStep;
    peak = std::max(peak, friction);
  }
  return peak;
}

}  // namespace

Outcome lugre_reference(const Bench& bench) {
  const bool stribeck = bench.has(Physics::stribeck);
  Outcome outcome;
  constexpr double kSpring = 2.0;
  constexpr double kSpeed = 0.1;
  const Mass pulled(textbook(kSpring, stribeck), kStep);
  Mass::State state = pulled.at_rest(0.0);
  std::vector<double> slips;
  double peak_speed = 0.0;
  double peak_force = 0.0;
  bool slipping = false;
  analysis::Curve position{"mass", {}, {}};
  analysis::Curve pull{"end of the spring", {}, {}};
  // Without stick-slip there are no slips to wait for.
  for (int k = 0; slips.size() < 5 && k * kStep < 60.0; ++k) {
    pulled.step(state, kSpring * kSpeed * (k + 0.5) * kStep);
    const double time = (k + 1) * kStep;
    if (slips.size() >= 2) {
      peak_speed = std::max(peak_speed, state.y(1));
      peak_force = std::max(peak_force, kSpring * (kSpeed * time - state.y(0)));
    }
    if (!slipping && state.y(1) > kSpeed) {
      slips.push_back(time);
    }
    slipping = state.y(1) > (slipping ? 0.5 * kSpeed : kSpeed);
    if (k % 1000 == 0) {
      position.x.push_back(time);
      position.y.push_back(state.y(0));
      pull.x.push_back(time);
      pull.y.push_back(kSpeed * time);
    }
  }
  outcome.figures.push_back(
      near("period of stick-slip", slips.size() < 5 ? kNone : (slips[4] - slips[1]) / 3.0, 6.3627, 0.01, "s"));
  outcome.figures.push_back(near("peak speed", peak_speed, 0.3698, 0.01, "m/s"));
  outcome.figures.push_back(near("peak spring force", peak_force, 1.508, 0.01, "N"));
  constexpr std::array<std::pair<double, double>, 4> kBreakAway{
      {{1.0, 1.4324}, {5.0, 1.3132}, {10.0, 1.2200}, {20.0, 1.0986}}};
  for (const auto& [rate, force] : kBreakAway) {
    outcome.figures.push_back(near(fmt::format("break-away at {} N/s", rate), break_away(rate, stribeck), force, 0.01, "N"));
  }
  const Mass free(textbook(0.0, stribeck), kStep);
  constexpr double kRate = 0.1425;  // N/s: 95 % of the break-away force in 10 s, held for 5 s, and down again
  state = free.at_rest(0.0);
  double at_the_top = 0.0;
  for (int k = 0; k * kStep < 25.0; ++k) {
    const double time = (k + 0.5) * kStep;
    at_the_top = time < 10.0 ? state.y(0) : at_the_top;
    free.step(state, std::clamp(time < 15.0 ? kRate * time : kRate * (25.0 - time), 0.0, 1.425));
  }
  outcome.figures.push_back(near("presliding at 1.425 N", 1e6 * at_the_top, 44.9, 0.01, "um"));
  outcome.figures.push_back(near("left at zero force", 1e6 * state.y(0), 35.3, 0.01, "um"));
  outcome.picture = {"F14: stick-slip of the 1995 set", "time [s]", false, {{"position [m]", {position, pull}}}};
  outcome.note = "The reference is RK4 with a step of 1e-6 s. The step here is 0.1 ms.";
  return outcome;
}

}  // namespace hotfire::findings
