// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace hotfire::python {

/// Adds the finder to the module.
void add_explaining(pybind11::module_& module);

}  // namespace hotfire::python
