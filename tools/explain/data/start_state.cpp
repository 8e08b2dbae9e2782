// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/start_state.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "model/numerics/step_size.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

constexpr std::size_t kRows = 20;
constexpr double kStandardErrors = 4.0;
constexpr double kSlopeStandardErrors = 6.0;
/// Share of a deviation at which it is forgotten.
constexpr double kForgotten = 1e-4;

using Mass = model::Direct<double>;

/// What a sensor of the mass reads by row from an initial state under a force.
Eigen::VectorXd response(const Mass& mass, Mass::State state, std::span<const double> force, int steps,
                         std::size_t channel) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(force.size()));
  run(mass, force, state, steps,
      [&](std::size_t row, const auto& readings) { values(static_cast<Eigen::Index>(row)) = readings[channel]; });
  return values;
}

/// True if measured minus simulated readings of the first rows have no slope that their noise does not explain.
template <std::size_t channels>
bool is_steady(const std::vector<std::array<double, channels>>& simulated, std::span<const std::vector<double>> measured,
               std::span<const double> noise) {
  bool steady = true;
  const double middle = 0.5 * static_cast<double>(simulated.size() - 1);
  for (std::size_t c = 0; c < channels; ++c) {
    if (measured[c].empty()) {
      continue;
    }
    double slope = 0.0;
    double spread = 0.0;
    for (std::size_t row = 0; row < simulated.size(); ++row) {
      const double place = static_cast<double>(row) - middle;
      slope += place * (measured[c][row] - simulated[row][c]);
      spread += place * place;
    }
    steady = steady && std::abs(slope) <= kSlopeStandardErrors * noise[c] * std::sqrt(spread);
  }
  return steady;
}

}  // namespace

bool StartState::moves() const { return std::abs(velocity) > kStandardErrors * velocity_error; }

StartState start_state(const DirectParameters& parameters, std::span<const double> force,
                       std::span<const std::vector<double>> measured, double period, std::span<const double> noise) {
  StartState start;
  const bool has_position = !measured[Mass::kPosition].empty();
  const std::size_t channel = has_position ? Mass::kPosition : Mass::kVelocity;
  const std::vector<double>& values = measured[channel];
  const std::size_t rows = std::min({kRows, force.size(), values.size()});
  if (rows < 4) {
    if (has_position) {
      start.position = values.front();
      start.position_error = noise[channel];
    }
    return start;
  }
  DirectParameters declared = parameters;
  declared.effects.active.fill(false);
  const int steps = model::steps_per_period<Mass>(declared, period);
  const Mass mass(declared, period / steps);
  const std::vector<double> none(rows, 0.0);
  // Columns in units that a record of this length shows alike: a velocity by the record's own time, a force by its inertia.
  const double time = static_cast<double>(rows) * period;
  const double unit_velocity = 1.0 / time;
  const std::vector<double> constant(rows, declared.mass.inertia / (time * time));
  // A velocity says where a mass is only if a spring holds it.
  const bool finds_position = has_position || declared.mass.stiffness > 0.0;
  const Eigen::Index first = finds_position ? 0 : 1;
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(rows), 3);
  columns.col(0) = response(mass, mass.moving(1.0, 0.0), none, steps, channel);
  columns.col(1) = response(mass, mass.moving(0.0, unit_velocity), none, steps, channel);
  columns.col(2) = response(mass, mass.moving(0.0, 0.0), constant, steps, channel);
  const Eigen::MatrixXd used = columns.rightCols(3 - first);
  const Eigen::VectorXd forced = response(mass, mass.moving(0.0, 0.0), force.first(rows), steps, channel);
  const Eigen::VectorXd free = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(rows)) - forced;
  const Eigen::LDLT<Eigen::MatrixXd> normal(used.transpose() * used);
  const Eigen::VectorXd found = normal.solve(used.transpose() * free);
  const double freedom = static_cast<double>(rows) - static_cast<double>(found.size());
  const double variance = std::max(noise[channel] * noise[channel], (used * found - free).squaredNorm() / freedom);
  const Eigen::MatrixXd covariance = variance * normal.solve(Eigen::MatrixXd::Identity(found.size(), found.size()));
  const Eigen::Index velocity = 1 - first;
  if (finds_position) {
    start.position = found(0);
    start.position_error = std::sqrt(covariance(0, 0));
  }
  start.velocity = found(velocity) * unit_velocity;
  start.velocity_error = std::sqrt(covariance(velocity, velocity)) * unit_velocity;
  return start;
}

std::size_t rows_of_memory(const SimplexParameters& parameters, std::size_t rows, double period) {
  const auto& valve = parameters.servovalve;
  const double washout =
      valve.position_feedback != 0.0 || valve.pressure_feedback_gain > 0.0 ? 1.0 / valve.pressure_feedback_corner : 0.0;
  const double loop = valve.position_feedback != 0.0 ? parameters.actuator.piston_area /
                                                           (valve.rated_flow * valve.position_gain * valve.position_feedback)
                                                     : 2.0 * valve.damping_ratio / valve.natural_frequency;
  const double seconds = -std::log(kForgotten) * (loop + washout);
  return std::min(rows / 4, static_cast<std::size_t>(seconds / period));
}

bool dies_out_at_start(std::span<const double> left, std::size_t memory, double noise) {
  constexpr double kStandsOut = 4.0;  // mean square: fifteen rows of noise have less by chance
  constexpr double kGone = 0.5;
  const std::size_t part = memory / 4;
  if (part == 0 || left.size() <= memory) {
    return false;
  }
  const auto mean_square = [](std::span<const double> values) {
    const double square = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    return square / static_cast<double>(values.size());
  };
  // Half a time constant, and a seventh: what the first motion of the command shows of a missing effect comes later.
  const double usual = std::max(noise * noise, mean_square(left.subspan(memory)));
  const double at_start = mean_square(left.first(std::max<std::size_t>(1, memory / 16)));
  const double at_first = mean_square(left.first(std::max<std::size_t>(1, memory / 64)));
  const double after = mean_square(left.subspan(part, part));
  return std::min(at_first, at_start) > kStandsOut * usual && after - usual < kGone * (at_start - usual);
}

std::size_t rows_to_forget_start(const SimplexParameters& parameters, std::span<const double> command,
                                 std::span<const std::vector<double>> measured, double period,
                                 std::span<const double> noise) {
  constexpr std::size_t kMotionChannels = 2;  // piston, engine
  const std::size_t rows = std::min(kRows, command.size());
  if (rows < 4) {
    return 0;
  }
  if (parameters.servovalve.position_feedback == 0.0) {
    return rows_of_memory(parameters, command.size(), period);
  }
  const int steps = model::steps_per_period(period);
  const model::Simplex<double> axis(parameters, period / steps);
  auto state = axis.steady(command.front());
  std::vector<std::array<double, kMotionChannels>> simulated;
  run(axis, command.first(rows), state, steps, [&](std::size_t, const auto& readings) {
    simulated.push_back({readings[0], readings[1]});
  });
  if (simulated.size() < rows || is_steady(simulated, measured, noise)) {
    return 0;
  }
  return rows_of_memory(parameters, command.size(), period);
}

std::size_t rows_to_forget_start(const ElectromechanicalParameters& parameters, std::span<const double> setpoint,
                                 std::span<const std::vector<double>> measured, double period,
                                 std::span<const double> noise) {
  using Actuator = model::Electromechanical<double>;
  const std::size_t rows = std::min(kRows, setpoint.size());
  if (rows < 4) {
    return 0;
  }
  const int steps = model::steps_per_period<Actuator>(parameters, period);
  const Actuator actuator(parameters, period / steps);
  auto state = at_first_row(actuator, setpoint.front(), measured[Actuator::kPosition], measured[Actuator::kMotorPosition]);
  std::vector<std::array<double, Actuator::channels.size()>> simulated;
  run(actuator, setpoint.first(rows), state, steps,
      [&](std::size_t, const auto& readings) { simulated.push_back(readings); });
  if (simulated.size() < rows || is_steady(simulated, measured, noise)) {
    return 0;
  }
  double slowest = 0.0;
  // What does not fall to a third within the record stays.
  const double integrates = std::exp(-1.0 / (static_cast<double>(setpoint.size()) * steps));
  for (const std::complex<double>& root : actuator.transition().eigenvalues()) {
    const double size = std::abs(root);
    slowest = size < integrates ? std::max(slowest, size) : slowest;
  }
  const double seconds = slowest > 0.0 ? std::log(kForgotten) / std::log(slowest) * actuator.step_size() : 0.0;
  return std::min(setpoint.size() / 4, static_cast<std::size_t>(seconds / period));
}

std::size_t rows_to_forget_start(const ModalParameters& parameters, std::size_t rows, double period) {
  double longest = 0.0;
  ModalParameters::for_each_part(parameters, [&](const auto& mode) {
    const double rate = 2.0 * std::numbers::pi * mode.frequency * mode.damping_ratio;
    if (mode.mobility > 0.0 && rate > 0.0) {
      longest = std::max(longest, -std::log(kForgotten) / rate);
    }
  });
  return std::min(rows / 4, static_cast<std::size_t>(longest / period));
}

}  // namespace hotfire::explain
