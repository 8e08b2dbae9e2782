// SPDX-License-Identifier: Apache-2.0
#include <glog/logging.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "tools/files/text/error.hpp"
#include "tools/files/text/units.hpp"
#include "tools/python/explaining.hpp"
#include "tools/python/models.hpp"
#include "tools/python/records.hpp"
#include "tools/python/runs.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace hotfire;
  google::SetCommandLineOption("minloglevel", "3");
  module.doc() = "The part of hotfire that is C++; use the package hotfire.";
  module.attr("version") = HOTFIRE_VERSION;
  py::register_exception<FileError>(module, "FileError", PyExc_ValueError);
  py::register_exception<UsageError>(module, "UsageError", PyExc_ValueError);
  py::register_exception<UnitError>(module, "UnitError", PyExc_ValueError);
  python::add_models(module);
  python::add_records(module);
  python::add_runs(module);
  python::add_explaining(module);
  module.def("convert_unit", &convert_unit, py::arg("value"), py::arg("unit"), py::arg("wanted"));
}
