// SPDX-License-Identifier: Apache-2.0
#include "tools/nastran/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::nastran {

namespace {

std::string content_of(const std::filesystem::path& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  std::ifstream file(path, std::ios::binary);
  if (failed || !file) {
    throw FileError(fmt::format("{}: cannot be opened; name a file that Nastran has written", path.string()));
  }
  if (size > TextLines::kMostBytes) {
    throw FileError(fmt::format("{}:1: over {} bytes; print the grids of the attach points alone", path.string(),
                                TextLines::kMostBytes));
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& path) : path_(path), content_(content_of(path)) {
  std::string_view left = content_;
  while (!left.empty()) {
    const std::size_t end = left.find('\n');
    std::string_view line = left.substr(0, end);
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    lines_.push_back(line);
    if (line.find('\0') != std::string_view::npos) {
      refuse(lines_.size() - 1, "not text; a binary file of Nastran ends with .op2");
    }
  }
}

void TextLines::refuse(std::size_t i, std::string_view problem) const {
  throw FileError(
      fmt::format("{}:{}: {}", path_.string(), std::min(i + 1, std::max(lines_.size(), std::size_t{1})), problem));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == 'D' || letter == 'd' || letter == 'E' || letter == 'e') {
      plain += 'e';
      if (i + 1 < text.size() && text[i + 1] == '+') {
        ++i;
      }
    } else if ((letter == '+' || letter == '-') && i > 0) {
      // An exponent without its letter.
      plain += !plain.ends_with('e') ? "e" : "";
      plain += letter == '-' ? "-" : "";
    } else {
      plain += letter;
    }
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  const bool is_whole = error == std::errc{} && end == plain.data() + plain.size();
  return is_whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<int> id_of(std::string_view text) {
  text = trimmed(text);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && value > 0 ? std::optional(value) : std::nullopt;
}

}  // namespace hotfire::nastran
