// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/actuator/axis.hpp"
#include "tools/explain/data/dataset.hpp"
#include "tools/explain/fit/bearing_in_vehicle.hpp"
#include "tools/simulate/excitation.hpp"

namespace hotfire::explain {

/// Steps one axis of a vehicle while the motion of everything else is given: the other axis of its engine, and what the rest
/// of the vehicle does (`RestOfVehicle`).
///
/// The structure moves the attach point as it did in the run of the whole vehicle. Where the axis has another force than in
/// that run, the attach point also gives way to the difference by its flexibility at rest. Force and motion are found
/// together, as `model::Vehicle` finds them: F = (1/K_T + C)^-1 (deflection without force, less what the spring's
/// nonlinearity took in the last evaluation). The friction of a bearing follows the axis's own slip beside the given one
/// about the other axis; where its torque is another than in that run, both sides of the bearing turn by their flexibility.
template <class Plant>
class AxisInVehicle {
 public:
  using S = typename Plant::Scalar;
  using State = typename Plant::State;

  /// `steps` plant steps a row, from `state` on.
  AxisInVehicle(const Plant& plant, const Dataset& data, const Experiment& experiment, const State& state, int steps)
      : plant_(plant),
        beside_(data.geometry, plant.parameters().actuator.moment_arm),
        other_angle_(interpolated(experiment.other.angle, steps)),
        other_rate_(interpolated(experiment.other.rate, steps)),
        other_force_(interpolated(experiment.other.force, steps)),
        measured_torque_(interpolated(experiment.torque, steps)),
        motion_(interpolated(experiment.vehicle.motion, steps)),
        force_(interpolated(experiment.vehicle.force, steps)),
        torque_(interpolated(experiment.vehicle.torque, steps)),
        is_loaded_(!experiment.torque.empty()),
        is_moved_(experiment.vehicle.is_there()),
        flexibility_(experiment.vehicle.flexibility) {
    if (experiment.vehicle.has_bearing()) {
      bearing_.emplace(data.geometry, experiment.vehicle.bearing, experiment.other.angle, steps, plant.step_size());
    }
    if (is_moved_) {
      const S& angle = state.y(Plant::kAngle);
      const auto coupling = beside_(angle, experiment.other.angle.front(), 0.0, experiment.other.force.front());
      const S motion = coupling.motion + experiment.vehicle.motion.front();
      softening_ = deflection(state.y(Plant::kPiston), angle, motion) - state.spring_force / plant_.stiffness();
    }
  }

  /// Advances by step `k` of a row.
  void step(State& state, const S& command, std::size_t row, int k) {
    other_.angle = other_angle_(row, k);
    other_.rate = other_rate_(row, k);
    other_.force = other_force_(row, k);
    further_torque_ = is_loaded_ ? -measured_torque_(row, k) : 0.0;
    if (!is_moved_) {
      plant_.step(state, command, [&](const S& angle) { return coupling_at(angle); });
      return;
    }
    further_torque_ += torque_(row, k);
    const double motion = motion_(row, k);
    const double force = force_(row, k);
    if (bearing_) {
      bearing_->go_to(row, k);
    }
    // A first guess, which the passes replace: it has no slope of its own.
    using model::value_of;
    softening_ = S(value_of(softening_));
    typename Plant::Advance advance;
    plant_.begin(state, command, advance);
    for (int pass = 0; pass < Plant::kPasses; ++pass) {
      plant_.predict(state, advance);
      const S angle = advance.mean(Plant::kAngle);
      const S piston = advance.mean(Plant::kPiston);
      model::Coupling<S> around = coupling_at(angle);
      around.motion += motion + flexibility_ * (state.spring_force - force);
      const S surplus = deflection(piston, angle, around.motion) - softening_ - state.spring_force / plant_.stiffness();
      around.motion += surplus * (flexibility_ / (1.0 / plant_.stiffness() + flexibility_));
      const bool is_last = pass + 1 == Plant::kPasses;
      if (bearing_) {
        // As in the vehicle, the first pass goes by the last step's friction.
        if (is_last) {
          bearing_->slide(advance.rate(Plant::kAngle, plant_.step_size()), plant_.engine_compliance());
        }
        around.torque += bearing_->torque();
      }
      const model::Keep keep = is_last ? model::Keep::yes : model::Keep::no;
      plant_.evaluate(state, advance, around, keep);
      softening_ = deflection(piston, angle, around.motion) - state.spring_force / plant_.stiffness();
    }
    plant_.finish(state, advance);
  }

 private:
  struct Other {
    double angle = 0.0;
    double rate = 0.0;
    double force = 0.0;
  };

  model::Coupling<S> coupling_at(const S& angle) const {
    model::Coupling<S> coupling = beside_(angle, other_.angle, other_.rate, other_.force);
    coupling.torque += further_torque_;
    return coupling;
  }

  /// Of the load spring before its effects.
  S deflection(const S& piston, const S& angle, const S& motion) const {
    return piston - plant_.parameters().actuator.moment_arm * angle - motion;
  }

  const Plant& plant_;
  Beside<S> beside_;
  Excitation other_angle_;
  Excitation other_rate_;
  Excitation other_force_;
  Excitation measured_torque_;
  Excitation motion_;
  Excitation force_;
  Excitation torque_;
  std::optional<BearingInVehicle<S>> bearing_;
  bool is_loaded_;
  bool is_moved_;
  double flexibility_;
  Other other_;
  double further_torque_ = 0.0;
  S softening_{0.0};  ///< deflection that a nonlinear spring takes beyond force / K_T [m]
};

}  // namespace hotfire::explain
