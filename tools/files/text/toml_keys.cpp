// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/toml_keys.hpp"

#include <algorithm>
#include <string>

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

/// Walks a text by strings, words and breaks. It counts the parts of the key under way, and it follows tables and arrays to
/// distinguish keys from values.
class KeyWalk {
 public:
  explicit KeyWalk(std::string_view text) : text_(text) {}

  KeyFault first_fault() {
    constexpr std::string_view kNoValueBegins = "=,[]{}\n# \t";
    constexpr std::string_view kBreaks = "=,[]{}\n#\"'. \t";
    while (at_ < text_.size() && fault_.kind == KeyFault::Kind::none) {
      const char letter = text_[at_];
      if (letter == '"' || letter == '\'') {
        take_string(letter);
      } else if (is_value_ && kNoValueBegins.find(letter) == std::string_view::npos) {
        take_value();
      } else if (kBreaks.find(letter) == std::string_view::npos) {
        take_word(std::min(text_.find_first_of(kBreaks, at_), text_.size()));
      } else {
        take_break(letter);
      }
    }
    return fault_;
  }

 private:
  void take_string(char quote) {
    count_part();
    const bool is_long = text_.substr(at_).starts_with(quote == '"' ? "\"\"\"" : "'''");
    const std::size_t end = is_long ? behind_long_string(text_, at_) : behind_string(text_, at_);
    if (quote == '"') {
      const std::size_t foreign = escaped_foreign_letter(text_, at_, end);
      if (foreign != std::string_view::npos) {
        fail(KeyFault::Kind::escaped_letter, foreign);
      }
    }
    at_ = end;
  }

  void take_word(std::size_t end) {
    count_part();
    if (is_foreign(text_, at_, end)) {
      fail(KeyFault::Kind::foreign_letter, at_);
    }
    // The parser reads a quote here as a part of the word, and does not begin a string.
    if (end < text_.size() && (text_[end] == '"' || text_[end] == '\'')) {
      fail(KeyFault::Kind::quote_in_word, end);
    }
    at_ = end;
  }

  /// A number, a date or a word. The parser reads everything up to its end as one value, quotes and brackets as well.
  void take_value() {
    const std::size_t end = std::min(text_.find_first_of(" \t\n,]}#", at_), text_.size());
    if (text_.substr(at_, end - at_).find_first_of("=[{\"'") != std::string_view::npos) {
      fail(KeyFault::Kind::quote_in_word, at_);
    }
    if (is_foreign(text_, at_, end)) {
      fail(KeyFault::Kind::foreign_letter, at_);
    }
    joined_ = false;
    at_ = end;
  }

  void take_break(char letter) {
    if (letter == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
      return;
    }
    if (letter == '.') {
      joined_ = true;
    } else if (letter != ' ' && letter != '\t') {
      joined_ = false;
      follow(letter);
    }
    ++at_;
  }

  /// Whether a key or a value is next. A bracket at the place of a key is that of a table's header.
  void follow(char letter) {
    if (letter == '=') {
      if (is_value_) {
        fail(KeyFault::Kind::quote_in_word, at_);
      }
      is_value_ = true;
    } else if (letter == '\n') {
      is_value_ = is_value_ && !open_.empty();
    } else if (is_value_ && (letter == '[' || letter == '{')) {
      open_.push_back(letter);
      is_value_ = letter == '[';
    } else if (!open_.empty() && (letter == ']' || letter == '}')) {
      open_.pop_back();
      is_value_ = true;
    } else if (!open_.empty() && letter == ',') {
      is_value_ = open_.back() == '[';
    }
  }

  void count_part() {
    parts_ = joined_ ? parts_ + 1 : 1;
    joined_ = false;
    if (parts_ > kMostKeyParts) {
      fail(KeyFault::Kind::long_key, at_);
    }
  }

  /// The first fault stays.
  void fail(KeyFault::Kind kind, std::size_t at) {
    if (fault_.kind == KeyFault::Kind::none) {
      const auto ends = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      fault_ = {kind, 1 + static_cast<std::size_t>(ends)};
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t parts_ = 0;
  std::string open_;       ///< brackets of the arrays and the tables in braces that are open
  bool is_value_ = false;  ///< a value is next, or was the last
  bool joined_ = false;    ///< the last thing was a point, which joins what follows to the key
  KeyFault fault_;
};

}  // namespace

KeyFault key_fault_of(std::string_view text) { return KeyWalk(text).first_fault(); }

}  // namespace hotfire
