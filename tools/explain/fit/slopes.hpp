// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// How derivatives were taken: `narrow` along the branches of one run; `wide` by central differences over a tenth of a
/// parameter.
enum class Slopes { narrow, wide };

/// Half the width of a wide difference: in the coordinate of an effect's parameter, and in tolerances of a declared one.
double wide_step(const FreeParameter& parameter);

/// Derivatives of the residuals that a fit sees, as `Evaluator::differentiate`. Stick-slip motion can be chaotic: each
/// slip is set off or not, and narrow derivatives, those of one sequence of slips, run away. Wide ones then take their
/// place. They are taken outright where `asked` for. Returns which were taken, nothing if a simulation did not stay finite.
std::optional<Slopes> differentiate(const Evaluator& evaluator, const ModelParameters& base,
                                    std::span<const FreeParameter> free, std::span<const double> u,
                                    std::span<const std::size_t> wanted, Slopes asked, unsigned threads,
                                    Eigen::MatrixXd& jacobian);

}  // namespace hotfire::explain
