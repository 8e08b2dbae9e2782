// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// A parsed TOML file that knows the position of each value, for messages.
class TomlSource {
 public:
  /// Throws FileError if the file cannot be read, is over a megabyte, has a key of too many parts or is not TOML.
  explicit TomlSource(const std::filesystem::path& path);

  /// The same of a text; `path` represents its file in messages.
  TomlSource(std::filesystem::path path, std::string content);

  const toml::table& root() const { return root_; }

  /// Throws FileError `path:line:column: key = value: problem` for a value.
  [[noreturn]] void refuse(const toml::node& value, std::string_view key, std::string_view problem) const;

  /// Throws FileError `path:line:column: key: problem` for a key.
  [[noreturn]] void refuse_key(const toml::key& at, std::string_view key, std::string_view problem) const;

  /// Throws FileError `path:line: key: problem` for what is missing in a table; `table` is where it belongs.
  [[noreturn]] void refuse_missing(const toml::table& table, std::string_view key, std::string_view problem) const;

  /// Refuses a file that does not say `schema = 1`.
  void require_schema() const;

  /// The table behind a key; refuses anything else.
  const toml::table& table(const toml::node& node, std::string_view key) const;

  /// A finite number in `unit`: bare, or a string with its own unit, converted. Refuses anything else.
  double number(const toml::node& node, std::string_view key, std::string_view unit) const;

  /// A string; refuses anything else.
  std::string text(const toml::node& node, std::string_view key) const;

 private:
  std::string written(const toml::node& value) const;
  [[noreturn]] void refuse_at(const toml::source_position& position, const std::string& problem) const;

  std::filesystem::path path_;
  std::string content_;
  std::vector<std::string_view> lines_;
  toml::table root_;
};

}  // namespace hotfire
