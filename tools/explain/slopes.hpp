#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "tools/explain/evaluator.hpp"

namespace hotfire::explain {

/// How a fit takes derivatives: `exact` by dual numbers; `wide` by central differences over a tenth of a parameter, for
/// motion that depends on its parameters roughly. Stick-slip does: each slip is set off or not, and the exact derivative is
/// that of one sequence of slips only.
enum class Slopes { exact, wide };

/// Residuals that a fit sees and their derivatives, as `Evaluator::differentiate`. Exact ones that ran away, as those of
/// chaotic motion do, are replaced by wide ones. Returns which were taken, nothing if a simulation did not stay finite.
template <class Family>
std::optional<Slopes> differentiate(const Evaluator<Family>& evaluator, const PlainParameters<Family>& base,
                                    std::span<const FreeParameter> free, std::span<const double> u,
                                    std::span<const std::size_t> wanted, unsigned threads, Slopes slopes,
                                    Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian);

extern template std::optional<Slopes> differentiate(const Evaluator<SimplexFamily>&, const PlainParameters<SimplexFamily>&,
                                                    std::span<const FreeParameter>, std::span<const double>,
                                                    std::span<const std::size_t>, unsigned, Slopes, Eigen::VectorXd&,
                                                    Eigen::MatrixXd&);
extern template std::optional<Slopes> differentiate(const Evaluator<DirectFamily>&, const PlainParameters<DirectFamily>&,
                                                    std::span<const FreeParameter>, std::span<const double>,
                                                    std::span<const std::size_t>, unsigned, Slopes, Eigen::VectorXd&,
                                                    Eigen::MatrixXd&);

}  // namespace hotfire::explain
