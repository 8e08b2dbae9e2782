#include <fmt/format.h>

#include <iterator>

#include "tools/files/model_file.hpp"
#include "tools/files/model_layout.hpp"

namespace hotfire {

namespace {

/// The fewest digits that restore a number. TOML reads digits alone as an integer, which has no -0 and no 1e300.
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

std::string array_text(const double* values, int count) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) {
    text += (i == 0 ? "" : ", ") + number_text(values[i]);
  }
  return text + "]";
}

void append_line(std::string& text, const std::string& key_and_value, std::string_view unit, std::string_view meaning) {
  const std::string unit_text = unit.empty() || unit == "1" ? std::string{} : fmt::format("[{}] ", unit);
  fmt::format_to(std::back_inserter(text), "{:<40} # {}{}\n", key_and_value, unit_text, meaning);
}

void append_group(std::string& text, const KeyGroup& group) {
  if (!group.options.empty()) {
    std::string others;
    for (const std::string_view option : group.options) {
      others += fmt::format("{}{}", others.empty() ? "" : " | ", option);
    }
    const auto chosen = group.options[static_cast<std::size_t>(*group.option)];
    append_line(text, fmt::format("{} = \"{}\"", group.option_key, chosen), "", others);
  }
  for (const NumberKey& number : group.numbers) {
    if (group.uses(number.options)) {
      append_line(text, fmt::format("{} = {}", number.name, number_text(*number.value)), number.unit, number.meaning);
    }
  }
  for (const CurveKey& curve : group.curves) {
    if (group.uses(curve.options)) {
      append_line(text, fmt::format("{} = {}", curve.x_name, array_text(curve.x, *curve.points)), curve.x_unit,
                  "points of the curve");
      append_line(text, fmt::format("{} = {}", curve.y_name, array_text(curve.y, *curve.points)), curve.y_unit,
                  curve.meaning);
    }
  }
}

void append_noise(std::string& text, const ModelFile& model, const ModelLayout& layout) {
  if (model.noise.empty()) {
    return;
  }
  text += "\n[sensors]\n";
  for (const ModelChannel& channel : layout.channels) {
    const auto noise = model.noise.find(std::string{channel.name});
    if (noise != model.noise.end()) {
      append_line(text, fmt::format("{}_noise = {}", channel.name, number_text(noise->second)), channel.unit,
                  "rms noise of the channel");
    }
  }
}

void append_tolerance(std::string& text, const ModelFile& model) {
  if (model.tolerance.empty()) {
    return;
  }
  text += "\n[tolerance]  # relative one-sigma of a declared value; what is not named is exact\n";
  for (const auto& [key, relative] : model.tolerance) {
    text += fmt::format("{} = {}\n", key, number_text(relative));
  }
}

}  // namespace

std::string model_text(const ModelFile& model) {
  ModelFile own = model;
  const ModelLayout layout = layout_of(own);
  std::string text = fmt::format("schema = 1\nname = {}\ntopology = \"{}\"\n", toml_string(model.name), layout.topology);
  for (const KeyGroup& part : layout.parts) {
    text += fmt::format("\n[{}]\n", part.name);
    append_group(text, part);
  }
  append_noise(text, model, layout);
  append_tolerance(text, model);
  for (const KeyGroup& effect : layout.effects) {
    if (*effect.active) {
      text += fmt::format("\n[effects.{}]  # site: {}\n", effect.name, effect.site);
      append_group(text, effect);
    }
  }
  return text;
}

}  // namespace hotfire
