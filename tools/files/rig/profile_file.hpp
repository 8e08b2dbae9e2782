// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hotfire {

/// A profile of a lab.
struct LabProfile {
  unsigned actuators = 1;
  double duration = 0.0;        ///< [s]
  double lowest_command = 0.0;  ///< [rad] that [limits] allow as a position
  double highest_command = 0.0;
  double command_rate = 0.0;  ///< [rad/s] that they allow
  std::uint64_t digest = 0;   ///< of the image: what a person confirms
  std::string image;          ///< lines `key value` in SI, which hotfire-rt reads bit for bit
};

/// Whether a TOML file is a profile: it has a table [lab].
bool is_profile(const std::filesystem::path& path);

/// Reads a profile file (docs/lab.md). Throws FileError naming file, line, key, value and what is allowed; also for a
/// profile that would ask for a position beyond its limits, so that it is refused before anything is driven.
LabProfile load_profile(const std::filesystem::path& path);

/// The text of a profile file with other parts, tables `[[profile]]`, in the place of its own. Throws FileError if the file
/// cannot be read.
std::string profile_with_parts(const std::filesystem::path& path, const std::string& parts);

}  // namespace hotfire
