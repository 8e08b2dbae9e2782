// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hotfire::explain {

/// Abscissas of a table that is to follow a cloud of `x` and `y`, `y` in units of its noise: the ends of `x`, and between
/// them up to `most` in all where points help most. Each has to take off the sum of squares what strong evidence asks for
/// (`Policy::strong_evidence`), chosen among so many places. A step forward at a time, then every point once more beside the
/// others [Friedman 1991, Multivariate Adaptive Regression Splines, Annals of Statistics 19(1), sec. 3.4, in one dimension
/// and of degree one]. Ascending; none if `x` has no width.
std::vector<double> curve_points(std::span<const double> x, std::span<const double> y, std::size_t most);

}  // namespace hotfire::explain
