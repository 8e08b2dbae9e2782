// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/toml_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "tools/files/text/error.hpp"
#include "tools/files/text/near_file.hpp"
#include "tools/files/text/toml_keys.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

namespace {

constexpr std::size_t kLargestFile = 1 << 20;

std::string read_small_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{std::fopen(path.c_str(), "rb"), std::fclose};
  if (!file) {
    const std::string why = std::generic_category().message(errno);
    throw FileError(fmt::format("{}: cannot be opened: {}{}", path.string(), why, near_file(path)));
  }
  constexpr std::size_t kPiece = 1 << 14;
  std::string content;
  for (std::size_t read = kPiece; read == kPiece && content.size() <= kLargestFile;) {
    const std::size_t before = content.size();
    content.resize(before + kPiece);
    read = std::fread(content.data() + before, 1, kPiece, file.get());
    content.resize(before + read);
  }
  if (std::ferror(file.get()) != 0) {
    throw FileError(fmt::format("{}: cannot be read: {}", path.string(), std::generic_category().message(errno)));
  }
  if (content.size() > kLargestFile) {
    throw FileError(
        fmt::format("{}:1: over {} bytes: a model file is TOML text of a few kilobytes", path.string(), kLargestFile));
  }
  return content;
}

std::vector<std::string_view> split_lines(std::string_view content) {
  std::vector<std::string_view> lines;
  while (!content.empty()) {
    const std::size_t end = content.find('\n');
    lines.push_back(content.substr(0, end));
    content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
  }
  return lines;
}

/// toml++ counts characters from 1; a character of UTF-8 may be several bytes.
std::size_t byte_of_column(std::string_view line, std::size_t column) {
  std::size_t byte = 0;
  for (std::size_t seen = 1; byte < line.size() && seen < column; ++seen) {
    do {
      ++byte;
    } while (byte < line.size() && (static_cast<unsigned char>(line[byte]) & 0xC0U) == 0x80U);
  }
  return byte;
}

struct Quantity {
  double value;
  std::string unit;
};

/// "24.8 in^2" -> 24.8 and "in^2".
bool parse_quantity(std::string_view text, Quantity& quantity) {
  const auto skip_spaces = [&text] { text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size())); };
  skip_spaces();
  if (text.starts_with('+') && !text.starts_with("+-")) {
    text.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), quantity.value);
  if (error != std::errc{}) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  skip_spaces();
  text.remove_suffix(text.size() - (text.find_last_not_of(" \t") + 1));
  quantity.unit = text;
  return true;
}

std::string what_is_wrong(KeyFault::Kind kind) {
  switch (kind) {
    case KeyFault::Kind::long_key:
      return fmt::format("a key of more than {} parts; allowed: up to {}, as in limits.command_rate", kMostKeyParts,
                         kMostKeyParts);
    case KeyFault::Kind::quote_in_word:
      return "a quote, a bracket or = inside a key or a number; a string or an array begins after =, a comma, a bracket or "
             "a space";
    case KeyFault::Kind::escaped_letter:
      return "a letter beyond ASCII behind a backslash; remove the backslash, or begin the line with another letter";
    default:
      return "a letter beyond ASCII outside of a string or a comment; put it in quotes or remove it";
  }
}

/// How a wanted unit is called in a message.
std::string wanted_unit(std::string_view unit) {
  return unit.empty()           ? "a bare number in the record's own units"
         : follows_record(unit) ? fmt::format("a bare number in the record's own units, {}", unit)
         : unit == "1"          ? "a number without unit"
                                : fmt::format("a number in {}, or a string with a unit that converts to it", unit);
}

}  // namespace

TomlSource::TomlSource(const std::filesystem::path& path) : TomlSource(path, read_small_file(path)) {}

TomlSource::TomlSource(std::filesystem::path path, std::string content)
    : path_(std::move(path)), content_(std::move(content)), lines_(split_lines(content_)) {
  if (const KeyFault fault = key_fault_of(content_); fault.kind != KeyFault::Kind::none) {
    refuse_at({static_cast<toml::source_index>(fault.line), 0}, what_is_wrong(fault.kind));
  }
  try {
    root_ = toml::parse(std::string_view{content_}, path_.string());
  } catch (const toml::parse_error& error) {
    refuse_at(error.source().begin, fmt::format("not TOML: {}", error.description()));
  }
}

void TomlSource::refuse_at(const toml::source_position& position, const std::string& problem) const {
  const auto column = position.column > 0 ? fmt::format(":{}", position.column) : std::string{};
  throw FileError(fmt::format("{}:{}{}: {}", path_.string(), std::max(position.line, 1U), column, problem));
}

void TomlSource::refuse(const toml::node& value, std::string_view key, std::string_view problem) const {
  refuse_at(value.source().begin, fmt::format("{} = {}: {}", key, written(value), problem));
}

void TomlSource::refuse_key(const toml::key& at, std::string_view key, std::string_view problem) const {
  refuse_at(at.source().begin, fmt::format("{}: {}", key, problem));
}

void TomlSource::refuse_missing(const toml::table& table, std::string_view key, std::string_view problem) const {
  refuse_at({table.source().begin.line, 0}, fmt::format("{}: {}", key, problem));
}

const toml::table& TomlSource::table(const toml::node& node, std::string_view key) const {
  if (const toml::table* table = node.as_table()) {
    return *table;
  }
  refuse(node, key, fmt::format("must be a table: write [{}]", key));
}

double TomlSource::number(const toml::node& node, std::string_view key, std::string_view unit) const {
  Quantity quantity{0.0, std::string{unit}};
  if (const auto* text = node.as_string()) {
    if (!parse_quantity(text->get(), quantity)) {
      refuse(node, key, fmt::format("does not begin with a number; allowed: {}", wanted_unit(unit)));
    }
    if (quantity.unit.empty()) {
      refuse(node, key, fmt::format("a string without a unit; allowed: {}", wanted_unit(unit)));
    }
    if (follows_record(unit)) {
      refuse(node, key, fmt::format("takes no unit; allowed: {}", wanted_unit(unit)));
    }
  } else if (node.is_number()) {
    quantity.value = *node.value<double>();
  } else {
    refuse(node, key, fmt::format("not a number; allowed: {}", wanted_unit(unit)));
  }
  if (!std::isfinite(quantity.value)) {
    refuse(node, key, fmt::format("not a finite number; allowed: {}", wanted_unit(unit)));
  }
  try {
    return convert_unit(quantity.value, quantity.unit, std::string{unit});
  } catch (const UnitError& error) {
    refuse(node, key, fmt::format("{}; allowed: {}", error.what(), wanted_unit(unit)));
  }
}

void TomlSource::require_schema() const {
  const toml::node* schema = root_.get("schema");
  if (schema == nullptr) {
    refuse_missing(root_, "schema", "missing; write schema = 1 on the first line");
  }
  if (schema->value_exact<std::int64_t>() != std::int64_t{1}) {
    refuse(*schema, "schema", "not read by this build; allowed: 1");
  }
}

std::string TomlSource::text(const toml::node& node, std::string_view key) const {
  if (const auto* text = node.as_string()) {
    return text->get();
  }
  refuse(node, key, "must be a string in quotes");
}

std::string TomlSource::written(const toml::node& value) const {
  const toml::source_region& region = value.source();
  if (region.begin.line == 0 || region.begin.line != region.end.line || region.begin.line > lines_.size()) {
    return "...";
  }
  const std::string_view line = lines_[region.begin.line - 1];
  const std::size_t first = byte_of_column(line, region.begin.column);
  return std::string{line.substr(first, byte_of_column(line, region.end.column) - first)};
}

}  // namespace hotfire
