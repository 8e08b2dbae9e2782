// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace hotfire::test {

/// Of a residual that was coloured and is white with the effects.
nlohmann::json autocorrelation();

/// Of a residual that followed the input; with the effects it does so no longer, or a little still.
nlohmann::json input_correlation(bool independent);

/// In nine bands from 0 Hz on: a declared model that errs most at low frequencies, an explained one at the noise. The first
/// band of the explained model is not known. Without noise and error, every band has an rms of zero.
nlohmann::json by_frequency(double noise, double declared_error);

/// In three ranges up to the largest amplitude.
nlohmann::json by_amplitude(double largest, double noise, double declared_error);

}  // namespace hotfire::test
