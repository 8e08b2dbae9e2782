// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// Share of a signal's variance that a function of x explains: the correlation ratio over bins of equal width between the
/// ends of x (Pearson 1905, On the general theory of skew correlation). It asks for no shape of the function.
double correlation_ratio(const std::vector<double>& x, const std::vector<double>& signal);

/// Output of a form without its curve, and the smoothed signal less its mean, of every few rows of all records.
std::pair<std::vector<double>, std::vector<double>> output_and_signal(const FormRegression& regression, const Form& form);

/// Share of the smoothed signal's variance that a function of the form's output explains, or of its output less its
/// argument, whichever is more.
double explained_share(const FormRegression& regression, const Form& form);

}  // namespace hotfire::explain
