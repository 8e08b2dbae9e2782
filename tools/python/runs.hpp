// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace hotfire::python {

/// Adds what runs a model to the module: simulate, simulate_many, gradients, sweep, analyse_sweep, step.
void add_runs(pybind11::module_& module);

}  // namespace hotfire::python
