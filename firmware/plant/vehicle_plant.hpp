// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "firmware/plant/declared_faults.hpp"
#include "firmware/plant/recorded_loads.hpp"
#include "firmware/plant/white_noise.hpp"
#include "hal/plant_bus.hpp"
#include "hal/recording/fnv1a.hpp"
#include "model/numerics/step_size.hpp"
#include "model/sensors/vehicle_sensors.hpp"
#include "model/vehicle.hpp"

namespace hotfire::firmware {

/// A vehicle with its engines, two actuators each, on one structure, behind the plant's side of a bus. A step advances it by
/// one period, in equal steps of the model. The actuators are in the order of the vehicle's axes: pitch and yaw of engine 1,
/// then of engine 2 and so on. It starts in the steady state at zero command, under the thrust of the first row of a record
/// that has one. It applies its declared faults and recorded disturbances.
template <class Vehicle>
class VehiclePlant {
 public:
  using Parameters = model::InstrumentedVehicle<Vehicle>;
  static constexpr std::string_view topology = Vehicle::topology;
  static constexpr auto channels = Vehicle::AxisModel::channels;
  static constexpr auto channel_units = Vehicle::AxisModel::channel_units;
  static constexpr std::string_view input_channel = Vehicle::AxisModel::input_channel;
  static constexpr std::string_view input_unit = Vehicle::AxisModel::input_unit;
  static_assert(Vehicle::kAxes <= hal::kMaxActuators);
  static_assert(Vehicle::kChannels == channels.size());

  /// `period` in s.
  explicit VehiclePlant(const Parameters& parameters, double period, const std::vector<PlayedFault>& faults = {},
                        const LoadRecord& recorded = {})
      : period_(period),
        steps_(model::steps_per_period(period)),
        vehicle_(parameters.vehicle, period / steps_),
        declared_thrust_(thrust_of(parameters.vehicle)),
        recorded_(recorded, period, steps_),
        state_(std::make_unique<State>(vehicle_.steady({}, first_thrust()))),
        modes_(static_cast<std::size_t>(parameters.vehicle.modes.modes)),
        sensors_(parameters.sensors, *state_),
        readings_(faults, period, Vehicle::kAxes, channels.size()),
        loads_(faults, period) {
    make_broken(parameters.vehicle, faults);
    readings_.start([this](std::span<double> readings) noexcept { measure(readings); });
  }

  int steps_per_cycle() const noexcept { return steps_; }

  void step(const hal::Command& command) noexcept {
    std::copy_n(command.values.begin(), Vehicle::kAxes, inputs_.commands.begin());
    const bool is_loaded = loads_.any() || recorded_.any();
    const Vehicle& vehicle = vehicle_now();
    for (int i = 0; i < steps_; ++i) {
      if (is_loaded) {
        put_loads(i);
      }
      vehicle.step(*state_, inputs_);
    }
    readings_.take([this](std::span<double> readings) noexcept { measure(readings); });
    if (has_strings_) {
      sensors_.read_strings(*state_, period_, string_noise_);
    }
  }

  static constexpr std::size_t actuators() noexcept { return Vehicle::kAxes; }

  /// Readings of the sensors, actuator after actuator, in the order of `channels`.
  std::span<const double> measured() const noexcept { return readings_.values(); }

  /// Adds four string potentiometers to every engine, at the places that the vehicle's sensors declare. Before the first
  /// step.
  void string_up() noexcept {
    has_strings_ = true;
    sensors_.read_strings(*state_, period_, string_noise_);
  }

  /// Readings of the string potentiometers: the change of each length from zero angles [m], engine after engine.
  std::span<const double> strings() const noexcept {
    return has_strings_ ? std::span<const double>(sensors_.strings()) : std::span<const double>();
  }

  /// The readings of `measured` that are not sent, one bit each.
  std::uint32_t missing() const noexcept { return readings_.missing(); }

  /// Adds the continuous state of every axis, of the modes and of the gimbals, and the readings of the sensors. The memory
  /// of an effect is left out, because it acts on the state in the next step.
  void add_to(hal::Fnv1a& hash) const noexcept {
    for (const auto& axis : state_->axes) {
      hash.add(std::span(axis.y.data(), static_cast<std::size_t>(axis.y.size())));
    }
    for (std::size_t k = 0; k < modes_; ++k) {
      const auto& mode = state_->structure.modes[k];
      hash.add(std::array{mode.displacement, mode.velocity});
    }
    for (int e = 0; e < Vehicle::kEngines; ++e) {
      const auto& gimbal = state_->gimbals[static_cast<std::size_t>(e)];
      const auto& displacement = gimbal.bearing.displacement;
      hash.add(std::span(displacement.data(), static_cast<std::size_t>(displacement.size())));
      if (vehicle_.has_block(e)) {
        for (const auto& mode : gimbal.bearing.block.modes) {
          hash.add(std::array{mode.displacement, mode.velocity});
        }
      }
      hash.add(std::array{gimbal.bristle.pitch, gimbal.bristle.yaw});
    }
    hash.add(measured());
  }

 private:
  using State = typename Vehicle::State;

  /// The vehicle during a constant set of faults; it continues from the same state.
  struct Broken {
    Broken(std::uint64_t first, std::uint64_t end, const typename Vehicle::Parameters& parameters, double h)
        : from(first), to(end), vehicle(parameters, h) {}

    std::uint64_t from;
    std::uint64_t to;
    Vehicle vehicle;
  };

  /// The axes are coupled. Faults that overlap in time therefore need one vehicle with all of them: one for every interval
  /// of cycles between two times at which a fault begins or ends.
  void make_broken(const typename Vehicle::Parameters& parameters, const std::vector<PlayedFault>& faults) {
    std::vector<std::uint64_t> moments;
    for (const PlayedFault& fault : faults) {
      if (is_of_actuator(fault.kind)) {
        const CycleSpan cycles(fault, period_);
        moments.insert(moments.end(), {cycles.from, cycles.to});
      }
    }
    std::sort(moments.begin(), moments.end());
    for (std::size_t i = 1; i < moments.size(); ++i) {
      auto changed = std::make_unique<typename Vehicle::Parameters>(parameters);
      if (moments[i - 1] < moments[i] && put_those_at(moments[i - 1], faults, *changed)) {
        broken_.push_back(std::make_unique<Broken>(moments[i - 1], moments[i], *changed, vehicle_.step_size()));
      }
    }
  }

  /// False if there are none.
  bool put_those_at(std::uint64_t cycle, const std::vector<PlayedFault>& faults,
                    typename Vehicle::Parameters& parameters) const {
    bool any = false;
    for (const PlayedFault& fault : faults) {
      if (!is_of_actuator(fault.kind) || !CycleSpan(fault, period_).has(cycle)) {
        continue;
      }
      any = true;
      for (std::size_t axis = 0; axis < actuators(); ++axis) {
        if (fault.is_of(axis)) {
          put_into(parameters.axes[axis], fault);
        }
      }
    }
    return any;
  }

  const Vehicle& vehicle_now() const noexcept {
    for (const auto& one : broken_) {
      if (readings_.cycle() >= one->from && readings_.cycle() < one->to) {
        return one->vehicle;
      }
    }
    return vehicle_;
  }

  static std::array<double, Vehicle::kEngines> thrust_of(const typename Vehicle::Parameters& parameters) {
    std::array<double, Vehicle::kEngines> thrust{};
    for (std::size_t e = 0; e < thrust.size(); ++e) {
      thrust[e] = parameters.gimbals[e].bearing.thrust;
    }
    return thrust;
  }

  /// Of the first row of the record, beyond the declared one.
  std::array<double, Vehicle::kEngines> first_thrust() const noexcept {
    std::array<double, Vehicle::kEngines> thrust{};
    recorded_.act_in(0, 0, [&](RecordedKind kind, std::size_t engine, double value) {
      if (kind == RecordedKind::thrust) {
        thrust[engine] = value - declared_thrust_[engine];
      }
    });
    return thrust;
  }

  /// The loads on the engines in a plant step of the cycle: faults add to a recorded torque, and replace a recorded thrust.
  void put_loads(int step) noexcept {
    const std::uint64_t cycle = readings_.cycle();
    for (std::size_t axis = 0; axis < actuators(); ++axis) {
      inputs_.torque[axis] = loads_.torque(cycle, axis);
    }
    std::array<double, Vehicle::kEngines> thrust = declared_thrust_;
    recorded_.act_in(cycle, step, [&](RecordedKind kind, std::size_t place, double value) noexcept {
      switch (kind) {
        case RecordedKind::torque:
          inputs_.torque[place] += value;
          break;
        case RecordedKind::force:
          inputs_.force[place / 3](static_cast<Eigen::Index>(place % 3)) = value;
          break;
        case RecordedKind::vibration:
          inputs_.vibration[place] = value;
          break;
        case RecordedKind::thrust:
          thrust[place] = value;
          break;
      }
    });
    for (std::size_t e = 0; e < Vehicle::kEngines; ++e) {
      inputs_.thrust[e] = loads_.thrust(cycle, e, thrust[e]) - declared_thrust_[e];
    }
  }

  void measure(std::span<double> readings) noexcept {
    sensors_.read_pistons(*state_, period_, piston_noise_);
    const auto& measured = Vehicle::measured(*state_);
    std::copy(measured.begin(), measured.end(), readings.begin());
    for (std::size_t axis = 0; axis < actuators(); ++axis) {
      readings[axis * channels.size()] = sensors_.pistons()[axis];
    }
  }

  double period_;
  int steps_;
  Vehicle vehicle_;
  std::array<double, Vehicle::kEngines> declared_thrust_;  ///< [N]
  RecordedLoads recorded_;
  std::unique_ptr<State> state_;
  std::size_t modes_;
  typename Vehicle::Inputs inputs_;
  model::VehicleReadings<Vehicle> sensors_;
  WhiteNoise piston_noise_{101};
  WhiteNoise string_noise_{102};  ///< its own: what the pistons read does not depend on whether there are strings
  bool has_strings_ = false;
  PlayedReadings readings_;
  PlayedLoads loads_;
  std::vector<std::unique_ptr<Broken>> broken_;
};

}  // namespace hotfire::firmware
