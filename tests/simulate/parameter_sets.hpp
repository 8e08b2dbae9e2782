// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "model/effects.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/simulate/batch/side_by_side.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire::test {

/// Parameter sets of one axis with friction, soft spring and dead band, as a dispersion draws them, on one record.
class ParameterSets {
 public:
  ParameterSets(std::size_t sets, std::size_t rows) : models_(sets) {
    for (std::size_t i = 0; i < sets; ++i) {
      models_[i].parameters = drawn(1.0 + 0.1 * static_cast<double>(i) / static_cast<double>(sets));
    }
    inputs_.period = 2e-3;
    inputs_.rows = rows;
    inputs_.channels.push_back({"command", "rad", {}});
    for (std::size_t row = 0; row < rows; ++row) {
      inputs_.channels.back().values.push_back(0.02 * std::sin(0.018 * static_cast<double>(row)) +
                                               (row % 200 > 100 ? 0.01 : 0.0));
    }
    for (const ModelFile& model : models_) {
      runs_.push_back({&model, &inputs_});
    }
  }

  double simulated_seconds() const {
    return static_cast<double>(runs_.size()) * static_cast<double>(inputs_.rows) * inputs_.period;
  }

  void simulate_alone() const {
    for (const OpenLoopRun& run : runs_) {
      simulate(*run.model, *run.inputs);
    }
  }

  void simulate_together() const {
    for (const std::vector<std::size_t>& group : groups_side_by_side(runs_, 1)) {
      std::vector<OpenLoopRun> members;
      for (const std::size_t member : group) {
        members.push_back(runs_[member]);
      }
      simulate_side_by_side(members);
    }
  }

 private:
  static SimplexParameters drawn(double more) {
    SimplexParameters parameters;
    parameters.servovalve.position_gain *= more;
    add_effect<model::GimbalFriction>(parameters, [&](auto& values) {
      values.coulomb_torque = 8e3 * more;
      values.static_ratio = 1.2;
      values.damping = 1e3;
    });
    add_effect<model::SoftStiffness>(parameters, [&](auto& values) {
      values.low_stiffness = 4e7 / more;
      values.load_scale = 8e3;
    });
    add_effect<model::ValveDeadband>(parameters, [&](auto& values) { values.half_width = 0.02 * more; });
    return parameters;
  }

  std::vector<ModelFile> models_;
  Record inputs_;
  std::vector<OpenLoopRun> runs_;
};

}  // namespace hotfire::test
