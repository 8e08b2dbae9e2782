// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/toml_keys.hpp"

#include <algorithm>

namespace hotfire {

namespace {

constexpr std::size_t kMostClosingQuotes = 5;  ///< two of the text itself, then three

/// True if the word from `at` to `end` has a letter beyond ASCII. A mark of the byte order may begin the file.
bool is_foreign(std::string_view text, std::size_t at, std::size_t end) {
  const std::size_t mark = at == 0 && text.starts_with("\xef\xbb\xbf") ? 3 : 0;
  return std::ranges::any_of(text.substr(at + mark, end - at - mark),
                             [](char letter) { return static_cast<unsigned char>(letter) > 127; });
}

/// Behind a string of one line that begins at `at`; at the end of its line if it has no end.
std::size_t behind_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  for (++at; at < text.size() && text[at] != '\n'; ++at) {
    if (text[at] == quote) {
      return at + 1;
    }
    at += quote == '"' && text[at] == '\\' ? 1 : 0;
  }
  return std::min(at, text.size());
}

/// Behind a string of several lines that begins at `at`.
std::size_t behind_long_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  for (at += 3; at < text.size();) {
    const std::size_t quotes = std::min(text.find_first_not_of(quote, at), text.size()) - at;
    if (quotes >= 3) {
      return at + std::min(quotes, kMostClosingQuotes);
    }
    at += std::max<std::size_t>(quotes, 1) + (quote == '"' && text[at] == '\\' ? 1 : 0);
  }
  return text.size();
}

/// Where in a string with escapes a letter beyond ASCII is behind a backslash, at once or behind spaces and ends of lines;
/// npos: nowhere.
std::size_t escaped_foreign_letter(std::string_view text, std::size_t at, std::size_t end) {
  for (; at < end; ++at) {
    if (text[at] == '\\') {
      const std::size_t next = std::min(text.find_first_not_of(" \t\r\n", at + 1), end);
      if (next<end&& static_cast<unsigned char>(text[next])> 127) {
        return next;
      }
      ++at;
    }
  }
  return std::string_view::npos;
}

}  // namespace

KeyFault key_fault_of(std::string_view text) {
  std::size_t parts = 0;
  bool joined = false;  // the last thing was a point, which joins what follows to the key
  const auto part = [&] {
    parts = joined ? parts + 1 : 1;
    joined = false;
    return parts > kMostKeyParts;
  };
  const auto fault = [&](KeyFault::Kind kind, std::size_t at) {
    const auto ends = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    return KeyFault{kind, 1 + static_cast<std::size_t>(ends)};
  };
  constexpr std::string_view kBreaks = "=,[]{}\n#\"'. \t";
  for (std::size_t at = 0; at < text.size();) {
    const char letter = text[at];
    if (letter == '"' || letter == '\'') {
      if (part()) {
        return fault(KeyFault::Kind::long_key, at);
      }
      const bool is_long = text.substr(at).starts_with(letter == '"' ? "\"\"\"" : "'''");
      const std::size_t end = is_long ? behind_long_string(text, at) : behind_string(text, at);
      const std::size_t foreign = letter == '"' ? escaped_foreign_letter(text, at, end) : std::string_view::npos;
      if (foreign != std::string_view::npos) {
        return fault(KeyFault::Kind::escaped_letter, foreign);
      }
      at = end;
    } else if (letter == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (letter == '.') {
      joined = true;
      ++at;
    } else if (letter == ' ' || letter == '\t') {
      ++at;
    } else if (kBreaks.find(letter) != std::string_view::npos) {
      joined = false;
      ++at;
    } else {
      if (part()) {
        return fault(KeyFault::Kind::long_key, at);
      }
      const std::size_t end = std::min(text.find_first_of(kBreaks, at), text.size());
      if (is_foreign(text, at, end)) {
        return fault(KeyFault::Kind::foreign_letter, at);
      }
      // The parser takes it for a part of the word, and what follows for no string: what is not looked at there.
      if (end < text.size() && (text[end] == '"' || text[end] == '\'')) {
        return fault(KeyFault::Kind::quote_in_word, end);
      }
      at = end;
    }
  }
  return {};
}

}  // namespace hotfire
