// SPDX-License-Identifier: Apache-2.0
#include "tools/findings/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

namespace hotfire::findings {

namespace {

constexpr std::string_view kHead = R"(# Results of the two papers, reproduced

With this page you can check which published results the model reproduces, and repeat each one with
`hotfire findings --only F1`. `hotfire findings --pages docs` writes this page and the pages of the figures. The test
`findings_tests` compares the pages with that output, and every figure with its tolerance.

The parameter sets are files in [tools/findings/sets](../tools/findings/sets):

- `lab` is one actuator in its laboratory.
- `core-stage` is one engine with two axes. It is at hot fire, and with `--thrust 0` at ambient.

The sets are *representative, tuned to the published frequencies*. NASA's own values are not public. A comment at each number
names its origin.

Every finding can fail. `hotfire findings --mutants` removes the physics that a finding is about. At least one figure must then
be outside its range (`ctest -R findings_mutants`). Each finding names that physics.

Four numbers are tuned. Each is tuned to one published figure, and no figure is used twice:

| number | tuned to |
|---|---|
| `structure.stiffness` of the stage | the piston's notch of 9.5 Hz at hot fire [GF] |
| `gimbal.unloaded_structure` | the piston's notch of 6.5 Hz in the ambient sweep [GF slide Results] |
| impulse of the blow in F3 | the pendulum of 6.75 Hz [SD 2.2]; the real blow is not published |
| `servovalve.pressure_feedback_gain` | an ambient step that is underdamped [SD fig. 9] |

All other numbers are chosen:

- F6 to F8 guided the choice of friction and damping. The amplitude dependence of F7 and the shape of the steps of F8 follow
  from this friction.
- The tolerances of F6 to F8, F16 and F21 are our own, because the papers show only pictures there.
- Nothing is tuned to the quiescent peaks of F4, the amplitude dependence of F2, and the turn from lag to lead of F16.

Limits of the comparison:

- **The predicted pendulum of 7.5 to 8 Hz is not an independent figure.** The paper has it from finite elements without
  friction. Here it is the frequency after the impact of F3, with a linear actuator. The sticking bearing raises this
  frequency. Without friction it is 6.5 Hz, as in the sweep.
- **Friction of the empty stage is not negligible here.** [SD 2.3] calls it negligible. The bearing carries the weight of the
  engine, 34 kN, and sticks below 0.35 kN m. F3 to F5 need that.
- **The empty vehicle and the unloaded gimbal are not separated.** The papers name both as soft at ambient. Here the
  attach points carry all of it. A bearing that is soft along the thrust would couple pitch and yaw into two notches each.
- **F9 does not hold for the shipped friction.** The notch survives on a rigid gimbal with mu 0.08. The notch disappears at 0.18.
- **F15 holds at seven locations of eight once the structure is more than a spring.** With a third of the load flexibility in
  modes, the deepest notch of the eighth is that of a mode. In F12 the stiffness from the notch then scatters over the
  locations by a quarter.
- **F21 needs both axes.** Under the Green Run profile pitch follows the linear model at 0.4 Hz, because yaw moves fast beside
  it. The engine in pitch alone loses 0.8 dB there and lags by 9 deg.
- **F17 follows the friction.** More friction makes the difference larger. No publication has this figure.
- **6.75 Hz fixes one of two numbers.** 10 % of `low_stiffness` moves the pendulum by 1 %, and so does 5 % of the blow. A softer
  actuator under a smaller blow has the same frequency (F3). The blow is tuned. `low_stiffness` is chosen, because [SD fig. 4]
  is a picture.

)";

/// A published number and the figure that is compared with it.
struct Published {
  std::string_view what;
  std::string_view published;
  std::string_view finding;
  std::string_view figure;  ///< how the figure's name begins
  std::string_view tuned;
};

constexpr std::array kPublished{
    Published{"load resonance at hot fire, piston [GF]", "9.5 Hz", "F7", "notch of the piston in pitch", "tuned"},
    Published{"load resonance at ambient, piston [GF]", "6.5 Hz", "F5", "notch of the piston at 0.4 deg", "tuned"},
    Published{"pendulum, actuator locked [SD 2.2]", "6.75 Hz", "F3", "pendulum with soft", "blow tuned"},
    Published{"pendulum predicted, linear actuator [SD 2.2]", "7.5 to 8 Hz", "F3", "pendulum with linear",
              "given up: friction stiffens it"},
    Published{"quiescent peaks, highest [SD fig. 7]", "8.2 Hz", "F4", "largest peak under 1 ", "no"},
    Published{"quiescent peaks, lowest [SD fig. 7]", "5.9 Hz", "F4", "largest peak under 100000", "no"},
    Published{"ambient to hot fire [GF]", "1.46", "F19", "shift by the thrust", "by both notches"}};

void append_published(std::string& text, const std::vector<Row>& rows) {
  const auto add = std::back_inserter(text);
  fmt::format_to(add, "Published against reached:\n\n| | published | reached | tuned |\n|---|---|---|---|\n");
  for (const Published& one : kPublished) {
    for (const Row& row : rows) {
      for (const Figure& figure : row.outcome.figures) {
        if (row.finding->id == one.finding && figure.what.starts_with(one.figure)) {
          fmt::format_to(add, "| {} | {} | {} | {} |\n", one.what, one.published, figure_text(figure.value, figure.unit),
                         one.tuned);
        }
      }
    }
  }
  text += '\n';
}

/// The commands that show a finding: that of the findings, and that of its test where there is one.
std::string commands_of(const Finding& finding) {
  std::string text = fmt::format("hotfire findings --only {}    # these figures\n", finding.id);
  if (!finding.command.starts_with("hotfire findings")) {
    text += fmt::format("{}\n", finding.command);
  }
  return text;
}

/// A text with a line for each sentence. A full stop before a number is that of "fig. 11".
std::string sentence_lines(std::string text) {
  for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 2)) {
    const char next = text[at + 2];
    if (next < '0' || next > '9') {
      text[at + 1] = '\n';
    }
  }
  return text;
}

std::string source_of(const Finding& finding) {
  return finding.source.empty() ? std::string() : fmt::format("[{}]", finding.source);
}

/// "findings/f1-f10.md".
std::string page_name(std::span<const Row> rows) {
  return fmt::format("findings/f{}-f{}.md", rows.front().finding->id.substr(1), rows.back().finding->id.substr(1));
}

/// The figures of some findings, each with its tolerance, and the physics without which it fails.
std::string figures_page(std::span<const Row> rows) {
  std::string text = fmt::format(
      "# Figures of the findings {} to {}\n\nWith this page you can compare each figure with its allowed range, and see "
      "without which physics the finding fails.\n[findings.md](../findings.md) has the table of all findings.\n",
      rows.front().finding->id, rows.back().finding->id);
  const auto add = std::back_inserter(text);
  for (const Row& row : rows) {
    fmt::format_to(add,
                   "\n## {}\n\nFinding: {}{}{}.\n\nShown: {}.\n\n```\n{}```\n\n"
                   "| figure | reached | allowed | |\n|---|---|---|---|\n",
                   row.finding->id, row.finding->title, row.finding->source.empty() ? "" : " ", source_of(*row.finding),
                   row.finding->shown, commands_of(*row.finding));
    for (const Figure& figure : row.outcome.figures) {
      fmt::format_to(add, "| {} | {} | {:.4g} to {} | {}{} |\n", figure.what, figure_text(figure.value, figure.unit),
                     figure.lowest, figure_text(figure.highest, figure.unit), figure.inside() ? "inside" : "**outside**",
                     is_tuned(*row.finding, figure) ? ", tuned" : "");
    }
    fmt::format_to(add, "\nFails without: ");
    for (const Physics physics : row.finding->mutants.all()) {
      fmt::format_to(add, "{}`{}`", physics == row.finding->mutants.all().front() ? "" : ", ", physics_name(physics));
    }
    fmt::format_to(add, ".\n");
    if (!row.outcome.note.empty()) {
      fmt::format_to(add, "\n{}\n", sentence_lines(row.outcome.note));
    }
    fmt::format_to(add, "\n![{}](../pictures/findings/{})\n", row.finding->id, picture_name(*row.finding));
  }
  return text;
}

}  // namespace

bool is_tuned(const Finding& finding, const Figure& figure) {
  return std::ranges::any_of(kPublished, [&](const Published& one) {
    return one.finding == finding.id && figure.what.starts_with(one.figure) && one.tuned != "no" &&
           !one.tuned.starts_with("given up");
  });
}

std::string figure_text(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

std::string picture_name(const Finding& finding) {
  constexpr int kInFolder = 10;
  const int first = (std::stoi(std::string(finding.id.substr(1))) - 1) / kInFolder * kInFolder + 1;
  return fmt::format("f{}-f{}/{}.svg", first, first + kInFolder - 1, finding.id);
}

std::map<std::string, std::string> pages(const std::vector<Row>& rows) {
  std::map<std::string, std::string> all;
  std::string overview(kHead);
  append_published(overview, rows);
  overview += "| | finding | source | verdict |\n|---|---|---|---|\n";
  const auto add = std::back_inserter(overview);
  constexpr std::size_t kOnPage = 10;
  constexpr std::size_t kFewest = 5;  // fewer than this have no page of their own
  for (std::size_t first = 0; first < rows.size();) {
    const std::size_t left = rows.size() - first;
    const std::span<const Row> some(&rows[first], left < kOnPage + kFewest ? left : kOnPage);
    first += some.size();
    const std::string name = page_name(some);
    for (const Row& row : some) {
      fmt::format_to(add, "| [{}]({}#f{}) | {} | {} | {} |\n", row.finding->id, name, row.finding->id.substr(1),
                     row.finding->title, source_of(*row.finding), row.outcome.inside() ? "found" : "**not found**");
    }
    all[name] = figures_page(some);
  }
  all["findings.md"] = overview;
  return all;
}

}  // namespace hotfire::findings
