// SPDX-License-Identifier: Apache-2.0
#include <glog/logging.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdlib>

#include "tools/files/text/error.hpp"
#include "tools/files/text/units.hpp"
#include "tools/python/explaining.hpp"
#include "tools/python/models.hpp"
#include "tools/python/records.hpp"
#include "tools/python/runs.hpp"

namespace py = pybind11;

namespace {

/// Makes the heap keep what a run frees for the next run. The C library returns a large block to the system until it has
/// seen a block of that size freed; then it keeps twice as much (mallopt(3), M_MMAP_THRESHOLD). A block that nothing writes
/// to is enough, and costs no memory. Without it a run of a mass takes a third longer: the system clears every page of its
/// record.
void keep_memory_of_runs() {
  constexpr std::size_t kLargestKept = 31U << 20U;  // the largest that counts is 32 MiB on a machine of 64 bit
  void* volatile block = std::malloc(kLargestKept);
  std::free(block);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  using namespace hotfire;
  google::SetCommandLineOption("minloglevel", "3");
  keep_memory_of_runs();
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
