// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// A linear difference equation from the input to one channel, over rows of one period:
///   y_k = -sum_i a_i y_(k-i) + sum_i b_i u_(k-d-i),  i = 1..n for a, 0..n-1 for b
struct LinearModel {
  std::size_t delay = 0;  ///< d [rows]
  std::vector<double> a;
  std::vector<double> b;

  std::size_t order() const { return a.size(); }
};

/// The linear model of each channel that a dataset measures, nothing for the others: what anyone gets without physics.
struct BlackBox {
  double period = 0.0;  ///< [s]
  std::vector<std::optional<LinearModel>> channels;

  bool is_there() const { return period > 0.0; }
};

/// Orders 1 to 4 and delays to 0.1 s, then orders 6, 8 and 12 while that pays, each fitted to the simulated output, not to
/// the next row (Steiglitz and McBride 1965, IEEE Trans. Automatic Control 10, 461); the best by its simulation error on the
/// rows that a fit sees, a further order where that is more than noise and it takes a fiftieth off. Rows closer than 2 ms
/// are `thinned`. Empty for records of several periods.
BlackBox black_box(const Dataset& data, unsigned threads = 1);

/// What it predicts of records of the same rig, from the steady state under their first input, or for a force-driven mass
/// from where it is; with the zeros that `add_zeros` gives them. `data` is thinned to its period.
Prediction simulated(const BlackBox& box, const Dataset& data);

/// The records as a black box sees them: `thinned`, and where the input is a path its position one row later.
Dataset for_black_box(const Dataset& data);

}  // namespace hotfire::explain
