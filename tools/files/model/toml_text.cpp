// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/toml_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

namespace hotfire {

namespace {

std::string array_text(const double* values, int count) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) {
    text += (i == 0 ? "" : ", ") + number_text(values[i]);
  }
  return text + "]";
}

}  // namespace

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) {
    text += ".0";
  }
  return text;
}

std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      result += '\\';
      result += letter;
    } else if (code < 0x20 || code == 0x7F) {
      result += fmt::format("\\u{:04X}", code);
    } else {
      result += letter;
    }
  }
  return result + '"';
}

void append_line(std::string& text, const std::string& key_and_value, std::string_view unit, std::string_view meaning) {
  const std::string unit_text = unit.empty() || unit == "1" ? std::string{} : fmt::format("[{}] ", unit);
  fmt::format_to(std::back_inserter(text), "{:<40} # {}{}\n", key_and_value, unit_text, meaning);
}

namespace {

void append_choice(std::string& text, const ChoiceKey& choice) {
  append_line(text, fmt::format("{} = \"{}\"", choice.key, choice.names[static_cast<std::size_t>(*choice.value)]), "",
              fmt::format("{}", fmt::join(choice.names, " | ")));
}

}  // namespace

void append_group(std::string& text, const KeyGroup& group) {
  if (!group.options.empty()) {
    append_choice(text, {group.option_key, group.options, group.option});
  }
  for (const ChoiceKey& choice : group.choices) {
    append_choice(text, choice);
  }
  for (const NumberKey& number : group.numbers) {
    if (group.uses(number.options)) {
      append_line(text, fmt::format("{} = {}", number.name, number_text(*number.value)), number.unit, number.meaning);
    }
  }
  for (const CurveKey& curve : group.curves) {
    if (group.uses(curve.options) && !(curve.is_optional && *curve.points == 0)) {
      append_line(text, fmt::format("{} = {}", curve.x_name, array_text(curve.x, *curve.points)), curve.x_unit,
                  "points of the curve");
      append_line(text, fmt::format("{} = {}", curve.y_name, array_text(curve.y, *curve.points)), curve.y_unit,
                  curve.meaning);
    }
  }
}

}  // namespace hotfire
