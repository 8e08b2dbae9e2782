#pragma once

#include <filesystem>
#include <string>

namespace hotfire {

/// Reads a profile file (docs/lab.md) and returns it as the image of a lab, lines `key value` in SI, which hotfire-rt reads
/// bit for bit. Throws FileError naming file, line, key, value and what is allowed; also for a profile that would ask for a
/// position beyond its limits, so that it is refused before anything is driven.
std::string load_profile(const std::filesystem::path& path);

}  // namespace hotfire
