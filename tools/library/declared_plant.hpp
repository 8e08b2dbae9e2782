// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/interface/plant/plant.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

/// What a model file declares, as `interface/` runs it.
struct DeclaredPlant {
  std::string name;  ///< of the model
  plant::Setup setup;
  plant::AnyParameters parameters;
};

/// Reads a model file of any topology. Strings are where `hotfire simulate --seed` places them. Throws FileError.
DeclaredPlant declared_plant(const std::filesystem::path& path, double period, unsigned seed);

/// The same of the text of a model file; `path` represents the file in messages, and a mode table is read from beside it.
DeclaredPlant declared_plant(const std::string& text, const std::filesystem::path& path, double period, unsigned seed);

/// The same of a vehicle file that has been read.
DeclaredPlant declared_plant(const VehicleFile& file, double period, unsigned seed);

/// The plant text of a declared plant (interface/plant/setup_text.hpp).
std::string plant_text_of(const DeclaredPlant& declared);

}  // namespace hotfire
