// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hotfire::disperse {

/// The value that a standard normal variable stays below with `probability`, which lies between 0 and 1; relative error
/// 1e-15 [Wichura 1988, Applied Statistics 37, algorithm AS 241, PPND16].
double normal_quantile(double probability);

/// The probability that a standard normal variable stays below `value`.
double normal_probability(double value);

/// A Latin hypercube of probabilities, a row a draw and a column a variable: each of `draws` equal intervals of a variable
/// holds one draw, at a random place in it [McKay, Beckman and Conover 1979, Technometrics 21]. The draws are paired by
/// their ranks so that the scores of these ranks have the correlations of `correlation`, which is symmetric and positive
/// definite with ones on its diagonal [Iman and Conover 1982, Communications in Statistics B 11]. Variables that are not to
/// be correlated are uncorrelated in the sample too. With no more draws than variables there is no such pairing; they are
/// then paired at random, with these correlations on average.
///
/// The same seed gives the same numbers on every machine whose C library rounds `log` and `sqrt` alike.
Eigen::MatrixXd latin_hypercube(int draws, const Eigen::MatrixXd& correlation, std::uint64_t seed);

}  // namespace hotfire::disperse
