#include <fstream>
#include <iterator>
#include <string>

#include "tools/findings/document.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::findings {

TEST_GROUP(Findings){};

TEST(Findings, AreInsideTheirTolerancesAndPublishedAsTheyCameOut) {
  const Sets sets = load_sets(HOTFIRE_SETS);
  std::vector<Row> rows;
  for (const Finding& finding : all_findings()) {
    rows.push_back({&finding, finding.find(sets)});
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
  STRCMP_EQUAL(markdown(rows).c_str(), published.c_str());
}

TEST(Findings, AreReachedWithTheSameActuatorInEverySet) {
  const Sets sets = load_sets(HOTFIRE_SETS);
  const auto of = [](const ModelFile& model) { return std::get<SimplexParameters>(model.parameters); };
  for (const ModelFile* other : {&sets.lab, &sets.hot_fire}) {
    for (const auto& field : model::Servovalve<double>::fields()) {
      DOUBLES_EQUAL(of(sets.ambient).servovalve.*field.member, of(*other).servovalve.*field.member, 0.0);
    }
    for (const auto& field : model::Actuator<double>::fields()) {
      DOUBLES_EQUAL(of(sets.ambient).actuator.*field.member, of(*other).actuator.*field.member, 0.0);
    }
  }
}

}  // namespace hotfire::findings
