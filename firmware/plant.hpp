#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/plant_bus.hpp"
#include "hal/recording/fnv1a.hpp"
#include "model/direct.hpp"
#include "model/simplex.hpp"
#include "model/step_size.hpp"

namespace hotfire::firmware {

/// One to `hal::kMaxActuators` equal models behind the plant's side of a bus, each with a command of its own: one period a
/// step, split into equal steps of the model. At rest at zero first.
template <class Model>
class Plant {
 public:
  /// `period` in s.
  Plant(const typename Model::Parameters& parameters, double period, std::size_t actuators = 1)
      : steps_(model::steps_per_period(period)),
        model_(parameters, period / steps_),
        states_(actuators, start()),
        readings_(actuators * Model::channels.size()) {
    measure();
  }

  void step(const hal::Command& command) noexcept {
    for (std::size_t actuator = 0; actuator < states_.size(); ++actuator) {
      for (int i = 0; i < steps_; ++i) {
        model_.step(states_[actuator], command.values[actuator]);
      }
    }
    measure();
  }

  std::size_t actuators() const noexcept { return states_.size(); }

  /// What the sensors read, actuator after actuator, in the order of `Model::channels`.
  std::span<const double> measured() const noexcept { return readings_; }

  /// Adds the continuous state of every actuator and what its sensors read. What an effect remembers is not in it: it acts
  /// on the state in the next step.
  void add_to(hal::Fnv1a& hash) const noexcept {
    for (const typename Model::State& state : states_) {
      hash.add(std::span(state.y.data(), static_cast<std::size_t>(state.y.size())));
    }
    hash.add(measured());
  }

 private:
  typename Model::State start() const {
    if constexpr (requires { model_.steady(0.0); }) {
      return model_.steady(0.0);
    } else {
      return model_.at_rest(0.0);
    }
  }

  void measure() noexcept {
    auto next = readings_.begin();
    for (const typename Model::State& state : states_) {
      const auto& measured = Model::measured(state);
      next = std::copy(measured.begin(), measured.end(), next);
    }
  }

  int steps_;
  Model model_;
  std::vector<typename Model::State> states_;
  std::vector<double> readings_;
};

}  // namespace hotfire::firmware
