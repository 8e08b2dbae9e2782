// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace hotfire {

/// A folder among the temporary files that nobody else can write to, gone with everything in it at the end.
class PrivateFolder {
 public:
  /// Throws FileError if it cannot be made.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace hotfire
