// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// Share of a signal's variance that a function of x explains: the correlation ratio over bins of equal width between the
/// ends of x (Pearson 1905, On the general theory of skew correlation), or that of a straight line if it is more. It asks
/// for no shape of the function. `signal` has a mean of zero.
double correlation_ratio(const std::vector<double>& x, const std::vector<double>& signal);

/// The smoothed signal of a place against outputs of forms, over every few rows of all records.
class SignalCorrelation {
 public:
  /// The regression is to outlive it.
  explicit SignalCorrelation(const FormRegression& regression);

  /// The smoothed signal less its mean.
  const std::vector<double>& signal() const { return signal_; }
  /// Output of a form without its curve, row by row as the signal.
  std::vector<double> output(const Form& form) const;
  /// For each of several forms of one argument: the share of the signal's variance that a function of the form's output
  /// explains, or of its output less its argument, whichever is more.
  std::vector<double> explained_shares(std::span<const Form> forms) const;

 private:
  /// What the form is a law of, by experiment.
  std::vector<Eigen::VectorXd> arguments_of(const Form& form) const;
  /// Of one form, or of forms that run side by side.
  std::vector<std::vector<double>> outputs(std::span<const Form> forms, const std::vector<Eigen::VectorXd>& arguments) const;

  const FormRegression& regression_;
  std::vector<double> signal_;
};

}  // namespace hotfire::explain
