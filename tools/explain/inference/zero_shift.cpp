// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/zero_shift.hpp"

#include <cmath>
#include <cstddef>

namespace hotfire::explain {

std::array<double, 3> shift_at_rest(const SimplexParameters& plain, const SimplexParameters& changed, double by,
                                    double step) {
  const model::Simplex<double> one(plain, step);
  const model::Simplex<double> other(changed, step);
  const std::array<double, 3> before = one.measured(one.steady(0.0));
  std::array<double, 3> shift = other.measured(other.steady(0.0));
  for (std::size_t c = 0; c < shift.size(); ++c) {
    shift[c] = (shift[c] - before[c]) / by;
  }
  return shift;
}

CommonShift common_shift(const Dataset& data, const Zeros& zeros, const std::array<double, 3>& shift) {
  CommonShift common;
  double product = 0.0;
  double square = 0.0;
  for (std::size_t e = 0; e < zeros.size(); ++e) {
    for (std::size_t c = 0; c < shift.size(); ++c) {
      const Experiment& experiment = data.experiments[e];
      if (experiment.measured[c].empty() || !(experiment.zero_deviation[c] > 0.0)) {
        continue;
      }
      const double zero = zeros[e][c] / experiment.zero_deviation[c];
      const double of_shift = shift[c] / experiment.zero_deviation[c];
      product += of_shift * zero;
      square += of_shift * of_shift;
      common.whole += zero * zero;
      common.shows = common.shows || std::abs(zeros[e][c]) > experiment.noise[c];
    }
  }
  common.left = common.whole;
  if (square > 0.0) {
    common.amount = product / square;
    common.left -= product * product / square;
  }
  return common;
}

}  // namespace hotfire::explain
