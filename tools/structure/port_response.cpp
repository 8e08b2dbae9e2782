// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/port_response.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace hotfire {

std::complex<double> mode_response(const ModeSet& modes, int k, double frequency) {
  const double own = 2.0 * std::numbers::pi * modes.frequency(k);
  const double w = 2.0 * std::numbers::pi * frequency;
  return 1.0 / std::complex<double>(own * own - w * w, 2.0 * modes.damping_ratio(k) * own * w);
}

Eigen::MatrixXcd port_response(const ModeSet& modes, double frequency) {
  Eigen::MatrixXcd response = modes.residual.cast<std::complex<double>>();
  for (int k = 0; k < modes.modes(); ++k) {
    response += mode_response(modes, k, frequency) * (modes.shape.col(k) * modes.shape.col(k).transpose());
  }
  return response;
}

ModalIntegral modal_integral(const ModeSet& modes, int port) {
  std::vector<int> order(static_cast<std::size_t>(modes.modes()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int one, int other) { return modes.frequency(one) < modes.frequency(other); });
  ModalIntegral integral;
  double sum = 0.0;
  for (const int k : order) {
    const double w = 2.0 * std::numbers::pi * modes.frequency(k);
    sum += modes.shape(port, k) * modes.shape(port, k) / (w * w);
    integral.frequency.push_back(modes.frequency(k));
    integral.flexibility.push_back(sum);
  }
  return integral;
}

}  // namespace hotfire
