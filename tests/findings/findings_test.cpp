// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "tools/findings/document.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::findings {

namespace {

/// The words of two pages in turn; numbers may differ by a hundredth: another machine's library rounds the last digit of an
/// exponential otherwise, and a figure that is searched for moves with it.
void check_same_page(const std::string& computed, const std::string& published) {
  std::istringstream one(computed);
  std::istringstream other(published);
  std::string word;
  std::string wanted;
  while (one >> word) {
    CHECK_TRUE_TEXT(static_cast<bool>(other >> wanted), "docs/findings.md ends early");
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end == '\0') {
      DOUBLES_EQUAL(std::strtod(wanted.c_str(), nullptr), value, 1e-2 * std::abs(value) + 1e-3);
    } else {
      STRCMP_EQUAL(word.c_str(), wanted.c_str());
    }
  }
  CHECK_TRUE_TEXT(!(other >> wanted), "docs/findings.md goes on");
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
  std::ifstream file(HOTFIRE_SOURCE_DIR "/docs/findings.md");
  const std::string published(std::istreambuf_iterator<char>(file), {});
  check_same_page(markdown(rows), published);
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
