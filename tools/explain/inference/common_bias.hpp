// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tools/explain/data/zeros.hpp"
#include "tools/explain/fit/fit.hpp"

namespace hotfire::explain {

/// The null bias of the servovalve of which all zeros of all records are (model/effects/valve/valve_bias.hpp), if there is
/// one: it then belongs to the plant. A servo moves by bias / K_e, its piston and its engine alike, in every run; zeros of
/// sensors know nothing of each other. Least squares over at least two records with one zero beyond its noise; nothing where
/// more than a tenth of the zeros' rms is left, or where the model has a bias of its own. A zero of the command that all
/// records share does the same, and cannot be separated from it.
std::optional<double> common_valve_bias(const Dataset& data, const Zeros& zeros, const SimplexParameters& parameters);

/// `parameters` with that bias.
SimplexParameters with_valve_bias(SimplexParameters parameters, double bias);

}  // namespace hotfire::explain
