// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <variant>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::python {

/// A model of any topology.
struct Model {
  std::variant<ModelFile, VehicleFile> file;
};

/// The keys of the parameters that act: "engine.inertia", of several axes "pitch.engine.inertia".
std::vector<std::string> acting_keys(const Model& model);

/// Throws UsageError for a key that is not among them.
void require_acting(const Model& model, const std::vector<std::string>& keys);

/// Adds the class Model to the module.
void add_models(pybind11::module_& module);

}  // namespace hotfire::python
