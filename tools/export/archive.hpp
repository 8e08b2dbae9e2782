// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace hotfire {

/// Writes a zip archive of texts by name, whole or not at all. The same texts give the same bytes. Throws FileError.
void write_archive(const std::filesystem::path& path, const std::map<std::string, std::string>& files);

}  // namespace hotfire
