// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "tools/linear/harmonic_balance.hpp"
#include "tools/loop/controller.hpp"
#include "tools/loop/stage.hpp"

namespace hotfire::loop {

/// A controller around a stage: the vehicle's loop, cut at the command of its engines. The open loop is minus the command
/// that comes back for a command of 1, so that it is -1 where the closed loop oscillates.
class VehicleLoop {
 public:
  /// `plant` is made for records of the controller's period and must live as long, like `stage` and `controller`. Throws
  /// FileError for a delay that is no whole number of the model's steps.
  VehicleLoop(const linear::Plant& plant, const Stage& stage, const Controller& controller);

  /// The open loop in small deviations, as the sampled system that it is: exact.
  Complex small_signal(double frequency) const;

  /// True if the closed loop is stable in small deviations. Nothing for a measured controller.
  std::optional<bool> is_stable() const;

  /// The open loop by describing functions under commands of `amplitude` [rad], the same to every engine of the controller's
  /// axis: the plant gives the fundamental of every engine angle, the rest is linear. Nothing where no balance was found.
  /// What was computed before is remembered, and the search starts from the nearest of it.
  std::optional<Complex> described(double frequency, double amplitude);

 private:
  struct Known {
    double frequency;
    double amplitude;
    Complex loop;
    linear::Balance balance;
  };

  const linear::Plant& plant_;
  const Stage& stage_;
  const Controller& controller_;
  std::vector<double> commanded_{};  ///< 1 for the axes that are commanded
  double step_;
  int whole_periods_ = 0;  ///< of the delay
  // From the sum of the commands to attitude and rate over a period: x+ = a x + late u(k-1) + own u(k), y = c x.
  Eigen::MatrixXd a_{};
  Eigen::VectorXd late_{};  ///< of the command of the sample before, which acts until the delay is over
  Eigen::VectorXd own_{};   ///< of the sample's own command
  Eigen::MatrixXd c_{};
  std::unique_ptr<linear::HarmonicBalance> balance_{};
  std::vector<std::size_t> engines_{};  ///< places of the engine angles among the outputs
  std::vector<Known> known_{};
};

}  // namespace hotfire::loop
