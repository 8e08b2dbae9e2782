// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace hotfire {

/// A file that is whole or absent: written to a temporary beside its target, which `commit` puts in the target's place.
/// Without `commit` the temporary is removed and an older target stays as it was.
class WholeFile {
 public:
  /// Throws FileError if the target cannot be written or is something other than a regular file (a folder, a device).
  explicit WholeFile(const std::filesystem::path& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Appends. Throws FileError (disk full, say).
  void write(std::string_view text);

  /// The same, and empties the text, once it is a block long: for a file that grows row by row.
  void write_block(std::string& text);

  /// Where it is written until then, for a library that writes by path.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Flushes to the disk and renames. Throws FileError.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/// Writes a whole text at once. Throws FileError.
void write_whole_file(const std::filesystem::path& path, std::string_view text);

/// The same of a library that writes to a path: `write` gets the temporary's, and returns whether it could write all of it.
void write_whole_file_by(const std::filesystem::path& path, const std::function<bool(const std::filesystem::path&)>& write);

}  // namespace hotfire
