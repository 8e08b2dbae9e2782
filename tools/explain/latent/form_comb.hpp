// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// The value that a share of `sorted` values lies below.
inline double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// The same of values in any order, which it changes: one quantile needs no sorting.
inline double quantile_of_unsorted(std::vector<double>& values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, place);
  return *place;
}

/// Points of a curve, half by the range of `sorted` values and half by how often they occur: of a curve that is not seen
/// point by point, in front of a memory or under a sum over time. At most `count`; none where the values have no range.
std::vector<double> spread_points(const std::vector<double>& sorted, int count);

/// A gain of an argument, or of a product of two, at a place.
Form at_place(const LatentPlace& place, model::Argument argument, std::optional<model::Argument> factor = {});

/// Every memory of the form's argument over the comb of its parameter: times from the plant's rows on, widths from the
/// argument's size down. None of time, and of what does not move.
std::vector<Form> with_memories(const FormRegression& regression, const Form& plain);

/// Powers of the form's argument, odd and even, over a comb of exponents. A curve through points follows a power as well,
/// but only as far as the records go.
std::vector<Form> with_powers(const FormRegression& regression, const Form& plain);

/// Straight lines with a kink on either side of zero, at a comb of widths: dead zones and saturations. A curve through
/// points has to have one at each kink, and no point is at a narrow one by chance.
std::vector<Form> with_kinks(const FormRegression& regression, const Form& plain);

/// The form with a curve over the values that it meets. None where its memory bears no curve in that order, or what it meets
/// has no width.
std::optional<Form> with_curve(const FormRegression& regression, Form form, bool curve_first);

/// Forms with a curve of few points, by which they are screened: those without a memory, and behind the curve the filters of
/// one quantity. No other memory is among the result.
std::vector<Form> with_rough_curves(const FormRegression& regression, const std::vector<Form>& plain_or_remembering);

/// Memories of what a curve makes of its argument, over the comb of their parameter: those of which the response to a sum of
/// curves is not the sum of responses. `curve` is without memory, `values` are those at its points.
std::vector<Form> behind_curve(const FormRegression& regression, const Form& curve, const Eigen::VectorXd& values);

}  // namespace hotfire::explain
