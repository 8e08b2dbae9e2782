// SPDX-License-Identifier: Apache-2.0
/// A taos plant in double, compiled once for all programs of a build: hotfire_model defines HOTFIRE_COMPILED_PLANTS, and the
/// header then leaves this instantiation to this file. Beside another plant the compiler inlines less: a step takes 24 %
/// more instructions.
#include "model/vehicle.hpp"

namespace hotfire::model {

template class Vehicle<double, 1, 32, SimplexEffects>;

}  // namespace hotfire::model
