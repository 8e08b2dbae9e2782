// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/linear/plant/plant.hpp"

namespace hotfire::linear {

/// A step map in as few states as it has motions that outlast a step. What the model remembers of its own iterations dies
/// within one or two steps; it then is a function of the states that are kept and of the inputs:
///   every state = of_kept kept + of_input input,   next kept = a kept + b input.
/// Exact for inputs that change slowly against a step, and for any once the rest has died out.
struct ReducedMap {
  std::vector<int> kept;  ///< states of the map, in its order
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
  Eigen::MatrixXd of_kept;
  Eigen::MatrixXd of_input;
};

/// Powers of two by which the states of a square matrix are measured so that its rows and columns are of like size: an
/// eigenvalue solver needs it [Parlett and Reinsch 1969, Numer. Math. 13].
Eigen::VectorXd balancing(Eigen::MatrixXd a);

/// Throws UsageError if the map has no such states.
ReducedMap reduced(const StepMap& map);

/// x' = A x + B u in continuous time with the samples of x+ = a x + b u under an input held over the step `h` [s].
struct ContinuousMap {
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
  /// True: by the matrix logarithm, exact. False: a has a real eigenvalue that is not above zero and therefore no real
  /// logarithm; by the bilinear rule, whose frequencies are off by (2 pi f h)^2 / 12 of themselves.
  bool by_logarithm = true;
};

ContinuousMap continuous(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double h);

}  // namespace hotfire::linear
