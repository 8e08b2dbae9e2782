// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// Reads a text file line by line through a buffer of its own, whatever the file's size.
class CsvLines {
 public:
  /// Opens and reads the first block. Throws FileError if the file cannot be read, is empty or is not text.
  explicit CsvLines(const std::filesystem::path& path);

  /// The same from text that outlives the lines; `name` represents the file in messages.
  CsvLines(std::string_view text, std::filesystem::path name);

  /// The next line without its end (LF or CRLF), valid until the next call; false at the end. Throws FileError for a line
  /// longer than the buffer.
  bool next(std::string_view& line);

  /// Number of the line `next` gave last, from 1.
  std::size_t number() const { return number_; }

  /// Throws FileError `path:line: problem` for the line `next` gave last.
  [[noreturn]] void refuse(std::string_view problem) const;

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  CsvLines(std::filesystem::path path, File file);
  std::size_t fill();
  void require_text() const;

  std::filesystem::path path_;
  File file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< first byte not yet given
  std::size_t end_ = 0;    ///< end of what was read
  std::size_t number_ = 0;
};

}  // namespace hotfire
