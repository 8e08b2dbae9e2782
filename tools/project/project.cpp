// SPDX-License-Identifier: Apache-2.0
#include "tools/project/project.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/project/example_records.hpp"
#include "tools/project/templates.hpp"

namespace hotfire {

namespace {

constexpr const char* kModel = "declared.toml";
constexpr const char* kProfile = "profile.toml";
constexpr const char* kReadMe = "README.md";

/// A template with every `@key@` replaced.
std::string filled(std::string text, const std::string& key, const std::string& value) {
  const std::string mark = "@" + key + "@";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

/// The name of the model: it is written between the quotes of a TOML string and as a heading.
std::string name_of(const std::filesystem::path& folder) {
  const std::filesystem::path last = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  std::string name = last.string();
  const bool is_plain = !name.empty() && name != "." && name != ".." && std::ranges::all_of(name, [](unsigned char c) {
    return c >= ' ' && c != 0x7f && c != '"' && c != '\\' && c != '@';
  });
  if (!is_plain) {
    throw UsageError(
        fmt::format("NAME {}: it is the name of a new folder and of its model; give one without quotes, "
                    "backslashes, @ and control characters, for example 'hotfire new rig'",
                    folder.string()));
  }
  return name;
}

void require_new(const std::filesystem::path& folder) {
  std::error_code failed;
  if (std::filesystem::exists(folder, failed) &&
      (!std::filesystem::is_directory(folder, failed) || !std::filesystem::is_empty(folder, failed))) {
    throw UsageError(
        fmt::format("{} exists already, and nothing in it is replaced; give the name of a new folder", folder.string()));
  }
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    throw UsageError(fmt::format("{}: {}; give a folder that can be written", folder.string(), failed.message()));
  }
}

}  // namespace

std::vector<std::string> project_kinds() { return {"simplex", "direct", "taos"}; }

Project make_project(const std::filesystem::path& folder, const std::string& kind) {
  const std::vector<std::string> kinds = project_kinds();
  if (std::ranges::find(kinds, kind) == kinds.end()) {
    throw UsageError(fmt::format("--kind {}: {}", kind, suggestion(kind, {kinds.begin(), kinds.end()})));
  }
  const std::string name = name_of(folder);
  require_new(folder);

  Project project{folder, {kModel}, {}};
  const std::string declared = filled(std::string(project_template(kind + ".toml")), "name", name);
  write_whole_file(folder / kModel, declared);
  std::vector<std::string> records;
  for (const ExampleRecord& example : example_records(declared, kind)) {
    write_record(example.record, folder / example.file);
    records.push_back(example.file);
  }
  project.files.insert(project.files.end(), records.begin(), records.end());
  std::string profile_row;
  if (kind == "simplex") {
    write_whole_file(folder / kProfile, project_template("lab_profile.toml"));
    project.files.emplace_back(kProfile);
    profile_row =
        "| `profile.toml` | a profile of `hotfire lab`, which drives an actuator | set its limits to those of your rig "
        "before "
        "the first run |\n";
  }
  project.commands = {fmt::format("hotfire check {}", fmt::join(project.files, " ")),
                      fmt::format("hotfire explain --model {} --out found {}", kModel, fmt::join(records, " ")),
                      "hotfire plant --model found/explained.toml --bus sim --cycles 10000"};
  std::string text(project_template(kReadMe));
  text = filled(std::move(text), "name", name);
  text = filled(std::move(text), "check", project.commands[0]);
  text = filled(std::move(text), "explain", project.commands[1]);
  text = filled(std::move(text), "plant", project.commands[2]);
  text = filled(std::move(text), "steps", records.front());
  text = filled(std::move(text), "sweep", records.back());
  text = filled(std::move(text), "profile", profile_row);
  text = filled(std::move(text), "missing", example_effect(kind).words);
  write_whole_file(folder / kReadMe, text);
  project.files.emplace_back(kReadMe);
  return project;
}

}  // namespace hotfire
