// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire {

/// What a plant in real time plays beside its commands; a path may be empty.
struct PlayedFiles {
  std::string faults;        ///< (.toml)
  std::string disturbances;  ///< record with the disturbances that `hotfire simulate` reads
};

/// What hotfire-rt takes in place of a file that people write: of a model of one axis or of a vehicle, with what its plant
/// plays. Throws FileError for a file that is refused.
std::string image_of_model(const std::string& model_path, const PlayedFiles& played = {});

}  // namespace hotfire
