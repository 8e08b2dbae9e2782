// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/model/model_layout.hpp"

namespace hotfire {

/// What faults can be declared on.
struct FaultyPlant {
  std::vector<ModelChannel> channels;  ///< of every actuator
  bool hydraulic = true;
  std::int64_t actuators = 8;  ///< at most
  bool has_bearing = false;
};

FaultyPlant faulty_plant(const ModelFile& model);

/// Reads a file of faults that a plant plays on purpose (docs/real-time.md) and returns them as lines of a plant image, in
/// SI. Throws FileError naming file, line, key, value and what is allowed.
std::string load_faults(const std::filesystem::path& path, const FaultyPlant& plant);

}  // namespace hotfire
