// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/vehicle/vehicle_axes.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "tools/explain/data/smoothing.hpp"
#include "tools/explain/vehicle/axis_parameters.hpp"
#include "tools/explain/vehicle/string_angles.hpp"
#include "tools/explain/vehicle/vehicle_run.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

using AxisModel = model::Simplex<double>;

constexpr std::size_t kEngineChannel = 1;
static_assert(AxisModel::channels[kEngineChannel] == "engine");

[[noreturn]] void refuse(const VehicleFile& vehicle, words::Unsupported part) {
  throw FileError(words::unsupported(vehicle.path.string(), part));
}

/// Refuses a model that cannot be explained.
template <class Parameters>
void require_explainable(const VehicleFile& vehicle, const Parameters& parameters) {
  for (const auto& gimbal : parameters.gimbals) {
    if (gimbal.vibration.pitch_velocity > 0.0 || gimbal.vibration.yaw_velocity > 0.0) {
      refuse(vehicle, words::Unsupported::vibration);
    }
  }
  if (vehicle.sensors.piston.lag > 0.0) {
    refuse(vehicle, words::Unsupported::piston_lag);
  }
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    if (!parameters.constant_arms[i / 2] && vehicle.axes[i].tolerance.contains("actuator.moment_arm")) {
      refuse(vehicle, words::Unsupported::arm_tolerance);
    }
  }
}

/// The disturbances to which a vehicle responds.
struct Responses {
  bool to_thrust = false;
  bool to_force = false;
  bool to_vibration = false;

  bool operator()(std::string_view channel) const {
    return channel.starts_with("torque") || (to_thrust && channel.starts_with("thrust")) ||
           (to_force && channel.starts_with("force.")) || (to_vibration && channel.starts_with("vibration."));
  }
};

template <class Parameters>
Responses responses_of(const Parameters& parameters) {
  Responses responses;
  for (const auto& gimbal : parameters.gimbals) {
    const auto& bearing = gimbal.bearing;
    const bool feels_load = gimbal.compliant || gimbal.friction.coefficient > 0.0;
    responses.to_vibration = responses.to_vibration || gimbal.friction.rubs();
    responses.to_force = responses.to_force || feels_load;
    responses.to_thrust = responses.to_thrust || feels_load || bearing.pitch_misalignment != 0.0 ||
                          bearing.yaw_misalignment != 0.0 || (gimbal.friction.rubs() && bearing.rated_thrust > 0.0) ||
                          bearing.unloaded_structure < 1.0;
  }
  return responses;
}

/// The axis at the end of a channel's name; empty if it is of none.
std::string_view axis_of(std::string_view channel, const std::vector<std::string>& axes) {
  const auto dot = channel.rfind('.');
  const std::string_view end = dot == std::string_view::npos ? std::string_view() : channel.substr(dot + 1);
  return std::ranges::find(axes, end) != axes.end() ? end : std::string_view();
}

Record empty_record(const Record& like) {
  Record record;
  record.path = like.path;
  record.name = like.name;
  record.start = like.start;
  record.period = like.period;
  record.rows = like.rows;
  record.first_line = like.first_line;
  return record;
}

/// The channels of one axis, under the names that an axis alone has, and those of no axis to which the vehicle does not
/// respond: every axis has them, so that they are named once.
Record record_of_axis(const Record& record, const std::vector<std::string>& axes, const std::string& axis,
                      const Responses& responses) {
  Record own = empty_record(record);
  for (const Channel& channel : record.channels) {
    const std::string_view of = axis_of(channel.name, axes);
    if (of == axis && (!responses(channel.name) || channel.name.starts_with("torque"))) {
      own.channels.push_back({channel.name.substr(0, channel.name.size() - axis.size() - 1), channel.unit, channel.values});
    } else if (of.empty() && !responses(channel.name)) {
      own.channels.push_back(channel);
    }
  }
  if (own.find("command") == nullptr) {
    own.channels.push_back({"command", "rad", std::vector<double>(record.rows, 0.0)});
  }
  return own;
}

/// What acts on the engines of a vehicle, `bridged` over excluded rows.
Record disturbances_in(const Record& record, const Responses& responses, const std::vector<Exclusion>& exclusions) {
  Record own = empty_record(record);
  for (const Channel& channel : record.channels) {
    if (responses(channel.name)) {
      own.channels.push_back({channel.name, channel.unit, load_of(channel, record, exclusions)});
    }
  }
  return own;
}

bool has_measurement(const Record& record) {
  return std::any_of(AxisModel::channels.begin(), AxisModel::channels.end(),
                     [&](std::string_view channel) { return record.find(std::string(channel)) != nullptr; });
}

/// Every record has the channels of the axes that any has.
void require_same_axes(const AxisOfVehicle& axis) {
  for (const Record& record : axis.records) {
    if (axis.measured && !has_measurement(record)) {
      throw FileError(words::axis_not_measured(record.path.string(), axis.name));
    }
  }
}

template <class Plant>
VehicleAxes axes_of_plant(const VehicleFile& vehicle, const typename Plant::Parameters& parameters,
                          const std::vector<Record>& records, const std::vector<Exclusion>& exclusions) {
  require_explainable(vehicle, parameters);
  const std::vector<std::string> names = axis_names(Plant::kEngines);
  for (const Record& record : records) {
    if (std::ranges::none_of(names, [&](const auto& name) { return record.find("command." + name) != nullptr; })) {
      require_channel(record, "command." + names[0], words::drives_axes(names));
    }
  }
  const Responses responses = responses_of(parameters);
  VehicleAxes split;
  for (const Record& record : records) {
    split.disturbances.push_back(disturbances_in(record, responses, exclusions));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    AxisOfVehicle& axis = split.axes.emplace_back();
    const std::size_t engine = i / 2;
    axis.name = names[i];
    SimplexParameters own = alone<typename Plant::Effects>(parameters.axes[i]);
    own.actuator.moment_arm = Plant::geometry_of(parameters, engine).at(0.0, 0.0).arm[i % 2][i % 2];
    const AxisDeclaration& declared = vehicle.axes[i];
    axis.model = {vehicle.path, vehicle.name, own, declared.noise, declared.tolerance, declared.left_out};
    for (const Record& record : records) {
      axis.records.push_back(record_of_axis(record, names, axis.name, responses));
      axis.inputs.push_back(held_where_missing(*axis.records.back().find("command"), record));
      axis.measured = axis.measured || has_measurement(axis.records.back());
    }
    require_same_axes(axis);
    if (axis.measured) {
      axis.data = make_dataset(axis.model, axis.records, exclusions);
      axis.data.geometry = {i % 2,
                            parameters.constant_arms[engine],
                            {parameters.attach[2 * engine], parameters.attach[2 * engine + 1]},
                            parameters.gimbals[engine].friction};
      axis.data.known_effects = known_effects<typename Plant::Effects>();
    }
  }
  if (std::ranges::none_of(split.axes, &AxisOfVehicle::measured)) {
    require_channel(records.front(), "piston." + names[0], words::nothing_to_explain());
  }
  return split;
}

/// What a measured angle says beyond the simulated one, below about 12 Hz; nothing where it is excluded.
Series missed_angle(const Experiment& measured, const Series& simulated) {
  Series missed = measured.measured[kEngineChannel];
  for (std::size_t row = 0; row < missed.size(); ++row) {
    missed[row] -= simulated[row];
  }
  for (const Block& block : measured.excluded) {
    std::fill(missed.begin() + static_cast<std::ptrdiff_t>(block.first),
              missed.begin() + static_cast<std::ptrdiff_t>(block.last), 0.0);
  }
  return smoothed(missed, measured.period, smoothing_frequency(measured.period));
}

}  // namespace

const AxisOfVehicle& VehicleAxes::first_measured() const { return *std::ranges::find_if(axes, &AxisOfVehicle::measured); }

VehicleAxes axes_of(const VehicleFile& vehicle, const std::vector<Record>& records,
                    const std::vector<Exclusion>& exclusions) {
  std::vector<Record> with_angles;
  with_angles.reserve(records.size());
  for (const Record& record : records) {
    with_angles.push_back(with_string_angles(vehicle, record));
  }
  return std::visit(
      [&](const auto& parameters) {
        using Parameters = std::remove_cvref_t<decltype(parameters)>;
        return axes_of_plant<VehicleOf<Parameters>>(vehicle, parameters, with_angles, exclusions);
      },
      vehicle.parameters);
}

std::optional<CoupledRun> run_coupled(const VehicleParameters& parameters, const VehicleAxes& vehicle, unsigned threads) {
  CoupledRun run;
  const bool ran = std::visit([&](const auto& own) { return run_vehicle_of(own, vehicle, threads, run); }, parameters);
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    if (vehicle.axes[i].measured) {
      run.zeros[i] = add_zeros(vehicle.axes[i].data, run.prediction[i]);
    }
  }
  return ran ? std::optional(std::move(run)) : std::nullopt;
}

void put_beside(const CoupledRun& run, VehicleAxes& vehicle) {
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    const std::size_t o = i ^ 1U;
    const AxisOfVehicle& partner = vehicle.axes[o];
    for (std::size_t e = 0; e < vehicle.axes[i].data.experiments.size(); ++e) {
      OtherAxis other = run.motion[o][e];
      if (partner.measured && !partner.data.experiments[e].measured[kEngineChannel].empty()) {
        const Experiment& measured = partner.data.experiments[e];
        const Series missed = missed_angle(measured, run.prediction[o][e][kEngineChannel]);
        const Series rate = rate_of(missed, measured.period);
        for (std::size_t row = 0; row < missed.size(); ++row) {
          other.angle[row] += missed[row];
          other.rate[row] += rate[row];
        }
      }
      vehicle.axes[i].data.experiments[e].other = std::move(other);
      vehicle.axes[i].data.experiments[e].vehicle = run.vehicle[i][e];
    }
  }
}

}  // namespace hotfire::explain
