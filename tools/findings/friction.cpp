#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "model/vehicle.hpp"
#include "tools/findings/rows.hpp"

namespace hotfire::findings {

namespace {

using Friction = model::BearingFriction<double>;
using Pair = model::Pair<double>;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The same draws on every machine.
class Gaussian {
 public:
  double operator()() { return std::sqrt(-2.0 * std::log(uniform())) * std::cos(kTurn * uniform()); }

 private:
  double uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }
  std::mt19937 random_{7};
};

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

Friction rigid() { return {0, 2e4, 1e8, 1.0, 0.01, 0.0, 1.0, 0.01}; }

/// Modified Bessel functions I0 + I1 by their series; arguments below 2.
double bessel_sum(double x) {
  double term = 1.0;
  double sum = 0.0;
  for (int k = 0; k < 40; ++k) {
    sum += term + term * 0.5 * x / (k + 1);
    term *= 0.25 * x * x / ((k + 1.0) * (k + 1.0));
  }
  return sum;
}

}  // namespace

Outcome friction_vector(const Sets&) {
  using Taos = model::Taos<double>;
  constexpr double kStep = 5e-4;
  constexpr double kPitchRate = 0.02;  // rad/s
  Taos::Parameters parameters;
  parameters.gimbals[0].friction = {2, 2e4, 1e8, 1.0, 0.01, 3e3, 1.0, 0.01};
  const Taos plant(parameters, kStep);
  Outcome outcome;
  analysis::Curve model_curve{"model", {}, {}, true};
  analysis::Curve law{"v_pitch / |v|", {}, {}};
  for (const double yaw_rate : {0.0, 0.01, 0.02, 0.04}) {
    Taos::State state = plant.steady({});
    double torque = 0.0;
    double pitch = 0.0;
    double yaw = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const double time = (k + 0.5) * kStep;
      plant.step(state, {{kPitchRate * time, yaw_rate * time}, {}});
      if (k >= 1000) {
        torque += state.gimbals[0].torque.pitch / 1000.0;
        pitch += state.axes[0].y(Taos::AxisModel::kAngleRate) / 1000.0;
        yaw += state.axes[1].y(Taos::AxisModel::kAngleRate) / 1000.0;
      }
    }
    const double expected = pitch / std::hypot(pitch, yaw);
    outcome.figures.push_back(
        near(fmt::format("friction in pitch over its level, yaw at {:g} of pitch", yaw_rate / kPitchRate), torque / 2e4,
             expected, 0.03, ""));
    model_curve.x.push_back(yaw_rate / kPitchRate);
    model_curve.y.push_back(torque / 2e4);
  }
  for (double ratio = 0.0; ratio <= 2.01; ratio += 0.05) {
    law.x.push_back(ratio);
    law.y.push_back(1.0 / std::hypot(1.0, ratio));
  }
  outcome.picture = {"F10: friction in pitch while yaw moves",
                     "rate of yaw over rate of pitch",
                     false,
                     {{"friction in pitch over its level", {model_curve, law}}}};
  outcome.note = "Ramps of both commands on the two-axis model; mean over the second half, while it slides.";
  return outcome;
}

Outcome friction_under_vibration(const Sets&) {
  constexpr double kAmplitude = 0.1;  // rad/s
  Outcome outcome;
  analysis::Curve sine{"sine", {}, {}, true};
  analysis::Curve closed_sine{"(2/pi) asin(v/V)", {}, {}};
  for (const double ratio : {0.1, 0.3, 0.5, 0.8, 0.95}) {
    const double mean = mean_friction(rigid(), 20000, 1e-4, [&](double t) {
      return Pair{kAmplitude * (ratio + std::sin(kTurn * 10.0 * t)), 0.0};
    });
    const double closed = 2.0 / std::numbers::pi * std::asin(ratio);
    outcome.figures.push_back(near(fmt::format("sine, v/V = {}", ratio), mean, closed, 0.03, ""));
    sine.x.push_back(ratio);
    sine.y.push_back(mean);
    closed_sine.x.push_back(ratio);
    closed_sine.y.push_back(closed);
  }
  Gaussian gaussian;
  for (const double ratio : {0.5, 1.0, 2.0}) {
    const double v = ratio * kAmplitude;
    const double along = mean_friction(rigid(), 400000, 1e-4, [&](double) {
      return Pair{v + kAmplitude * gaussian(), 0.0};
    });
    outcome.figures.push_back(near(fmt::format("Gaussian along the motion, v/s = {}", ratio), along,
                                   std::erf(ratio / std::numbers::sqrt2), 0.03, ""));
    const double both = mean_friction(rigid(), 400000, 1e-4, [&](double) {
      return Pair{v + kAmplitude * gaussian(), kAmplitude * gaussian()};
    });
    const double q = 0.25 * ratio * ratio;
    outcome.figures.push_back(near(fmt::format("Gaussian in two dimensions, v/s = {}", ratio), both,
                                   std::sqrt(std::numbers::pi / 8.0) * ratio * std::exp(-q) * bessel_sum(q), 0.03, ""));
  }
  // The same travel of a tenth of a degree at twice the frequency is twice the speed.
  const auto at_frequency = [&](double frequency) {
    const double speed = kTurn * frequency * 1.7e-3;
    return mean_friction(rigid(), 20000, 1e-4, [&](double t) {
      return Pair{0.02 + speed * std::sin(kTurn * frequency * t), 0.0};
    });
  };
  outcome.figures.push_back(
      {"friction at 40 Hz over that at 20 Hz, same travel", at_frequency(40.0) / at_frequency(20.0), 0.0, 0.6, ""});
  outcome.picture = {"F11: mean friction under a sine of speed amplitude V",
                     "sliding speed v over V",
                     false,
                     {{"mean friction over its level", {sine, closed_sine}}}};
  outcome.note =
      "Rigid friction. Of equal travel the faster vibration lowers friction more; of equal speed it does so only "
      "while it moves the bearing by more than its bristles give.";
  return outcome;
}

}  // namespace hotfire::findings
