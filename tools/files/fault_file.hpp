#pragma once

#include <filesystem>
#include <string>

#include "tools/files/model_file.hpp"

namespace hotfire {

/// Reads a file of faults that a plant of this model plays on purpose (docs/real-time.md) and returns them as lines of a
/// plant image, in SI. Throws FileError naming file, line, key, value and what is allowed.
std::string load_faults(const std::filesystem::path& path, const ModelFile& model);

}  // namespace hotfire
