// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// Oscillations in the smoothed signal of a place whose frequency moves with a quantity of the axis, for the quantities that
/// explain most of it: oscillators of the grammar with a curve over that quantity. Every record starts at the same phase.
///
/// The signal is demodulated by the integral of the quantity, times a comb of tunings, and transformed: the peak is an
/// oscillation of constant frequency. The curve is then fitted to the signal by Levenberg-Marquardt, from stiff to free.
/// A search over frequency and curve together would have as many minima as the record has cycles. A phase accumulates every
/// error of the frequency, so the signal alone does not identify the quantity: a simulation decides. Nothing where no
/// quantity moves.
std::vector<Form> find_oscillations(const FormRegression& regression, const LatentPlace& place, unsigned threads);

}  // namespace hotfire::explain
