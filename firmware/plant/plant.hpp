// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware/plant/declared_faults.hpp"
#include "firmware/plant/recorded_loads.hpp"
#include "hal/plant_bus.hpp"
#include "hal/recording/fnv1a.hpp"
#include "model/direct.hpp"
#include "model/imposed_motion.hpp"
#include "model/modal.hpp"
#include "model/numerics/step_size.hpp"
#include "model/sensors/string_potentiometer.hpp"
#include "model/simplex.hpp"

namespace hotfire::firmware {

/// One to `hal::kMaxActuators` equal models behind the plant's side of a bus, each with a command of its own. A step
/// advances them by one period, in equal steps of the model. They start at rest at zero. The plant applies its declared
/// faults and recorded disturbances: a recorded torque acts on the engine of every actuator.
template <class Model>
class Plant {
 public:
  using Parameters = typename Model::Parameters;
  static constexpr std::string_view topology = Model::topology;
  static constexpr auto channels = Model::channels;
  static constexpr auto channel_units = Model::channel_units;
  static constexpr std::string_view input_channel = Model::input_channel;
  static constexpr std::string_view input_unit = Model::input_unit;

  /// `period` in s.
  Plant(const Parameters& parameters, double period, std::size_t actuators = 1, const std::vector<PlayedFault>& faults = {},
        const LoadRecord& recorded = {})
      : steps_(model::steps_per_period<Model>(parameters, period)),
        model_(parameters, period / steps_),
        states_(actuators, start()),
        readings_(faults, period, actuators, channels.size()),
        loads_(faults, period),
        recorded_(recorded, period, steps_) {
    for (const PlayedFault& fault : faults) {
      if (is_of_actuator(fault.kind)) {
        broken_.emplace_back(fault, period, Model(broken(parameters, fault), period / steps_));
      }
    }
    readings_.start([this](std::span<double> readings) noexcept { measure(readings); });
  }

  void step(const hal::Command& command) noexcept {
    for (std::size_t actuator = 0; actuator < states_.size(); ++actuator) {
      const Model& model = model_of(actuator);
      for (int i = 0; i < steps_; ++i) {
        advance(model, actuator, command.values[actuator], i);
      }
    }
    readings_.take([this](std::span<double> readings) noexcept { measure(readings); });
    measure_strings();
  }

  std::size_t actuators() const noexcept { return states_.size(); }
  int steps_per_cycle() const noexcept { return steps_; }

  /// Readings of the sensors, actuator after actuator, in the order of `Model::channels`.
  std::span<const double> measured() const noexcept { return readings_.values(); }

  /// Gives every engine its four string potentiometers, at their representative places on a structure at rest.
  /// Actuators 1 and 2 are the pitch and the yaw of the first engine, and so on; an angle without an actuator is zero. For a
  /// model that has an engine; before the first step.
  void string_up() {
    static_assert(StringPotentiometers::kStrings * ((hal::kMaxActuators + 1) / 2) == hal::kMaxStrings);
    strings_.resize(StringPotentiometers::kStrings * ((states_.size() + 1) / 2));
    measure_strings();
  }

  /// Readings of the string potentiometers: the change of each length from zero angles [m], engine after engine.
  std::span<const double> strings() const noexcept { return strings_; }

  /// The readings of `measured` that are not sent, one bit each.
  std::uint32_t missing() const noexcept { return readings_.missing(); }

  /// Adds the continuous state of every actuator and the readings of its sensors. The memory of an effect is left out,
  /// because it acts on the state in the next step.
  void add_to(hal::Fnv1a& hash) const noexcept {
    for (const typename Model::State& state : states_) {
      hash.add(std::span(state.y.data(), static_cast<std::size_t>(state.y.size())));
    }
    hash.add(measured());
  }

 private:
  /// The model during a fault of its actuator; it continues from the same state.
  struct Broken {
    Broken(const PlayedFault& played, double period, const Model& as_it_is)
        : fault(played), cycles(played, period), model(as_it_is) {}

    PlayedFault fault;
    CycleSpan cycles;
    Model model;
  };

  static Parameters broken(Parameters parameters, const PlayedFault& fault) {
    put_into(parameters, fault);
    return parameters;
  }

  const Model& model_of(std::size_t actuator) const noexcept {
    for (const Broken& one : broken_) {
      if (one.fault.is_of(actuator) && one.cycles.has(readings_.cycle())) {
        return one.model;
      }
    }
    return model_;
  }

  /// The torque on an actuator's engine in a plant step of the cycle [N m].
  double torque_on(std::size_t actuator, int step) const noexcept {
    double sum = loads_.torque(readings_.cycle(), actuator);
    recorded_.act_in(readings_.cycle(), step, [&](RecordedKind, std::size_t, double value) noexcept { sum += value; });
    return sum;
  }

  void advance(const Model& model, std::size_t actuator, double command, int step) noexcept {
    if constexpr (requires { Model::kAngle; }) {
      if (const double torque = torque_on(actuator, step); torque != 0.0) {
        const double arm = model.parameters().actuator.moment_arm;
        model.step(states_[actuator], command, [=](double) { return model::Coupling<double>{0.0, arm, -torque}; });
        return;
      }
    }
    model.step(states_[actuator], command);
  }

  typename Model::State start() const {
    if constexpr (requires { model_.steady(0.0); }) {
      return model_.steady(0.0);
    } else {
      return model_.at_rest(0.0);
    }
  }

  using StringPotentiometers = model::StringPotentiometers<double>;

  void measure_strings() noexcept {
    if constexpr (requires { Model::kAngle; }) {
      const auto angle = [this](std::size_t actuator) {
        return actuator < states_.size() ? states_[actuator].y(Model::kAngle) : 0.0;
      };
      for (std::size_t i = 0; i < strings_.size(); i += StringPotentiometers::kStrings) {
        const std::size_t pitch = 2 * (i / StringPotentiometers::kStrings);
        const auto lengths = geometry_.lengths(angle(pitch), angle(pitch + 1), {0.0, 0.0, 0.0});
        std::copy(lengths.begin(), lengths.end(), strings_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }

  void measure(std::span<double> readings) const noexcept {
    auto next = readings.begin();
    for (const typename Model::State& state : states_) {
      const auto& measured = Model::measured(state);
      next = std::copy(measured.begin(), measured.end(), next);
    }
  }

  int steps_;
  Model model_;
  std::vector<typename Model::State> states_;
  PlayedReadings readings_;
  PlayedLoads loads_;
  RecordedLoads recorded_;
  StringPotentiometers geometry_{StringPotentiometers::representative()};
  std::vector<double> strings_;
  std::vector<Broken> broken_;
};

}  // namespace hotfire::firmware
