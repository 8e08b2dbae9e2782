// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hotfire::firmware {

/// Writes JSON piece by piece, so that the real-time executable needs no library for it. A value that is not finite becomes
/// null.
class Json {
 public:
  void open(std::string_view key = {}) { item(key, "{"), empty_ = true; }
  void open_list(std::string_view key) { item(key, "["), empty_ = true; }
  void close() { text_ += "}", empty_ = false; }
  void close_list() { text_ += "]", empty_ = false; }

  void add(std::string_view key, std::string_view value) { item(key, quoted(value)); }
  void add(std::string_view key, const char* value) { add(key, std::string_view(value)); }
  void add(std::string_view key, bool value) { item(key, value ? "true" : "false"); }
  void add(std::string_view key, int value) { item(key, std::to_string(value)); }
  void add(std::string_view key, unsigned value) { item(key, std::to_string(value)); }
  void add(std::string_view key, std::int64_t value) { item(key, std::to_string(value)); }
  void add(std::string_view key, std::uint64_t value) { item(key, std::to_string(value)); }
  void add(std::string_view key, double value);

  const std::string& text() const { return text_; }

 private:
  static std::string quoted(std::string_view value);
  void item(std::string_view key, const std::string& value);

  std::string text_;
  bool empty_ = true;
};

}  // namespace hotfire::firmware
