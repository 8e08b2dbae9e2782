#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "hal/plant_bus.hpp"
#include "model/direct.hpp"
#include "model/simplex.hpp"
#include "model/step_size.hpp"

namespace hotfire::firmware {

/// A model behind the plant's side of a bus: one period a step, split into equal steps of the model. At rest at zero first.
template <class Model>
class Plant {
 public:
  /// `period` in s.
  Plant(const typename Model::Parameters& parameters, double period)
      : steps_(model::steps_per_period(period)), model_(parameters, period / steps_), state_(start()) {}

  void step(const hal::Command& command) noexcept {
    for (int i = 0; i < steps_; ++i) {
      model_.step(state_, command.values[0]);
    }
  }

  /// What the sensors read, in the order of `Model::channels`.
  std::span<const double> measured() const noexcept { return Model::measured(state_); }

 private:
  typename Model::State start() const {
    if constexpr (requires { model_.steady(0.0); }) {
      return model_.steady(0.0);
    } else {
      return model_.at_rest(0.0);
    }
  }

  int steps_;
  Model model_;
  typename Model::State state_;
};

}  // namespace hotfire::firmware
