// SPDX-License-Identifier: Apache-2.0
/// The plants in double, compiled once for all programs of a build: hotfire_model defines HOTFIRE_COMPILED_PLANTS, and
/// the headers then declare these instantiations and leave them to this file.
#include "model/simplex.hpp"
#include "model/vehicle.hpp"

namespace hotfire::model {

template class Simplex<double>;
template class Vehicle<double, 1, 32, SimplexEffects>;
template class Vehicle<double, 4, 64, MasvEffects>;

}  // namespace hotfire::model
