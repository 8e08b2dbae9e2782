// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <variant>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::python {

/// A model of any topology.
struct Model {
  std::variant<ModelFile, VehicleFile> file;

  /// The model of one axis. Throws UsageError, which says that `what` takes no other, for one of several.
  const ModelFile& one_axis(const std::string& what) const;
};

/// Adds the class Model to the module.
void add_models(pybind11::module_& module);

}  // namespace hotfire::python
