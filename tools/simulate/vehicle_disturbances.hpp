// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tools/simulate/disturbances.hpp"
#include "tools/simulate/excitation.hpp"

namespace hotfire {

/// Everything in a record that acts on the engines of a vehicle beside its commands, as sampled signals: interpolated
/// between rows, but for a thrust, which is held like a command. The record and the parameters have to outlive it.
template <class Plant>
class VehicleDisturbances {
 public:
  /// `steps` plant steps a row. Throws FileError as `disturbances_of`.
  VehicleDisturbances(const Record& inputs, const typename Plant::Parameters& parameters, int steps)
      : parameters_(parameters) {
    for (const Disturbance& one : disturbances_of(inputs, parameters.gimbals)) {
      const auto between =
          one.kind == DisturbanceKind::thrust ? Excitation::Between::held : Excitation::Between::interpolated;
      signals_.push_back({one.kind, one.place, Excitation(one.channel->values, steps, between)});
    }
  }

  /// Puts those of plant step `step` of a row into the inputs of the plant.
  void put(std::size_t row, int step, typename Plant::Inputs& inputs) const {
    for (const Signal& signal : signals_) {
      const double value = signal.mean(row, step);
      switch (signal.kind) {
        case DisturbanceKind::torque:
          inputs.torque[signal.place] = value;
          break;
        case DisturbanceKind::force:
          inputs.force[signal.place / 3](static_cast<Eigen::Index>(signal.place % 3)) = value;
          break;
        case DisturbanceKind::vibration:
          inputs.vibration[signal.place] = value;
          break;
        case DisturbanceKind::thrust:
          inputs.thrust[signal.place] = value - parameters_.gimbals[signal.place].bearing.thrust;
          break;
      }
    }
  }

 private:
  struct Signal {
    DisturbanceKind kind{};
    std::size_t place = 0;
    Excitation mean;  ///< over plant step `step` of a row
  };

  const typename Plant::Parameters& parameters_;
  std::vector<Signal> signals_;
};

}  // namespace hotfire
