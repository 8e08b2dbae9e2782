// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/vehicle/vehicle_run.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/numerics/linear_algebra.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/run.hpp"
#include "tools/simulate/vehicle_disturbances.hpp"

namespace hotfire::explain {

namespace {

/// True if the attach points of a vehicle move, or its engines are turned, by more than the springs of the axes.
template <class Parameters>
bool has_more_than_springs(const Parameters& parameters) {
  bool more = parameters.modes.modes > 0 || !parameters.modes.residual.isZero(0.0);
  for (const auto& gimbal : parameters.gimbals) {
    const auto& bearing = gimbal.bearing;
    more = more || gimbal.compliant || bearing.unloaded_structure < 1.0 || bearing.pitch_misalignment != 0.0 ||
           bearing.yaw_misalignment != 0.0 || gimbal.friction.rubs();
  }
  return more;
}

/// Flexibility at rest of the attach point of an axis under its own force, beyond its own spring, at the declared thrust
/// [m/N].
template <class Plant>
double flexibility_of(const Plant& plant, const typename Plant::Parameters& parameters, std::size_t axis) {
  const auto& gimbal = parameters.gimbals[axis / 2];
  const auto port = static_cast<Eigen::Index>(axis);
  double flexibility = plant.structure().static_flexibility()(port, port);
  flexibility += gimbal.bearing.further_structure(gimbal.bearing.thrust) / parameters.axes[axis].structure.stiffness;
  if (gimbal.compliant) {
    const auto pose = plant.geometry(static_cast<int>(axis / 2)).at(0.0, 0.0);
    const model::Vector3<double>& direction = pose.direction[axis % 2];
    const auto compliance = model::inverse_of_positive_definite<double, 6>(gimbal.stiffness);
    flexibility += direction.dot(compliance.template topLeftCorner<3, 3>() * direction);
  }
  return flexibility;
}

/// Rotation at rest of a bearing under a torque about an axis [rad/(N m)].
template <class Parameters>
double rotation_of(const Parameters& parameters, std::size_t axis) {
  const auto& gimbal = parameters.gimbals[axis / 2];
  // Among the six displacements of a bearing: y for pitch, z for yaw.
  const Eigen::Index about = axis % 2 == 0 ? 4 : 5;
  return gimbal.compliant ? model::inverse_of_positive_definite<double, 6>(gimbal.stiffness)(about, about) : 0.0;
}

/// Records what the rest of a vehicle does to its axes. A step gives means over itself; a row has the mean over the two
/// steps beside it, and the rotation of a bearing at its own time.
template <class Plant>
class AroundAxes {
 public:
  AroundAxes(const Plant& plant, const typename Plant::Parameters& parameters, std::size_t rows, int steps,
             std::vector<std::vector<RestOfVehicle>>& vehicle, std::size_t record)
      : plant_(plant), parameters_(parameters), rows_(rows), steps_(steps) {
    for (std::size_t i = 0; i < Plant::kAxes; ++i) {
      RestOfVehicle& rest = vehicle[i][record];
      rest.flexibility = flexibility_of(plant, parameters, i);
      stiffness_[i] = plant.axis(static_cast<int>(i)).stiffness();
      rests_[i] = &rest;
      series_[i] = {&rest.motion, &rest.force, &rest.torque};
      if (parameters.gimbals[i / 2].friction.rubs()) {
        RestOfVehicle::Bearing& bearing = rest.bearing;
        bearing.flexibility = rotation_of(parameters, i);
        bearing.loss_time = parameters.gimbals[i / 2].bearing.loss_time;
        bearing.turned = {std::vector<double>(rows, 0.0), std::vector<double>(rows, 0.0)};
        for (auto* series : {&bearing.vibrating[0], &bearing.vibrating[1], &bearing.load, &bearing.vibration}) {
          series_[i].push_back(series);
        }
      }
      for (std::vector<double>* series : series_[i]) {
        series->assign(rows, 0.0);
      }
    }
  }

  /// Before a step: where the last one has ended, and where this one starts.
  void begin(std::size_t row, int step, const typename Plant::State& state, const typename Plant::Inputs& inputs) {
    if (has_begun_) {
      end(state);
    }
    has_begun_ = true;
    row_ = row;
    step_ = step;
    inputs_ = inputs;
    for (std::size_t i = 0; i < Plant::kAxes; ++i) {
      angle_[i] = state.axes[i].y(Plant::AxisModel::kAngle);
      piston_[i] = state.axes[i].y(Plant::AxisModel::kPiston);
    }
    for (std::size_t i = 0; step == 0 && i < Plant::kAxes; ++i) {
      if (rests_[i]->has_bearing()) {
        rests_[i]->bearing.turned[0][row] = turned_of(i, state) - twist_[i];
        rests_[i]->bearing.turned[1][row] = turned_of(i ^ 1U, state);
      }
    }
  }

 private:
  /// After a step.
  void end(const typename Plant::State& after) {
    for (std::size_t i = 0; i < Plant::kAxes; ++i) {
      mean_[i] = 0.5 * (angle_[i] + after.axes[i].y(Plant::AxisModel::kAngle));
    }
    for (std::size_t i = 0; i < Plant::kAxes; ++i) {
      std::array<double, kSeries> values{motion_of(i, after), after.axes[i].spring_force, torque_of(i, after)};
      if (rests_[i]->has_bearing()) {
        const RestOfVehicle::Bearing& bearing = rests_[i]->bearing;
        const double fade = std::exp(-plant_.step_size() / bearing.loss_time);
        twist_[i] = fade * twist_[i] + (1.0 - fade) * bearing.flexibility * friction_of(i, after);
        values[3] = inputs_.vibration[i];
        values[4] = inputs_.vibration[i ^ 1U];
        values[5] = load_of(i / 2, after);
        values[6] = parameters_.gimbals[i / 2].bearing.vibration_under(thrust_of(i / 2));
      }
      for (std::size_t k = 0; k < series_[i].size(); ++k) {
        if (step_ == 0 && row_ + 1 < rows_) {
          (*series_[i][k])[row_] += (row_ == 0 ? 1.0 : 0.5) * values[k];
        }
        if (step_ == steps_ - 1 && row_ + 1 < rows_) {
          (*series_[i][k])[row_ + 1] += (row_ + 2 == rows_ ? 1.0 : 0.5) * values[k];
        }
      }
    }
  }

  double thrust_of(std::size_t engine) const { return parameters_.gimbals[engine].bearing.thrust + inputs_.thrust[engine]; }

  model::Pose<double> pose_of(std::size_t engine) const {
    return plant_.geometry(static_cast<int>(engine)).at(mean_[2 * engine], mean_[2 * engine + 1]);
  }

  /// Mean motion of an attach point beyond the stroke that its engine's angles need: what the deflection of the load spring
  /// leaves.
  double motion_of(std::size_t axis, const typename Plant::State& after) const {
    const auto& own = after.axes[axis];
    const double piston = 0.5 * (piston_[axis] + own.y(Plant::AxisModel::kPiston));
    const double deflection = after.softening[axis] + own.spring_force / stiffness_[axis];
    return piston - pose_of(axis / 2).stroke[axis % 2] - deflection;
  }

  /// Mean torque against an engine by the rotation of the vehicle and by a misaligned thrust. The structure has it with the
  /// friction and with what the engine's own angle does.
  double torque_of(std::size_t axis, const typename Plant::State& after) const {
    const auto& engine = parameters_.axes[axis].engine;
    const double of_engine = engine.duct_stiffness * mean_[axis] + engine.viscous_damping * rate_of_engine(axis, after);
    const auto& bearing = parameters_.gimbals[axis / 2].bearing;
    const double arm = axis % 2 == 0 ? bearing.pitch_misalignment : bearing.yaw_misalignment;
    return after.structure.forces(static_cast<Eigen::Index>(Plant::kAxes + axis)) - of_engine - friction_of(axis, after) +
           arm * thrust_of(axis / 2);
  }

  double rate_of_engine(std::size_t axis, const typename Plant::State& after) const {
    return (after.axes[axis].y(Plant::AxisModel::kAngle) - angle_[axis]) / plant_.step_size();
  }

  static double friction_of(std::size_t axis, const typename Plant::State& after) {
    const model::Pair<double>& friction = after.gimbals[axis / 2].torque;
    return axis % 2 == 0 ? friction.pitch : friction.yaw;
  }

  /// Rotation of the vehicle's side of a bearing, and of the bearing, about an axis.
  static double turned_of(std::size_t axis, const typename Plant::State& state) {
    const auto own = static_cast<Eigen::Index>(axis);
    const model::Pair<double> bearing = state.gimbals[axis / 2].bearing.rotation();
    return state.structure.displacement(static_cast<Eigen::Index>(Plant::kAxes) + own) + state.structure.residual(own) +
           (axis % 2 == 0 ? bearing.pitch : bearing.yaw);
  }

  /// Size of the force through a bearing, as `model::Vehicle` has it.
  double load_of(std::size_t engine, const typename Plant::State& after) const {
    const model::Pose<double> pose = pose_of(engine);
    const auto own = static_cast<Eigen::Index>(2 * engine);
    return (pose.thrust * (thrust_of(engine) + parameters_.gimbals[engine].bearing.dead_load) +
            pose.direction[0] * after.structure.forces(own) + pose.direction[1] * after.structure.forces(own + 1) +
            inputs_.force[engine])
        .norm();
  }

  static constexpr std::size_t kSeries = 7;

  const Plant& plant_;
  const typename Plant::Parameters& parameters_;
  std::size_t rows_;
  int steps_;
  std::array<RestOfVehicle*, Plant::kAxes> rests_{};
  std::array<std::vector<std::vector<double>*>, Plant::kAxes> series_;  ///< of means over a step
  std::array<double, Plant::kAxes> twist_{};                            ///< of a bearing by its friction [rad]
  std::size_t row_ = 0;
  int step_ = 0;
  // Where the step starts: a copy of the whole state would be hundreds of kilobytes a step.
  bool has_begun_ = false;
  std::array<double, Plant::kAxes> stiffness_{};  ///< of the load springs [N/m]
  std::array<double, Plant::kAxes> angle_{};
  std::array<double, Plant::kAxes> piston_{};
  typename Plant::Inputs inputs_;
  std::array<double, Plant::kAxes> mean_{};
};

/// Runs one record, and fills what `run` has of it.
template <class Plant>
bool run_record(const typename Plant::Parameters& parameters, const VehicleAxes& vehicle, std::size_t e, CoupledRun& run) {
  const Record& record = vehicle.axes.front().records[e];
  std::array<std::span<const double>, Plant::kAxes> commands;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i] = vehicle.axes[i].inputs[e];
    run.prediction[i][e].assign(Plant::kChannels, std::vector<double>(record.rows));
    run.motion[i][e] = {std::vector<double>(record.rows), std::vector<double>(record.rows),
                        std::vector<double>(record.rows)};
  }
  const int steps = model::steps_per_period(record.period);
  const auto plant = std::make_unique<const Plant>(parameters, record.period / steps);
  const VehicleDisturbances<Plant> disturbances(vehicle.disturbances[e], parameters, steps);
  typename Plant::Inputs first;
  disturbances.put(0, 0, first);
  std::optional<AroundAxes<Plant>> around;
  if (has_more_than_springs(parameters)) {
    around.emplace(*plant, parameters, record.rows, steps, run.vehicle, e);
  }
  const auto disturb = [&](std::size_t row, int step, const auto& state, typename Plant::Inputs& inputs) {
    disturbances.put(row, step, inputs);
    if (around) {
      around->begin(row, step, state, inputs);
    }
  };
  return run_vehicle(*plant, commands, record.start, steps, first, disturb, [&](std::size_t row, const auto& state) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      for (std::size_t channel = 0; channel < Plant::kChannels; ++channel) {
        run.prediction[i][e][channel][row] = Plant::measured(state)[i * Plant::kChannels + channel];
      }
      run.motion[i][e].angle[row] = state.axes[i].y(Plant::AxisModel::kAngle);
      run.motion[i][e].rate[row] = state.axes[i].y(Plant::AxisModel::kAngleRate);
      run.motion[i][e].force[row] = state.axes[i].spring_force;
    }
  });
}

template <class Plant>
bool run_plant(const typename Plant::Parameters& parameters, const VehicleAxes& vehicle, unsigned threads, CoupledRun& run) {
  const std::size_t records = vehicle.disturbances.size();
  run.prediction.assign(Plant::kAxes, Prediction(records));
  run.zeros.resize(Plant::kAxes);
  run.motion.assign(Plant::kAxes, std::vector<OtherAxis>(records));
  run.vehicle.assign(Plant::kAxes, std::vector<RestOfVehicle>(records));
  std::atomic<bool> finite{true};
  parallel_for(records, threads, [&](std::size_t e) {
    if (!run_record<Plant>(parameters, vehicle, e, run)) {
      finite = false;
    }
  });
  return finite;
}

}  // namespace

bool run_vehicle_of(const TaosParameters& parameters, const VehicleAxes& vehicle, unsigned threads, CoupledRun& run) {
  return run_plant<model::Taos<double>>(parameters, vehicle, threads, run);
}

bool run_vehicle_of(const MasvParameters& parameters, const VehicleAxes& vehicle, unsigned threads, CoupledRun& run) {
  return run_plant<model::Masv<double>>(parameters, vehicle, threads, run);
}

}  // namespace hotfire::explain
