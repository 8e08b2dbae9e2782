// SPDX-License-Identifier: Apache-2.0
#include "firmware/text/json.hpp"

#include <cmath>

#include "firmware/text/text.hpp"

namespace hotfire::firmware {

void Json::add(std::string_view key, double value) {
  item(key, std::isfinite(value) ? firmware::text("%.17g", value) : "null");
}

std::string Json::quoted(std::string_view value) {
  std::string result = "\"";
  for (const char letter : value) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      result += '\\';
    }
    result += code < 0x20 ? firmware::text("\\u%04x", code) : std::string(1, letter);
  }
  return result + "\"";
}

void Json::item(std::string_view key, const std::string& value) {
  text_ += empty_ ? "" : ",";
  text_ += (key.empty() ? "" : quoted(key) + ":") + value;
  empty_ = false;
}

}  // namespace hotfire::firmware
