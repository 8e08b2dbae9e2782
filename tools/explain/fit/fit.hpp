// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/explain/fit/tangent.hpp"

namespace hotfire::explain {

/// How far the residuals of each channel are inflated against sensor noise: one sample of channel c counts as 1/temper[c]
/// samples of noise. A model with a missing effect leaves residuals that are large and coloured; without this they would
/// press declared parameters through their tolerances. 1 where the model reaches the noise.
///
/// What is missing in a model is beside the noise of a record, not times it: with t = (temper - 1) times the channel's mean
/// noise variance over all records, a sample of a record of noise v counts as v^2 / (v^2 + t) samples of its noise.
using Temper = std::vector<double>;

/// A parameterised model at a point, and how it fits.
struct Fitted {
  ModelParameters base;             ///< active effects, laws and fixed values
  std::vector<FreeParameter> free;  ///< what the fit moved
  std::vector<double> u;            ///< where it ended
  Temper temper;
  Eigen::MatrixXd normal;  ///< J^T J of the last derivative, priors included
  bool converged = false;
  bool chaotic = false;  ///< narrow derivatives ran away where it ended

  /// `base` with what the fit moved where it ended.
  ModelParameters parameters() const { return with_values(base, free, u); }
};

/// Derivatives of the declared parameters, frozen at a calibrated model: while candidates are screened, the declared
/// parameters move linearly and only the candidate is simulated with derivatives.
struct Frozen {
  std::vector<double> u;
  Eigen::MatrixXd jacobian;
};

struct FitOptions {
  int iterations = 30;
  unsigned threads = 1;
  double tolerance = 1e-5;         ///< relative change of the cost at which a fit has converged
  Slopes slopes = Slopes::narrow;  ///< how derivatives are asked for
  const Frozen* frozen = nullptr;  ///< for the first frozen->u.size() parameters
};

/// Minimises the weighted simulation error plus the priors of the declared tolerances from `fitted.u` (Levenberg-Marquardt
/// in Ceres), and leaves the result there. False if the start itself can't be simulated.
bool fit(const Evaluator& evaluator, Fitted& fitted, const FitOptions& options);

/// Simulations and derivatives for fits of `fitted`, which must live as long and keep its base and its parameters. Several
/// fits in a row, each under another temper, share them.
Tangent tangent_of(const Evaluator& evaluator, const Fitted& fitted, const FitOptions& options);
bool fit(const Evaluator& evaluator, Fitted& fitted, const FitOptions& options, Tangent& tangent);

/// The temper that residuals ask for: mean square times statistical inefficiency over the channel's mean noise variance, at
/// least 1.
Temper temper_of(const Evaluator& evaluator, const Eigen::VectorXd& residual);

/// What one over sensor noise of every residual counts under a temper: the root of the share of its variance that is noise.
Eigen::VectorXd weights_of(const Evaluator& evaluator, const Temper& temper);

}  // namespace hotfire::explain
