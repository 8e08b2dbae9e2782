// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// What held-out data have against a model: a record, or a band of frequency that carries signal, of which it leaves more
/// than the calibrated model does. In words for a report, "sweep.csv is worse by 12 % (piston)"; empty where there is none.
///
/// A record counts from a twentieth more on, a band from twice as much on, and where what is left is more than noise: the
/// same model fitted to other rows differs by less. A band carries signal if the measured channel has ten times the noise
/// and a hundredth of its whole rms there.
std::string harm_of(const Dataset& data, const Prediction& model, const Prediction& calibrated);

}  // namespace hotfire::explain
