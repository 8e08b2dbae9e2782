#pragma once

#include <filesystem>
#include <string>

namespace hotfire {

/// A profile of a lab.
struct LabProfile {
  unsigned actuators = 1;
  double duration = 0.0;  ///< [s]
  std::string image;      ///< lines `key value` in SI, which hotfire-rt reads bit for bit
};

/// Whether a TOML file is a profile: it has a table [lab].
bool is_profile(const std::filesystem::path& path);

/// Reads a profile file (docs/lab.md). Throws FileError naming file, line, key, value and what is allowed; also for a
/// profile that would ask for a position beyond its limits, so that it is refused before anything is driven.
LabProfile load_profile(const std::filesystem::path& path);

}  // namespace hotfire
