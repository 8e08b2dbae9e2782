// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <tuple>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire::python {

/// A channel as Python gives it: name, unit, values.
using GivenChannel = std::tuple<std::string, std::string, pybind11::array_t<double, pybind11::array::c_style>>;

/// A record of arrays, in SI, checked as a file is. Throws FileError for what `load_record` refuses: an unknown channel or
/// unit, one named twice, a value that is not finite, another number of rows, a rate outside 50 Hz to 20 kHz.
Record record_of(const std::vector<GivenChannel>& channels, double start, double period, const std::string& name);

/// Adds the class Record to the module.
void add_records(pybind11::module_& module);

}  // namespace hotfire::python
