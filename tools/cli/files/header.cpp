// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/simulate/plant_image_text.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

namespace {

struct HeaderOptions {
  std::string model;
  std::string output;
  std::string name = "kPlantImage";
  bool json = false;
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

void require_identifier(const std::string& name) {
  const bool good = !name.empty() && is_letter(name.front()) &&
                    std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
  if (!good) {
    throw UsageError(fmt::format("--name {}: allowed is a C++ name of letters, digits and \"_\"", name));
  }
}

/// An entry of `model::ImageEntry` for a line `key value` of a plant image. A value that is not a number is a word.
std::string entry_of(const std::string& line) {
  const std::size_t space = line.find(' ');
  const std::string key = line.substr(0, space);
  const std::string value = line.substr(space + 1);
  const bool is_number = value.find("0x") != std::string::npos;
  return is_number ? fmt::format("    {{\"{}\", {}}},\n", key, value)
                   : fmt::format("    {{\"{}\", 0.0, \"{}\"}},\n", key, value);
}

std::string header_of(const HeaderOptions& options, const ModelFile& model) {
  std::string text = fmt::format(
      "// Written by hotfire {} from {:?}: parameters in SI, exact, for hotfire::model::parameters_of.\n"
      "#pragma once\n\n#include \"model/image.hpp\"\n\ninline constexpr hotfire::model::ImageEntry {}[] = {{\n",
      HOTFIRE_VERSION, std::filesystem::path(options.model).filename().string(), options.name);
  std::istringstream lines(plant_image_text(model));
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.starts_with("schema ") && !line.starts_with("topology ")) {
      text += entry_of(line);
    }
  }
  return text + "};\n";
}

void run_header(const HeaderOptions& options) {
  require_identifier(options.name);
  if (is_vehicle(options.model)) {
    throw UsageError("--model " + options.model +
                     ": a header holds one axis; allowed are \"simplex\" and \"direct\" models");
  }
  write_whole_file(options.output, header_of(options, load_model(options.model)));
  if (options.json) {
    print_json({{"output", options.output}, {"name", options.name}});
    return;
  }
  std::cout << options.output << '\n';
}

}  // namespace

void add_header(CLI::App& program) {
  const auto options = std::make_shared<HeaderOptions>();
  CLI::App* command = program.add_subcommand("header", "Write a model's parameters as a C++ header for a small target");
  command->add_option("--model", options->model, "model file (.toml) of one axis")->required();
  command->add_option("--output", options->output, "header to write (.hpp)")->required();
  command->add_option("--name", options->name, "name of the array in the header")->capture_default_str();
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Example: hotfire header --model axis.toml --output axis_image.hpp --name kAxisImage\n"
      "The function hotfire::model::parameters_of reads the array: docs/interfaces/small-targets.md.");
  command->callback([options] { run_header(*options); });
}

}  // namespace hotfire
