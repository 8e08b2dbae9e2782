// SPDX-License-Identifier: Apache-2.0
/// A simplex plant in double, compiled once for all programs of a build: hotfire_model defines HOTFIRE_COMPILED_PLANTS, and
/// the header then leaves this instantiation to this file. Beside another plant the compiler inlines less: a step takes 24 %
/// more instructions.
#include "model/simplex.hpp"

namespace hotfire::model {

template class Simplex<double>;

}  // namespace hotfire::model
