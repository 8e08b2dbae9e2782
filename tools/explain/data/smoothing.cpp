// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace hotfire::explain {

double smoothing_frequency(double period) { return std::min(12.0, 1.0 / (40.0 * period)); }

Series smoothed(const Series& x, double period, double frequency) {
  const double spread = std::sqrt(std::numbers::ln2) / (2.0 * std::numbers::pi * frequency * period);
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4.0 * spread));
  Series kernel;
  double sum = 0.0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    kernel.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (spread * spread)));
    sum += kernel.back();
  }
  const auto last = static_cast<std::ptrdiff_t>(x.size()) - 1;
  Series result(x.size(), 0.0);
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    double value = 0.0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      value += kernel[static_cast<std::size_t>(k + reach)] *
               x[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + k, 0, last))];
    }
    result[static_cast<std::size_t>(i)] = value / sum;
  }
  return result;
}

Series rate_of(const Series& x, double period) {
  Series rate(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    rate[i] = (x[i + 1] - x[i - 1]) / (2.0 * period);
  }
  return rate;
}

Series integral_of(const Series& rate, double period) {
  Series integral(rate.size(), 0.0);
  double mean = 0.0;
  for (std::size_t i = 1; i < rate.size(); ++i) {
    integral[i] = integral[i - 1] + 0.5 * period * (rate[i] + rate[i - 1]);
    mean += integral[i] / static_cast<double>(rate.size());
  }
  const double middle = 0.5 * (static_cast<double>(rate.size()) - 1.0);
  double along = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    const double place = static_cast<double>(i) - middle;
    along += place * (integral[i] - mean);
    spread += place * place;
  }
  const double slope = spread > 0.0 ? along / spread : 0.0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    integral[i] -= mean + slope * (static_cast<double>(i) - middle);
  }
  return integral;
}

}  // namespace hotfire::explain
