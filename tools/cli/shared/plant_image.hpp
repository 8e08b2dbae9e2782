// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire {

/// What hotfire-rt takes in place of a file that people write: of a model of one axis or of a vehicle, with the faults that
/// its plant plays (`faults_path` may be empty). Throws FileError for a file that is refused.
std::string image_of_model(const std::string& model_path, const std::string& faults_path);

}  // namespace hotfire
