// SPDX-License-Identifier: Apache-2.0
#include "tools/project/project.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <string>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/text/error.hpp"
#include "tools/project/example_records.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tests/support/refusal.hpp"

namespace hotfire {

using test::expect_message;

namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What a model file's text leaves of the first measured channel of a record, rms over the declared noise.
double left_over_noise(const std::string& text, const Record& record) {
  std::map<std::string, double> noise;
  Record modelled;
  if (is_vehicle(text, "model")) {
    const VehicleFile model = parse_vehicle(text, "model");
    noise = model.axes.front().noise;
    modelled = simulate(model, record);
  } else {
    const ModelFile model = parse_model(text, "model");
    noise = model.noise;
    modelled = simulate(model, record);
  }
  for (const Channel& channel : record.channels) {
    const auto found = noise.find(std::string(own_name(channel.name)));
    if (found == noise.end()) {
      continue;
    }
    const Channel& other = *modelled.find(channel.name);
    double sum = 0.0;
    for (std::size_t row = 0; row < record.rows; ++row) {
      sum += std::pow(channel.values[row] - other.values[row], 2);
    }
    return std::sqrt(sum / static_cast<double>(record.rows)) / found->second;
  }
  return 0.0;
}

}  // namespace

TEST_GROUP(Project) {
  test::Scratch scratch;

  void refuses(const std::filesystem::path& folder, const std::string& kind, std::initializer_list<const char*> parts) {
    expect_message(test::refusal<UsageError>([&] { make_project(folder, kind); }), parts);
  }
};

TEST(Project, declared_model_of_every_kind_misses_what_acts_in_its_example_records_and_nothing_else) {
  for (const std::string& kind : project_kinds()) {
    const auto folder = scratch.path(kind);
    make_project(folder, kind);
    const std::string declared = text_of(folder / "declared.toml");
    STRCMP_CONTAINS(("name = \"" + kind + "\"").c_str(), declared.c_str());
    STRCMP_CONTAINS(("topology = \"" + kind + "\"").c_str(), declared.c_str());
    for (const char* file : {"steps.csv", "multisine.csv"}) {
      const Record record = load_record(folder / file);
      // White noise of 13,500 rows is known to a percent, and a mass starts at its first reading, noise and all, which
      // decays; an effect that is identified is many times the noise.
      CHECK(left_over_noise(declared, record) > 5.0);
      DOUBLES_EQUAL(1.0, left_over_noise(declared + example_effect(kind).toml, record), 0.1);
    }
  }
}

TEST(Project, readme_has_the_commands_and_they_run_in_its_folder) {
  const auto folder = scratch.path("stage");
  const Project project = make_project(folder, "direct");
  const std::string readme = text_of(folder / "README.md");
  UNSIGNED_LONGS_EQUAL(3, project.commands.size());
  for (const std::string& command : project.commands) {
    CHECK(readme.find("\n" + command + "\n") != std::string::npos);
    const std::string line = "cd " + folder.string() + " && " + std::string(HOTFIRE_PROGRAM) +
                             command.substr(std::string("hotfire").size()) + " >out 2>err";
    const int status = WEXITSTATUS(std::system(line.c_str()));
    // 4: this machine is not in real time, which the plant says.
    CHECK(status == 0 || (status == 4 && command.starts_with("hotfire plant")));
  }
  expect_message(text_of(folder / "found" / "explained.toml"), {"[effects.sliding_friction]"});
  CHECK(readme.find('@') == std::string::npos);
}

TEST(Project, readme_lists_every_file) {
  for (const std::string& kind : project_kinds()) {
    const Project project = make_project(scratch.path(kind), kind);
    const std::string readme = text_of(project.folder / "README.md");
    for (const std::string& file : project.files) {
      CHECK(std::filesystem::exists(project.folder / file));
      CHECK(file == "README.md" || readme.find("`" + file + "`") != std::string::npos);
    }
  }
}

TEST(Project, nothing_that_exists_is_replaced) {
  const auto folder = scratch.path("rig");
  make_project(folder, "simplex");
  const std::string before = text_of(folder / "declared.toml");
  refuses(folder, "direct", {"exists already", "a new folder"});
  STRCMP_EQUAL(before.c_str(), text_of(folder / "declared.toml").c_str());
  refuses(folder / "declared.toml", "direct", {"exists already"});
}

TEST(Project, unknown_kind_and_a_name_that_no_file_can_hold_are_refused_before_anything_is_written) {
  refuses(scratch.path("rig"), "simplx", {"--kind simplx", "did you mean \"simplex\"", "direct, taos"});
  CHECK(!std::filesystem::exists(scratch.path("rig")));
  refuses(scratch.path("a\"b"), "simplex", {"without quotes"});
  CHECK(!std::filesystem::exists(scratch.path("a\"b")));
}

}  // namespace hotfire
