// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/correlation.hpp"

#include <algorithm>
#include <array>

#include "tools/explain/latent/form_comb.hpp"

namespace hotfire::explain {

namespace {

constexpr std::size_t kBins = 32;
/// Rows between those that are looked at, and values that the bins are laid by.
constexpr Eigen::Index kEvery = 4;
constexpr std::size_t kSampled = 500;

}  // namespace

double correlation_ratio(const std::vector<double>& x, const std::vector<double>& signal) {
  std::vector<double> sample;
  for (std::size_t i = 0; i < x.size(); i += 1 + x.size() / kSampled) {
    sample.push_back(x[i]);
  }
  const double low = quantile_of_unsorted(sample, 0.01);
  const double high = quantile_of_unsorted(sample, 0.99);
  if (!(high > low)) {
    return 0.0;
  }
  const double bins_per_unit = static_cast<double>(kBins) / (high - low);
  std::array<double, kBins> sum{};
  std::array<double, kBins> count{};
  double whole = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double place = std::clamp((x[i] - low) * bins_per_unit, 0.0, static_cast<double>(kBins));
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(place));
    sum[bin] += signal[i];
    count[bin] += 1.0;
    whole += signal[i] * signal[i];
  }
  double between = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    between += count[bin] > 0.0 ? sum[bin] * sum[bin] / count[bin] : 0.0;
  }
  return whole > 0.0 ? between / whole : 0.0;
}

SignalCorrelation::SignalCorrelation(const FormRegression& regression) : regression_(regression) {
  double sum = 0.0;
  for (const Eigen::VectorXd& signal : regression.signal()) {
    for (Eigen::Index row = 0; row < signal.size(); row += kEvery) {
      signal_.push_back(signal(row));
      sum += signal(row);
    }
  }
  const double mean = sum / static_cast<double>(signal_.size());
  std::ranges::transform(signal_, signal_.begin(), [&](double value) { return value - mean; });
}

std::vector<double> SignalCorrelation::output(const Form& form) const {
  std::vector<double> values;
  values.reserve(signal_.size());
  for (std::size_t e = 0; e < regression_.quantities().size(); ++e) {
    const Eigen::VectorXd argument = argument_of(form, regression_.quantities()[e]);
    const Eigen::VectorXd own = remembered(form, argument, regression_.problem().data.experiments[e].period);
    for (Eigen::Index row = 0; row < own.size(); row += kEvery) {
      values.push_back(own(row));
    }
  }
  return values;
}

double SignalCorrelation::explained_share(const Form& form) const {
  std::vector<double> values = output(form);
  const double share = correlation_ratio(values, signal_);
  if (!form.has_direct()) {
    return share;
  }
  std::size_t i = 0;
  for (const Eigen::MatrixXd& quantities : regression_.quantities()) {
    const Eigen::VectorXd argument = argument_of(form, quantities);
    for (Eigen::Index row = 0; row < argument.size(); row += kEvery) {
      values[i++] -= argument(row);
    }
  }
  return std::max(share, correlation_ratio(values, signal_));
}

}  // namespace hotfire::explain
