// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/experiment_run.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire::explain {

namespace {

/// Sums over the rows of records: squares of the force, of the deviation of the motion from its mean, and of its rate.
struct MotionSums {
  double rows = 0.0;
  double force = 0.0;
  double size = 0.0;
  double rate = 0.0;

  void take(const std::vector<double>& forces, const std::vector<double>& motion, double period) {
    const double mean = std::accumulate(motion.begin(), motion.end(), 0.0) / static_cast<double>(motion.size());
    // A speed over 2 ms, or over the record if that is shorter: differences of neighbours are noise.
    const std::size_t apart =
        std::clamp<std::size_t>(static_cast<std::size_t>(0.002 / period), 1, std::max<std::size_t>(1, motion.size() / 2));
    for (std::size_t row = 0; row < motion.size(); ++row) {
      force += forces[row] * forces[row];
      size += (motion[row] - mean) * (motion[row] - mean);
      if (row >= apart) {
        const double v = (motion[row] - motion[row - apart]) / (static_cast<double>(apart) * period);
        rate += v * v;
      }
    }
    rows += static_cast<double>(motion.size());
  }

  /// `order`: of the derivative of the position that the motion is.
  Scales scales(std::ptrdiff_t order) const {
    Scales scales;
    if (rows > 0.0 && force > 0.0 && size > 0.0 && rate > 0.0) {
      scales.force = std::sqrt(force / rows);
      scales.time = std::sqrt(size / rate);
      scales.position = std::sqrt(size / rows) * std::pow(scales.time, static_cast<double>(order));
    }
    return scales;
  }
};

Scales scales_of_records(const Dataset& data) {
  MotionSums sums;
  std::ptrdiff_t order = 0;  // of the derivative of the position that the first record measures
  for (const Experiment& experiment : data.experiments) {
    const auto measured =
        std::ranges::find_if(experiment.measured, [](const std::vector<double>& values) { return !values.empty(); });
    const std::ptrdiff_t own_order = measured - experiment.measured.begin();
    if (measured == experiment.measured.end() || (sums.rows > 0.0 && own_order != order)) {
      continue;
    }
    order = own_order;
    sums.take(experiment.input, *measured, experiment.period);
  }
  return sums.scales(order);
}

Scales scales_of_paths(const Dataset& data) {
  MotionSums sums;
  for (const Experiment& experiment : data.experiments) {
    sums.take(experiment.measured.front(), experiment.input, experiment.period);
  }
  return sums.scales(0);
}

Scales scales_of_joint(const ModalParameters& declared, const Dataset& data) {
  MotionSums sums;
  for (const Experiment& experiment : data.experiments) {
    const JointMotion joint = joint_motion(data, experiment, declared);
    if (joint.position.size() == experiment.rows()) {
      sums.take(experiment.input, joint.position, experiment.period);
    }
  }
  return sums.scales(0);
}

Scales scales_of_load(const ElectromechanicalParameters& declared, const Dataset& data) {
  MotionSums sums;
  double command = 0.0;
  for (const Experiment& experiment : data.experiments) {
    const LoadMotion load = load_motion(data, experiment, declared);
    if (load.position.size() == experiment.rows()) {
      sums.take(load.force, load.position, experiment.period);
      command += std::inner_product(load.command.begin(), load.command.end(), load.command.begin(), 0.0);
    }
  }
  Scales scales = sums.scales(0);
  scales.command = command > 0.0 ? std::sqrt(command / sums.rows) : 1.0;
  return scales;
}

Scales scales_of_rig(const SimplexParameters& declared) {
  const SimplexParameters reference;
  Scales scales;
  scales.metre = reference.servovalve.position_gain / declared.servovalve.position_gain;
  scales.second = servo_time(declared) / servo_time(reference);
  scales.pascal = declared.actuator.supply_pressure / reference.actuator.supply_pressure;
  return scales;
}

}  // namespace

Scales scales_of(const ModelParameters& declared, const Dataset& data) {
  const auto* axis = std::get_if<SimplexParameters>(&declared);
  if (axis != nullptr) {
    return scales_of_rig(*axis);
  }
  if (const auto* modes = std::get_if<ModalParameters>(&declared)) {
    return scales_of_joint(*modes, data);
  }
  if (const auto* motor = std::get_if<ElectromechanicalParameters>(&declared)) {
    return scales_of_load(*motor, data);
  }
  return std::holds_alternative<ImposedMotionParameters>(declared) ? scales_of_paths(data) : scales_of_records(data);
}

double servo_time(const SimplexParameters& declared) {
  return declared.actuator.piston_area / (declared.servovalve.rated_flow * declared.servovalve.position_gain);
}

double size_of_unit(std::string_view unit, const Scales& scales) {
  const double newton = scales.pascal * scales.metre * scales.metre;
  const std::array<std::pair<std::string_view, double>, 11> sizes{
      {{"force", scales.force},
       {"position", scales.position},
       {"time", scales.time},
       {"command", scales.command},
       {"m", scales.metre},
       {"s", scales.second},
       {"Hz", 1.0 / scales.second},
       {"Pa", scales.pascal},
       {"N", newton},
       {"kg", newton * scales.second * scales.second / scales.metre},
       {"rad", 1.0}}};
  return unit_product(
             unit,
             [&](std::string_view word) -> std::optional<double> {
               const auto found = std::ranges::find(sizes, word, [](const auto& size) { return size.first; });
               return found != sizes.end() ? std::optional(found->second) : word == "1" ? std::optional(1.0) : std::nullopt;
             })
      .value_or(1.0);
}

LoadMotion load_motion(const Dataset& data, const Experiment& experiment, const ElectromechanicalParameters& parameters) {
  using Plant = model::Electromechanical<double>;
  const int steps = model::steps_per_period<Plant>(parameters, experiment.period);
  const Plant plant(parameters, experiment.period / steps);
  Plant::State state = initial_state(plant, data, experiment, Start<double>{});
  LoadMotion motion;
  run_experiment(plant, data, experiment, state, steps, [&](std::size_t, const auto&) {
    motion.position.push_back(plant.load_position(state));
    motion.rate.push_back(plant.load_rate(state));
    motion.force.push_back(plant.motor_force(state));
    motion.command.push_back(plant.motor_command(state));
    motion.twist.push_back(plant.twist(state));
  });
  return motion;
}

JointMotion joint_motion(const Dataset& data, const Experiment& experiment, const ModalParameters& parameters) {
  using Plant = model::Modal<double>;
  const int steps = model::steps_per_period<Plant>(parameters, experiment.period);
  const Plant plant(parameters, experiment.period / steps);
  Plant::State state = plant.at_rest(0.0);
  JointMotion motion;
  run_experiment(plant, data, experiment, state, steps, [&](std::size_t, const auto&) {
    motion.position.push_back(plant.joint_position(state));
    motion.rate.push_back(plant.joint_rate(state));
  });
  return motion;
}

}  // namespace hotfire::explain
