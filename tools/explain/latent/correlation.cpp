// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/correlation.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "tools/explain/latent/form_comb.hpp"

namespace hotfire::explain {

namespace {

constexpr std::size_t kBins = 32;
/// One of so many rows is looked at, and values that the bins are laid by.
constexpr Eigen::Index kEvery = 4;
constexpr std::size_t kSampled = 500;
/// A scatter below this share of the mean square is what rounding leaves of none.
constexpr double kRounding = 1e-12;
/// The row within each group of `kEvery` changes from group to group: otherwise all rows could be sampling instants of a
/// held signal, where it equals its argument.
constexpr std::array<Eigen::Index, 7> kRowInGroup{0, 2, 1, 3, 2, 0, 1};

/// The rows of a column that are looked at.
Eigen::VectorXd some_of(const Eigen::VectorXd& column) {
  Eigen::VectorXd some(column.size() / kEvery);
  for (Eigen::Index i = 0; i < some.size(); ++i) {
    some(i) = column(kEvery * i + kRowInGroup[static_cast<std::size_t>(i) % kRowInGroup.size()]);
  }
  return some;
}

void append(const Eigen::VectorXd& column, std::vector<double>& values) {
  values.insert(values.end(), column.begin(), column.end());
}

/// True if the output of a row depends on that row alone.
bool keeps_nothing(model::Memory kind) {
  switch (kind) {
    case model::Memory::none:
    case model::Memory::quantise:
    case model::Memory::dead_zone:
    case model::Memory::saturation:
    case model::Memory::odd_power:
    case model::Memory::even_power:
    case model::Memory::periodic:
      return true;
    default:
      return false;
  }
}

/// The first forms of some that run side by side, or the first alone.
std::span<const Form> side_by_side(std::span<const Form> forms) {
  const bool together = forms.size() >= kSideBySide && !forms.front().is_stops() &&
                        std::ranges::all_of(forms.first(kSideBySide),
                                            [&](const Form& form) { return form.memory.kind == forms.front().memory.kind; });
  return forms.first(together ? kSideBySide : 1);
}

}  // namespace

double correlation_ratio(const std::vector<double>& x, const std::vector<double>& signal) {
  std::vector<double> sample;
  for (std::size_t i = 0; i < x.size(); i += 1 + x.size() / kSampled) {
    sample.push_back(x[i]);
  }
  double low = quantile_of_unsorted(sample, 0.01);
  double high = quantile_of_unsorted(sample, 0.99);
  if (!(high > low)) {
    // A value that is the same but for moments, as what a limit takes off a signal.
    const auto [least, most] = std::ranges::minmax(x);
    low = least;
    high = most;
  }
  if (!(high > low)) {
    return 0.0;
  }
  const double bins_per_unit = static_cast<double>(kBins) / (high - low);
  std::array<double, kBins> sum{};
  std::array<double, kBins> count{};
  double whole = 0.0;
  double total = 0.0;
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double place = std::clamp((x[i] - low) * bins_per_unit, 0.0, static_cast<double>(kBins));
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(place));
    sum[bin] += signal[i];
    count[bin] += 1.0;
    whole += signal[i] * signal[i];
    total += x[i];
    square += x[i] * x[i];
    product += x[i] * signal[i];
  }
  double between = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    between += count[bin] > 0.0 ? sum[bin] * sum[bin] / count[bin] : 0.0;
  }
  // The bins at the ends hold all that is beyond them: only a straight line follows a few large peaks.
  const double scatter = square - total * total / static_cast<double>(x.size());
  const double along_line = scatter > kRounding * square ? product * product / scatter : 0.0;
  return whole > 0.0 ? std::max(between, along_line) / whole : 0.0;
}

SignalCorrelation::SignalCorrelation(const FormRegression& regression) : regression_(regression) {
  for (const Eigen::VectorXd& signal : regression.signal()) {
    append(some_of(signal), signal_);
  }
  const double mean = std::accumulate(signal_.begin(), signal_.end(), 0.0) / static_cast<double>(signal_.size());
  std::ranges::transform(signal_, signal_.begin(), [&](double value) { return value - mean; });
}

std::vector<double> SignalCorrelation::output(const Form& form) const {
  return outputs({&form, 1}, arguments_of(form)).front();
}

std::vector<Eigen::VectorXd> SignalCorrelation::arguments_of(const Form& form) const {
  std::vector<Eigen::VectorXd> arguments;
  for (const Eigen::MatrixXd& quantities : regression_.quantities()) {
    arguments.push_back(argument_of(form, quantities));
  }
  return arguments;
}

std::vector<std::vector<double>> SignalCorrelation::outputs(std::span<const Form> forms,
                                                            const std::vector<Eigen::VectorXd>& arguments) const {
  std::vector<std::vector<double>> all(forms.size());
  std::ranges::for_each(all, [&](std::vector<double>& values) { values.reserve(signal_.size()); });
  const bool at_rows = keeps_nothing(forms.front().memory.kind);
  for (std::size_t e = 0; e < arguments.size(); ++e) {
    const double period = regression_.problem().data.experiments[e].period;
    if (forms.size() == kSideBySide) {
      const auto each =
          remembered_side_by_side(forms.first<kSideBySide>(), at_rows ? some_of(arguments[e]) : arguments[e], period);
      for (std::size_t k = 0; k < forms.size(); ++k) {
        const Eigen::VectorXd own = each.row(static_cast<Eigen::Index>(k));
        append(at_rows ? own : some_of(own), all[k]);
      }
    } else {
      for (std::size_t k = 0; k < forms.size(); ++k) {
        append(at_rows ? remembered(forms[k], some_of(arguments[e]), period)
                       : some_of(remembered(forms[k], arguments[e], period)),
               all[k]);
      }
    }
  }
  return all;
}

std::vector<double> SignalCorrelation::explained_shares(std::span<const Form> forms) const {
  const std::vector<Eigen::VectorXd> arguments = arguments_of(forms.front());
  std::vector<double> argument;
  for (const Eigen::VectorXd& whole : arguments) {
    append(some_of(whole), argument);
  }
  std::vector<double> shares;
  while (shares.size() < forms.size()) {
    const std::span<const Form> together = side_by_side(forms.subspan(shares.size()));
    for (std::vector<double>& values : outputs(together, arguments)) {
      const bool has_direct = forms[shares.size()].has_direct();
      shares.push_back(correlation_ratio(values, signal_));
      if (has_direct) {
        std::ranges::transform(values, argument, values.begin(), std::minus<>());
        shares.back() = std::max(shares.back(), correlation_ratio(values, signal_));
      }
    }
  }
  return shares;
}

}  // namespace hotfire::explain
