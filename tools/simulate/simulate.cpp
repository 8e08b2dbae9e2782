// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulate.hpp"

#include <ceres/jet.h>
#include <ceres/tiny_solver.h>

#include <algorithm>
#include <numeric>

#include "model/numerics/step_size.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/open_loop.hpp"
#include "tools/simulate/run.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire {

namespace {

/// Position error of a mass over the first rows as a function of its initial position and velocity, for TinySolver.
struct StartError {
  // The names are TinySolver's.
  using Scalar = double;
  enum { NUM_PARAMETERS = 2, NUM_RESIDUALS = Eigen::Dynamic };  // NOLINT(readability-identifier-naming)
  using Dual = ceres::Jet<double, NUM_PARAMETERS>;

  const model::Direct<Dual>& plant;
  std::span<const double> input;
  std::span<const double> measured;
  double scale;  ///< rms of what is measured: brings position and residual to
                 ///< order one
  double speed;  ///< unit of the initial velocity
  int steps;

  int NumResiduals() const { return static_cast<int>(input.size()); }  // NOLINT(readability-identifier-naming)

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    auto state = plant.moving(scale * Dual(parameters[0], 0), speed * Dual(parameters[1], 1));
    return run(plant, input, state, steps, [&](std::size_t row, const auto& readings) {
      const auto i = static_cast<int>(row);
      residuals[i] = (readings[0].a - measured[row]) / scale;
      for (int k = 0; jacobian != nullptr && k < NUM_PARAMETERS; ++k) {
        jacobian[k * NumResiduals() + i] = readings[0].v[k] / scale;
      }
    });
  }
};

/// Initial position and velocity that fit the first rows best.
std::pair<double, double> fitted_start(const DirectParameters& parameters, const Record& inputs, std::size_t rows) {
  require_channel(inputs, "position", "--fit-start fits the initial state to it");
  const std::vector<double>& position = inputs.find("position")->values;
  rows = std::min(rows, inputs.rows);
  if (rows < 3) {
    throw UsageError("--fit-start needs at least 3 rows to find a position and a velocity");
  }
  const double square = std::inner_product(position.begin(), position.end(), position.begin(), 0.0);
  if (!(square > 0.0)) {
    return {0.0, 0.0};
  }
  const double scale = std::sqrt(square / static_cast<double>(inputs.rows));
  const double speed = scale / (static_cast<double>(rows) * inputs.period);
  const int steps = model::steps_per_period<model::Direct<double>>(parameters, inputs.period);
  const model::Direct<StartError::Dual> plant(with_scalar<model::Direct<StartError::Dual>::Parameters>(parameters),
                                              inputs.period / steps);
  const StartError error{
      plant, std::span(inputs.find("force")->values).first(rows), std::span(position).first(rows), scale, speed, steps};
  ceres::TinySolver<StartError> solver;
  Eigen::Vector2d start(position.front() / scale, (position[1] - position[0]) / inputs.period / speed);
  solver.Solve(error, &start);
  return {start(0) * scale, start(1) * speed};
}

/// The unit of a channel of a mass or a moved body: that of the record, or one that goes with its position, which goes with
/// a force or torque in SI.
std::string unit_of_motion(const Record& inputs, std::string_view channel, const std::string& unit_of_input,
                           bool input_is_position) {
  if (const Channel* measured = inputs.find(std::string(channel))) {
    return measured->unit;
  }
  if (channel == "force") {
    return unit_of_input == "m" ? "N" : unit_of_input == "rad" ? "N.m" : "1";
  }
  const Channel* position = inputs.find("position");
  const std::string unit = position != nullptr      ? position->unit
                           : input_is_position      ? unit_of_input
                           : unit_of_input == "N"   ? "m"
                           : unit_of_input == "N.m" ? "rad"
                                                    : "1";
  return channel.starts_with("velocity") ? unit + "/s" : channel.starts_with("acceleration") ? unit + "/s^2" : unit;
}

template <class Plant>
Record run_open_loop(const Plant& plant, typename Plant::State state, const Record& inputs, int steps) {
  const Channel& input = *inputs.find(std::string(Plant::input_channel));
  Record outputs = beside(inputs, input);
  bool input_is_position = false;
  if constexpr (std::is_same_v<typename Plant::Parameters, ElectromechanicalParameters>) {
    input_is_position = has_position_loop(plant.parameters());
  }
  for (std::size_t c = 0; c < Plant::channels.size(); ++c) {
    const std::string unit = Plant::channel_units[c].empty()
                                 ? unit_of_motion(inputs, Plant::channels[c], input.unit, input_is_position)
                                 : std::string(Plant::channel_units[c]);
    outputs.channels.push_back({std::string(Plant::channels[c]), unit, {}});
    outputs.channels.back().values.reserve(inputs.rows);
  }
  const auto keep = [&](std::size_t, const auto& readings) {
    for (std::size_t c = 0; c < readings.size(); ++c) {
      outputs.channels[c + 1].values.push_back(readings[c]);
    }
  };
  if (!run_record(plant, inputs, state, steps, keep)) {
    throw runaway_error(inputs, outputs.channels[1].values.size(), Plant::input_channel);
  }
  return outputs;
}

}  // namespace

Record simulate(const ModelFile& model, const Record& inputs, std::size_t fit_start_rows) {
  if (fit_start_rows > 0 && !std::holds_alternative<DirectParameters>(model.parameters)) {
    throw UsageError(
        "--fit-start is for a direct model; a hydraulic axis starts in the steady state under its first command, a body of "
        "imposed_motion on its path, a modal structure at rest, and an electromechanical actuator at rest where it is first "
        "measured");
  }
  return std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        using Plant = PlantOf<Parameters, double>;
        require_channel(inputs, std::string(Plant::input_channel), "the model is driven by it");
        require_units_of_one_motion(inputs);
        if constexpr (std::is_same_v<Parameters, ElectromechanicalParameters>) {
          if (has_position_loop(parameters)) {
            require_same_unit(inputs, "setpoint", "position");
          }
        }
        const int steps = steps_in_row<Plant>(parameters, inputs.period);
        const Plant plant(parameters, inputs.period / steps);
        auto state = start_of(plant, inputs);
        if constexpr (std::is_same_v<Parameters, DirectParameters>) {
          if (fit_start_rows > 0) {
            const auto [start, speed] = fitted_start(parameters, inputs, fit_start_rows);
            state = plant.moving(start, speed, inputs.find("force")->values.front());
            state.clock.start = inputs.start;
          }
        }
        return run_open_loop(plant, state, inputs, steps);
      },
      model.parameters);
}

double moment_arm_of(const ModelFile& model) {
  const auto* simplex = std::get_if<SimplexParameters>(&model.parameters);
  return simplex != nullptr ? simplex->actuator.moment_arm : 1.0;
}

}  // namespace hotfire
