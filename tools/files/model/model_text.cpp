// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tools/files/model/model_file.hpp"
#include "tools/files/model/model_layout.hpp"
#include "tools/files/model/toml_text.hpp"

namespace hotfire {

namespace {

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
  text += "\n[tolerance]  # relative one-sigma of a declared value; a value without one is exact\n";
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
