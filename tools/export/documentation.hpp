// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/export/model_description.hpp"
#include "tools/interface/plant/plant.hpp"

namespace hotfire {

/// documentation/index.html of an FMU: what it is, its inputs and outputs, and how its sources are built.
std::string documentation_page(const plant::Plant& plant, const FmuIdentity& identity);

/// documentation/externalDependencies.txt: what the binary needs of the system.
std::string external_dependencies();

/// sources/CMakeLists.txt: builds the FMU's binary from its sources.
std::string cmake_project(const FmuIdentity& identity);

}  // namespace hotfire
