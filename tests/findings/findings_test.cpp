// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tools/findings/document.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::findings {

namespace {

/// The words of two pages in turn; numbers may differ by a hundredth: another machine's library rounds the last digit of an
/// exponential otherwise, and a figure that is searched for moves with it.
void check_same_page(const std::string& name, const std::string& computed, const std::string& published) {
  std::istringstream one(computed);
  std::istringstream other(published);
  std::string word;
  std::string wanted;
  while (one >> word) {
    CHECK_TRUE_TEXT(static_cast<bool>(other >> wanted), (name + " ends early").c_str());
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end == '\0') {
      DOUBLES_EQUAL(std::strtod(wanted.c_str(), nullptr), value, 1e-2 * std::abs(value) + 1e-3);
    } else {
      STRCMP_EQUAL(word.c_str(), wanted.c_str());
    }
  }
  CHECK_TRUE_TEXT(!(other >> wanted), (name + " goes on").c_str());
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What a text says a number is tuned to: its first "6.5 Hz", or all of it where no frequency is published.
std::string published_figure(const std::string& text) {
  const std::size_t unit = text.find(" Hz");
  const std::size_t before = unit == std::string::npos ? std::string::npos : text.rfind(' ', unit - 1);
  return before == std::string::npos ? text : text.substr(before + 1, unit - before + 2);
}

/// The table of the page: what is tuned ("structure.stiffness" of a set, or words), and the cell that says to what.
std::map<std::string, std::string> tuned_by_page(const std::string& page) {
  std::map<std::string, std::string> tuned;
  std::istringstream lines(page.substr(page.find("| number | tuned to |")));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("| ")) {
    const std::size_t middle = line.find(" | ");
    const std::string number = line.substr(2, middle - 2);
    const std::size_t quoted = number.find('`');
    tuned[quoted == std::string::npos ? number : number.substr(quoted + 1, number.find('`', quoted + 1) - quoted - 1)] =
        line.substr(middle + 3, line.size() - middle - 5);
  }
  return tuned;
}

/// The keys of a set whose comment says that they are tuned, and the comment.
std::map<std::string, std::string> tuned_by_set(const std::filesystem::path& path) {
  std::map<std::string, std::string> tuned;
  std::istringstream lines(text_of(path));
  std::string line;
  std::string section;
  while (std::getline(lines, line)) {
    if (line.starts_with("[")) {
      section = line.substr(1, line.find(']') - 1);
    }
    if (const std::size_t comment = line.find("# tuned:"); comment != std::string::npos) {
      tuned[section + "." + line.substr(0, line.find(' '))] = line.substr(comment);
    }
  }
  return tuned;
}

}  // namespace

TEST_GROUP(Findings){};

TEST(Findings, AreInsideTheirTolerancesAndPublishedAsTheyCameOut) {
  const Bench bench = load_bench(HOTFIRE_SETS);
  std::vector<Row> rows;
  for (const Finding& finding : all_findings()) {
    rows.push_back({&finding, finding.find(bench)});
    for (const Figure& figure : rows.back().outcome.figures) {
      const std::string what = std::string(finding.id) + ", " + figure.what + ": " + figure_text(figure.value, figure.unit) +
                               ", allowed " + figure_text(figure.lowest, "") + " to " + figure_text(figure.highest, "");
      CHECK_TEXT(figure.inside(), what.c_str());
    }
    CHECK_TRUE(analysis::svg(rows.back().outcome.picture).ends_with("</svg>\n"));
    CHECK_TRUE(std::filesystem::exists(std::filesystem::path(HOTFIRE_SOURCE_DIR "/docs/pictures/findings") /
                                       picture_name(finding)));
  }
  for (const auto& [name, text] : pages(rows)) {
    check_same_page(name, text, text_of(std::filesystem::path(HOTFIRE_SOURCE_DIR "/docs") / name));
  }
}

TEST(Findings, AreReachedWithTheSameActuatorInTheLaboratoryAndOnTheStage) {
  const Bench bench = load_bench(HOTFIRE_SETS);
  const auto& lab = std::get<SimplexParameters>(bench.lab.parameters);
  for (const auto& axis : std::get<TaosParameters>(bench.stage.parameters).axes) {
    for (const auto& field : model::Servovalve<double>::fields()) {
      DOUBLES_EQUAL(lab.servovalve.*field.member, axis.servovalve.*field.member, 0.0);
    }
    for (const auto& field : model::Actuator<double>::fields()) {
      DOUBLES_EQUAL(lab.actuator.*field.member, axis.actuator.*field.member, 0.0);
    }
  }
}

TEST(Findings, SayOfEveryTunedNumberToWhichFigureAndOfNoFigureTwice) {
  const auto page = tuned_by_page(text_of(HOTFIRE_SOURCE_DIR "/docs/findings.md"));
  std::set<std::string> figures;
  for (const auto& [number, cell] : page) {
    CHECK_TRUE_TEXT(figures.insert(published_figure(cell)).second, cell.c_str());
  }
  std::set<std::string> in_sets;
  for (const char* set : {"lab.toml", "core-stage.toml"}) {
    for (const auto& [key, comment] : tuned_by_set(std::filesystem::path(HOTFIRE_SETS) / set)) {
      in_sets.insert(key);
      CHECK_TRUE_TEXT(page.contains(key), key.c_str());
      if (comment.find(" Hz") != std::string::npos) {
        STRCMP_EQUAL(published_figure(page.at(key)).c_str(), published_figure(comment).c_str());
      }
    }
  }
  for (const auto& [number, cell] : page) {
    CHECK_TRUE_TEXT((number.find('.') != std::string::npos) == in_sets.contains(number), number.c_str());
  }
}

TEST(Findings, AreAtLeastTwentyWithTheirOwnNamesAndMutants) {
  std::set<std::string_view> names;
  for (const Finding& finding : all_findings()) {
    names.insert(finding.id);
    CHECK_FALSE(finding.mutants.all().empty());
  }
  CHECK_EQUAL(all_findings().size(), names.size());
  CHECK_TRUE(names.size() >= 20);
}

}  // namespace hotfire::findings
