// SPDX-License-Identifier: Apache-2.0
#include "tools/export/export_fmu.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "tools/export/archive.hpp"
#include "tools/export/documentation.hpp"
#include "tools/export/model_description.hpp"
#include "tools/files/text/error.hpp"
#include "tools/interface/plant/parameter_table.hpp"
#include "tools/library/declared_plant.hpp"

namespace hotfire {

namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || content.empty()) {
    throw FileError(fmt::format("{}: missing; build the target fmu_materials, or install Hotfire again", path.string()));
  }
  return content;
}

/// A C identifier from a file name.
std::string identifier_of(const std::string& name) {
  std::string identifier;
  for (const char letter : name) {
    identifier += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  }
  return identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier.front())) != 0 ? "model_" + identifier
                                                                                                 : identifier;
}

/// A token that identifies a model: the same model has the same.
std::string token_of(const std::string& plant_text, int version) {
  std::string digits;
  for (const char* half : {"first", "second"}) {
    plant::Fingerprint fingerprint;
    fingerprint.add(half);
    fingerprint.add(fmt::format("{} FMI {}\n", HOTFIRE_VERSION, version));
    fingerprint.add(plant_text);
    digits += fmt::format("{:016x}", fingerprint.value());
  }
  return fmt::format("{{{}-{}-{}-{}-{}}}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 4),
                     digits.substr(16, 4), digits.substr(20));
}

/// A text as string literals of C++, a line each.
std::string literals(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
    result += "    \"" + text.substr(at, end - at) + "\\n\"\n";
    at = end + 1;
  }
  return result;
}

/// The one file that a target compiles: the plant's topology, the interface, and the plant itself.
std::string main_source(std::string_view topology, const FmuIdentity& identity, const std::string& document) {
  const int version = identity.version;
  std::string text = fmt::format(
      "// The sources of this FMU in one file, which includes the others; as a shared library:\n"
      "//   c++ -std=c++20 -O2 -ffp-contract=off -DFMI{0}_OVERRIDE_FUNCTION_PREFIX -fPIC -shared -I. fmu.cpp -o {1}.so\n"
      "#define FMI{0}_FUNCTION_PREFIX {1}_\n"
      "#define HOTFIRE_VERSION \"{2}\"\n\n",
      version, identity.identifier, HOTFIRE_VERSION);
  for (const char* file : {"firmware/text/text.cpp", "firmware/image/image_entries.cpp", "firmware/image/plant_image.cpp",
                           "tools/interface/plant/plant.cpp"}) {
    text += fmt::format("#include \"{}\"\n", file);
  }
  text += fmt::format("#include \"tools/interface/plant/{}.cpp\"\n", topology);
  for (const char* file :
       {"tools/interface/c/saved_state.cpp", "tools/interface/c/plant_text.cpp", "tools/interface/c/hotfire.cpp",
        "tools/interface/fmu/slave.cpp", "tools/interface/fmu/slave_values.cpp", "tools/interface/fmu/document.cpp"}) {
    text += fmt::format("#include \"{}\"\n", file);
  }
  text += fmt::format("#include \"tools/interface/fmu/fmi{}.cpp\"\n", version);
  if (version == 3) {
    text += "#include \"tools/interface/fmu/fmi3_unsupported.cpp\"\n";
  }
  text += "\nnamespace hotfire::plant {\n\n// The plant below has one topology; the others are not compiled.\n";
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kTopologies{
      {{"simplex", "model::Simplex<double>::Parameters"},
       {"direct", "model::Direct<double>::Parameters"},
       {"imposed_motion", "model::ImposedMotion<double>::Parameters"},
       {"modal", "model::Modal<double>::Parameters"},
       {"electromechanical", "model::Electromechanical<double>::Parameters"},
       {"taos", "model::InstrumentedVehicle<model::Taos<double>>"},
       {"masv", "model::InstrumentedVehicle<model::Masv<double>>"}}};
  for (const auto& [name, parameters] : kTopologies) {
    if (name != topology) {
      text += fmt::format("std::unique_ptr<Plant> make_plant(const {}&, const Setup&) {{ return nullptr; }}\n", parameters);
    }
  }
  return text + "\n}  // namespace hotfire::plant\n\nconst char* const hotfire::fmu::kCompiledPlant =\n" +
         literals(document) + "    ;\n";
}

}  // namespace

ExportedFmu export_fmu(const FmuOptions& options) {
  if (!(options.period >= 1e-6 && options.period <= 1.0)) {
    throw UsageError(fmt::format("--step {}: outside its bounds; allowed: 1e-06 to 1 s", options.period));
  }
  const DeclaredPlant declared = declared_plant(options.model, options.period, options.seed);
  const auto plant = plant::make_plant(declared.parameters, declared.setup);
  const std::string plant_text = plant_text_of(declared);
  const FmuIdentity identity{options.version, declared.name, identifier_of(options.fmu.stem().string()),
                             token_of(plant_text, options.version)};
  const std::string document = fmt::format("token {}\n{}", identity.token, plant_text);

  std::map<std::string, std::string> files;
  files["modelDescription.xml"] = model_description(*plant, identity);
  files["resources/plant.txt"] = document;
  files[fmt::format("binaries/{}/{}.so", options.version == 3 ? "x86_64-linux" : "linux64", identity.identifier)] =
      content_of(options.materials / fmt::format("fmi{}.so", options.version));
  files["documentation/index.html"] = documentation_page(*plant, identity);
  files["documentation/externalDependencies.txt"] = external_dependencies();
  files["documentation/licenses/license.txt"] = content_of(options.materials / "LICENSE.txt");
  files["documentation/licenses/third-party.txt"] = content_of(options.materials / "third-party.txt");
  files["sources/fmu.cpp"] = main_source(plant->topology(), identity, document);
  files["sources/CMakeLists.txt"] = cmake_project(identity);
  if (options.version == 3) {
    files["sources/buildDescription.xml"] = build_description(identity);
  }
  const std::filesystem::path sources = options.materials / "sources";
  content_of(sources / "tools/interface/fmu/slave.hpp");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(sources)) {
    if (entry.is_regular_file()) {
      files["sources/" + std::filesystem::relative(entry.path(), sources).generic_string()] = content_of(entry.path());
    }
  }
  write_archive(options.fmu, files);
  return {plant->inputs().size(), plant->outputs().size(), plant->parameters().size(), identity.identifier};
}

}  // namespace hotfire
