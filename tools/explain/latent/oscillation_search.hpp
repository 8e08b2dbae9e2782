// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// The oscillation in the smoothed signal of a place whose frequency moves with one quantity of the axis, and explains most
/// of it: an oscillator of the grammar with a curve over that quantity. Every record starts at the same phase.
///
/// The signal is demodulated by the integral of the quantity, times a comb of tunings, and transformed: the peak is an
/// oscillation of constant frequency. The curve is then fitted to the signal by Levenberg and Marquardt. A search over
/// frequency and curve together would have as many minima as the record has cycles. Nothing where no quantity moves.
std::optional<Form> find_oscillation(const FormRegression& regression, const LatentPlace& place, unsigned threads);

}  // namespace hotfire::explain
