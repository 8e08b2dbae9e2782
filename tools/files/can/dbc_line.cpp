// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/dbc_line.hpp"

#include <algorithm>

namespace hotfire {

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kWordLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";

}  // namespace

bool DbcLine::whole() {
  blanks();
  good_ = good_ && rest_.empty();
  return good_;
}

bool DbcLine::maybe(std::string_view text) {
  if (!rest_.starts_with(text)) {
    return false;
  }
  rest_.remove_prefix(text.size());
  return true;
}

void DbcLine::expect(std::string_view text) { good_ = maybe(text) && good_; }

void DbcLine::gap() {
  good_ = good_ && !rest_.empty() && kBlanks.find(rest_.front()) != std::string_view::npos;
  blanks();
}

void DbcLine::blanks() { take(std::min(rest_.find_first_not_of(kBlanks), rest_.size())); }

std::string DbcLine::digits(std::size_t most) {
  const std::size_t size = std::min(rest_.find_first_not_of(kDigits), rest_.size());
  good_ = good_ && size > 0 && size <= most;
  return take(size);
}

std::string DbcLine::word() {
  const std::size_t size = std::min(rest_.find_first_not_of(kWordLetters), rest_.size());
  good_ = good_ && size > 0;
  return take(size);
}

char DbcLine::one_of(std::string_view letters) {
  if (rest_.empty() || letters.find(rest_.front()) == std::string_view::npos) {
    good_ = false;
    return '\0';
  }
  return take(1).front();
}

std::string DbcLine::up_to(char end) {
  const std::size_t size = rest_.find(end);
  if (size == std::string_view::npos) {
    good_ = false;
    return {};
  }
  std::string text = take(size);
  rest_.remove_prefix(1);
  return text;
}

std::string DbcLine::take(std::size_t size) {
  std::string text(rest_.substr(0, size));
  rest_.remove_prefix(size);
  return text;
}

}  // namespace hotfire
