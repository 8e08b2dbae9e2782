// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire::nastran {

/// A text file of Nastran, line by line, whatever its size, with the place of each line for messages.
class TextLines {
 public:
  /// Throws FileError if the file cannot be read, is over `kMostBytes` or is not text.
  explicit TextLines(const std::filesystem::path& path);

  /// The largest file that is read: a thousand modes of a hundred thousand grids.
  static constexpr std::size_t kMostBytes = std::size_t{16} << 30U;

  std::size_t count() const { return lines_.size(); }
  /// Line `i` from 0, without its end.
  std::string_view operator[](std::size_t i) const { return lines_[i]; }

  /// Throws FileError `path:line: problem` for line `i` from 0; one beyond the last is the end of the file.
  [[noreturn]] void refuse(std::size_t i, std::string_view problem) const;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::string content_;
  std::vector<std::string_view> lines_;
};

/// The words of a line between blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// A number as Nastran writes it: 1.5, 1.5E+3, 1.5D+3 or 1.5+3; empty for anything else.
std::optional<double> number_of(std::string_view text);

/// A whole number above 0; empty for anything else.
std::optional<int> id_of(std::string_view text);

}  // namespace hotfire::nastran
