// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/two_axes.hpp"

#include <algorithm>
#include <atomic>
#include <span>

#include "model/numerics/step_size.hpp"
#include "tools/explain/data/smoothing.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

using Taos = model::Taos<double>;

constexpr std::size_t kEngineChannel = 1;
static_assert(Taos::AxisModel::channels[kEngineChannel] == "engine");

[[noreturn]] void refuse(const VehicleFile& vehicle, words::Unsupported part) {
  throw FileError(words::unsupported(vehicle.path.string(), part));
}

/// The parameters of a model that can be explained.
const TaosParameters& explainable(const VehicleFile& vehicle) {
  const auto* taos = std::get_if<TaosParameters>(&vehicle.parameters);
  if (taos == nullptr) {
    refuse(vehicle, words::Unsupported::masv);
  }
  const auto& gimbal = taos->gimbals.front();
  if (gimbal.friction.rubs() || gimbal.vibration.pitch_velocity > 0.0 || gimbal.vibration.yaw_velocity > 0.0 ||
      gimbal.compliant) {
    refuse(vehicle, words::Unsupported::gimbal);
  }
  const auto& bearing = gimbal.bearing;
  if (bearing.pitch_misalignment != 0.0 || bearing.yaw_misalignment != 0.0 || bearing.unloaded_structure < 1.0) {
    refuse(vehicle, words::Unsupported::thrust);
  }
  if (taos->modes.modes > 0 || !taos->modes.residual.isZero(0.0)) {
    refuse(vehicle, words::Unsupported::modes);
  }
  if (vehicle.sensors.piston.lag > 0.0) {
    refuse(vehicle, words::Unsupported::piston_lag);
  }
  for (const AxisDeclaration& axis : vehicle.axes) {
    if (!taos->constant_arms.front() && axis.tolerance.contains("actuator.moment_arm")) {
      refuse(vehicle, words::Unsupported::arm_tolerance);
    }
  }
  return *taos;
}

/// The channels of one axis, under the names that an axis alone has, and those of the engine.
Record record_of_axis(const Record& record, const std::string& axis) {
  Record own;
  own.path = record.path;
  own.name = record.name;
  own.start = record.start;
  own.period = record.period;
  own.rows = record.rows;
  for (const Channel& channel : record.channels) {
    if (const auto dot = channel.name.rfind('.'); dot != std::string::npos && channel.name.substr(dot + 1) == axis) {
      own.channels.push_back({channel.name.substr(0, dot), channel.unit, channel.values});
    } else if (channel.name == "thrust" || channel.name.starts_with("force.")) {
      own.channels.push_back(channel);
    }
  }
  if (own.find("command") == nullptr) {
    own.channels.push_back({"command", "rad", std::vector<double>(record.rows, 0.0)});
  }
  return own;
}

bool has_measurement(const Record& record) {
  return std::any_of(Taos::AxisModel::channels.begin(), Taos::AxisModel::channels.end(),
                     [&](std::string_view channel) { return record.find(std::string(channel)) != nullptr; });
}

/// Every record has the channels of the axes that any has.
void require_same_axes(const AxisOfTwo& axis) {
  for (const Record& record : axis.records) {
    if (axis.measured && !has_measurement(record)) {
      throw FileError(words::axis_not_measured(record.path.string(), axis.name));
    }
  }
}

}  // namespace

TwoAxes axes_of(const VehicleFile& vehicle, const std::vector<Record>& records, const std::vector<Exclusion>& exclusions) {
  const TaosParameters& taos = explainable(vehicle);
  for (const Record& record : records) {
    if (record.find("command.pitch") == nullptr && record.find("command.yaw") == nullptr) {
      require_channel(record, "command.pitch", words::drives_both_axes());
    }
  }
  TwoAxes axes;
  const std::vector<std::string> names = axis_names(Taos::kEngines);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    AxisOfTwo& axis = axes[i];
    axis.name = names[i];
    auto parameters = taos.axes[i];
    parameters.actuator.moment_arm = Taos::geometry_of(taos, 0).at(0.0, 0.0).arm[i][i];
    const AxisDeclaration& declared = vehicle.axes[i];
    axis.model = {vehicle.path, vehicle.name, parameters, declared.noise, declared.tolerance, declared.left_out};
    for (const Record& record : records) {
      axis.records.push_back(record_of_axis(record, axis.name));
      axis.inputs.push_back(held_where_missing(*axis.records.back().find("command"), record));
      axis.torque.push_back(torque_of(axis.records.back(), exclusions));
      axis.measured = axis.measured || has_measurement(axis.records.back());
    }
    require_same_axes(axis);
    if (axis.measured) {
      axis.data = make_dataset(axis.model, axis.records, exclusions);
      axis.data.geometry = {i, taos.constant_arms.front(), {taos.attach[0], taos.attach[1]}};
    }
  }
  if (!axes[0].measured && !axes[1].measured) {
    require_channel(records.front(), "piston.pitch", words::nothing_to_explain());
  }
  return axes;
}

std::optional<CoupledRun> run_coupled(const TaosParameters& parameters, const TwoAxes& axes, unsigned threads) {
  const std::size_t records = axes[0].records.size();
  CoupledRun run;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    run.prediction[i].resize(records);
    run.motion[i].resize(records);
  }
  std::atomic<bool> finite{true};
  parallel_for(records, threads, [&](std::size_t e) {
    const Record& record = axes[0].records[e];
    std::array<std::span<const double>, Taos::kAxes> commands;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      commands[i] = axes[i].inputs[e];
      run.prediction[i][e].assign(Taos::kChannels, std::vector<double>(record.rows));
      run.motion[i][e] = {std::vector<double>(record.rows), std::vector<double>(record.rows),
                          std::vector<double>(record.rows)};
    }
    const int steps = model::steps_per_period(record.period);
    const Taos plant(parameters, record.period / steps);
    const auto interpolated = [&](const AxisOfTwo& axis) {
      return Excitation(axis.torque[e], steps, Excitation::Between::interpolated);
    };
    const std::array<Excitation, Taos::kAxes> torque{interpolated(axes[0]), interpolated(axes[1])};
    const auto disturb = [&](std::size_t row, int step, auto&, Taos::Inputs& inputs) {
      for (std::size_t i = 0; i < axes.size(); ++i) {
        inputs.torque[i] = axes[i].torque[e].empty() ? 0.0 : torque[i](row, step);
      }
    };
    const bool ran = run_vehicle(plant, commands, record.start, steps, {}, disturb, [&](std::size_t row, const auto& state) {
      for (std::size_t i = 0; i < axes.size(); ++i) {
        for (std::size_t channel = 0; channel < Taos::kChannels; ++channel) {
          run.prediction[i][e][channel][row] = Taos::measured(state)[i * Taos::kChannels + channel];
        }
        run.motion[i][e].angle[row] = state.axes[i].y(Taos::AxisModel::kAngle);
        run.motion[i][e].rate[row] = state.axes[i].y(Taos::AxisModel::kAngleRate);
        run.motion[i][e].force[row] = state.axes[i].spring_force;
      }
    });
    if (!ran) {
      finite = false;
    }
  });
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].measured) {
      run.zeros[i] = add_zeros(axes[i].data, run.prediction[i]);
    }
  }
  return finite ? std::optional(std::move(run)) : std::nullopt;
}

void put_beside(const CoupledRun& run, TwoAxes& axes) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::size_t o = 1 - i;
    for (std::size_t e = 0; e < axes[i].data.experiments.size(); ++e) {
      OtherAxis other = run.motion[o][e];
      if (axes[o].measured && !axes[o].data.experiments[e].measured[kEngineChannel].empty()) {
        const Experiment& measured = axes[o].data.experiments[e];
        Series missed = measured.measured[kEngineChannel];
        for (std::size_t row = 0; row < missed.size(); ++row) {
          missed[row] -= run.prediction[o][e][kEngineChannel][row];
        }
        for (const Block& block : measured.excluded) {
          std::fill(missed.begin() + static_cast<std::ptrdiff_t>(block.first),
                    missed.begin() + static_cast<std::ptrdiff_t>(block.last), 0.0);
        }
        missed = smoothed(missed, measured.period, smoothing_frequency(measured.period));
        const Series rate = rate_of(missed, measured.period);
        for (std::size_t row = 0; row < missed.size(); ++row) {
          other.angle[row] += missed[row];
          other.rate[row] += rate[row];
        }
      }
      axes[i].data.experiments[e].other = std::move(other);
    }
  }
}

}  // namespace hotfire::explain
