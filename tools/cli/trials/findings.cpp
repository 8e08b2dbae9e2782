// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/cli/shared/progress.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/findings/document.hpp"
#include "tools/trials/pictures.hpp"

namespace hotfire {

namespace {

struct FindingsOptions {
  std::string sets = HOTFIRE_SETS;
  std::vector<std::string> only;
  std::string pictures;
  std::string pages;
  bool json = false;
  bool mutants = false;
};

std::vector<const findings::Finding*> chosen(const std::vector<std::string>& only) {
  std::vector<const findings::Finding*> wanted;
  std::vector<std::string_view> known;
  for (const findings::Finding& finding : findings::all_findings()) {
    known.push_back(finding.id);
    if (only.empty() || std::find(only.begin(), only.end(), finding.id) != only.end()) {
      wanted.push_back(&finding);
    }
  }
  for (const std::string& name : only) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw UsageError(fmt::format("--only {}: no such finding; {}", name, suggestion(name, known)));
    }
  }
  return wanted;
}

nlohmann::ordered_json to_json(const std::vector<findings::Row>& rows) {
  auto all = nlohmann::ordered_json::array();
  for (const findings::Row& row : rows) {
    auto figures = nlohmann::ordered_json::array();
    for (const findings::Figure& figure : row.outcome.figures) {
      figures.push_back({{"what", figure.what},
                         {"value", figure.value},
                         {"lowest", figure.lowest},
                         {"highest", figure.highest},
                         {"unit", figure.unit},
                         {"inside", figure.inside()},
                         {"tuned", findings::is_tuned(*row.finding, figure)}});
    }
    all.push_back({{"id", row.finding->id},
                   {"title", row.finding->title},
                   {"source", row.finding->source},
                   {"found", row.outcome.inside()},
                   {"command", row.finding->command},
                   {"figures", figures},
                   {"note", row.outcome.note}});
  }
  return all;
}

void print(const std::vector<findings::Row>& rows) {
  for (const findings::Row& row : rows) {
    std::cout << fmt::format("{:<4} {:<10} {}\n", row.finding->id, row.outcome.inside() ? "found" : "NOT FOUND",
                             row.finding->title);
    for (const findings::Figure& figure : row.outcome.figures) {
      std::cout << fmt::format("       {}{}: {} (allowed {:.4g} to {:.4g})\n", figure.inside() ? "" : "OUTSIDE ",
                               figure.what, findings::figure_text(figure.value, figure.unit), figure.lowest, figure.highest);
    }
  }
}

double share(std::size_t done, std::size_t all) { return static_cast<double>(done) / static_cast<double>(all); }

/// Takes out of every finding what it is about, and says which figures notice. Returns false if a finding still holds.
bool run_mutants(const FindingsOptions& options, const findings::Bench& bench) {
  bool all_fail = true;
  auto all = nlohmann::ordered_json::array();
  const auto wanted = chosen(options.only);
  std::size_t count = 0;
  for (const findings::Finding* finding : wanted) {
    count += finding->mutants.all().size();
  }
  std::size_t done = 0;
  Progress progress;
  for (const findings::Finding* finding : wanted) {
    for (const findings::Physics physics : finding->mutants.all()) {
      progress.say(fmt::format("{} without {}", finding->id, findings::physics_name(physics)), share(done++, count));
      const findings::Outcome outcome = finding->find(findings::without(bench, physics));
      std::vector<std::string> outside;
      for (const findings::Figure& figure : outcome.figures) {
        if (!figure.inside()) {
          outside.push_back(fmt::format("{}: {}", figure.what, findings::figure_text(figure.value, figure.unit)));
        }
      }
      all_fail = all_fail && !outside.empty();
      if (options.json) {
        all.push_back({{"id", finding->id}, {"without", findings::physics_name(physics)}, {"outside", outside}});
      } else {
        std::cout << fmt::format("{:<4} {:<11} without {}: {} of {} figures outside\n", finding->id,
                                 outside.empty() ? "STILL HOLDS" : "fails", findings::physics_name(physics), outside.size(),
                                 outcome.figures.size());
        for (const std::string& figure : outside) {
          std::cout << fmt::format("       {}\n", figure);
        }
      }
    }
  }
  if (options.json) {
    print_json(all);
  }
  return all_fail;
}

void write_pages(const std::map<std::string, std::string>& pages, const std::filesystem::path& folder) {
  for (const auto& [name, text] : pages) {
    std::filesystem::create_directories((folder / name).parent_path());
    WholeFile file(folder / name);
    file.write(text);
    file.commit();
  }
}

void run_findings(const FindingsOptions& options) {
  const findings::Bench bench = findings::load_bench(options.sets);
  if (options.mutants) {
    if (!run_mutants(options, bench)) {
      throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_verdict));
    }
    return;
  }
  std::vector<findings::Row> rows;
  bool all_found = true;
  const auto wanted = chosen(options.only);
  Progress progress;
  for (const findings::Finding* finding : wanted) {
    progress.say(fmt::format("{}: {}", finding->id, finding->title), share(rows.size(), wanted.size()));
    rows.push_back({finding, finding->find(bench)});
    all_found = all_found && rows.back().outcome.inside();
    if (!options.pictures.empty()) {
      const std::filesystem::path picture = std::filesystem::path(options.pictures) / findings::picture_name(*finding);
      std::filesystem::create_directories(picture.parent_path());
      trials::write_picture(rows.back().outcome.picture, picture);
    }
  }
  if (!options.pages.empty()) {
    write_pages(findings::pages(rows), options.pages);
  }
  if (options.json) {
    print_json(to_json(rows));
  } else {
    print(rows);
  }
  if (!all_found) {
    throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_verdict));
  }
}

}  // namespace

void add_findings(CLI::App& program) {
  const auto options = std::make_shared<FindingsOptions>();
  CLI::App* command =
      program.add_subcommand("findings", "Reproduce the findings of the papers: figures, tolerances, verdicts");
  command->add_option("--sets", options->sets, "folder with lab.toml and core-stage.toml; default: the shipped ones");
  command->add_option("--only", options->only, "only these findings, as in F1,F9")->delimiter(',');
  command->add_option("--pictures", options->pictures, "folder for a picture of each finding (.svg)");
  command->add_option("--pages", options->pages, "folder for the pages findings.md and findings/ (Markdown)")
      ->type_name("FOLDER")
      ->excludes("--only");
  command->add_flag("--json", options->json, "print the result as JSON");
  command
      ->add_flag("--mutants", options->mutants,
                 "remove the physics of each finding from the model: every one of these runs must fail")
      ->excludes("--pages")
      ->excludes("--pictures");
  command->footer(
      "Example: hotfire findings --only F1,F2 --pictures pictures\nExit status: 1 if a figure is outside its tolerance, or "
      "if all figures of a mutant are inside.");
  command->callback([options] { run_findings(*options); });
}

}  // namespace hotfire
