// SPDX-License-Identifier: Apache-2.0
// hotfire-study: how often the finder is right, on cases made by an independent simulator (docs/study.md).

#include <fmt/format.h>
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "tools/files/text/error.hpp"
#include "tools/files/text/private_folder.hpp"
#include "tools/study/cases/case.hpp"
#include "tools/study/cases/orders.hpp"
#include "tools/study/tally/candidate_fit.hpp"
#include "tools/study/tally/cost.hpp"
#include "tools/study/tally/judge.hpp"
#include "tools/study/tally/sensitivity.hpp"
#include "tools/study/tally/similarity.hpp"
#include "tools/study/tally/tally.hpp"

namespace hotfire::study {
namespace {

struct Options {
  Selection selection;
  std::string out;
  std::vector<std::string> folders;
  unsigned threads = 1;
  bool generate_only = false;
  bool listed = false;      ///< of `wild`: each beside a listed effect
  bool similarity = false;  ///< each case twice, the second time on a smaller and faster rig
  bool json = false;
};

/// Where cases are written: the user's folder, or one of our own that goes with us.
class Workplace {
 public:
  explicit Workplace(const std::string& wanted) : wanted_(wanted) {
    if (wanted.empty()) {
      try {
        own_.emplace();
      } catch (const FileError& error) {
        throw UsageError(std::string(error.what()) + "; give a folder with --out");
      }
    }
  }
  const std::filesystem::path& folder() const { return own_ ? own_->path() : wanted_; }

 private:
  std::filesystem::path wanted_;
  std::optional<PrivateFolder> own_;
};

/// Judges case after case, a line each as it goes.
class Court {
 public:
  explicit Court(const Options& options) : options_(options) { google::SetCommandLineOption("minloglevel", "3"); }

  void judge_case(const std::filesystem::path& folder) {
    if (options_.similarity) {
      pairs_.push_back(judge_similar(folder, options_.threads));
      std::cout << (options_.json ? json_of(pairs_.back()).dump() : line_of(pairs_.back())) << std::endl;
      return;
    }
    judgements_.push_back(judge(folder, options_.threads));
    if (options_.json) {
      std::cout << json_of(judgements_.back()).dump() << std::endl;
    } else {
      std::cout << line_of(judgements_.back()) << std::endl;
    }
  }

  ExitStatus close() const {
    if (options_.similarity) {
      std::cout << (options_.json ? nlohmann::json{{"met", all_met(pairs_)}}.dump() + "\n" : "\n" + summary_of(pairs_));
      return all_met(pairs_) ? ExitStatus::good : ExitStatus::bad_verdict;
    }
    if (options_.json) {
      std::cout << summary_json(judgements_).dump() << '\n';
    } else {
      std::cout << '\n' << summary_of(judgements_);
    }
    return all_met(judgements_) ? ExitStatus::good : ExitStatus::bad_verdict;
  }

 private:
  const Options& options_;
  std::vector<Judgement> judgements_;
  std::vector<SimilarPair> pairs_;
};

ExitStatus study(const std::vector<CaseOrder>& orders, const Options& options) {
  if (options.generate_only && options.out.empty()) {
    throw UsageError("--generate-only: say with --out where the cases shall stay");
  }
  const Workplace workplace(options.out);
  Court court(options);
  bool all_made = true;
  for (const CaseOrder& order : orders) {
    const std::filesystem::path folder = workplace.folder() / order.name;
    // One case that cannot be made is no reason to lose the others.
    try {
      write_case(make_case(order), folder);
    } catch (const std::runtime_error& error) {
      std::cerr << "hotfire-study: " << order.name << " is left out: " << error.what() << std::endl;
      all_made = false;
      continue;
    }
    if (options.generate_only) {
      std::cout << folder.string() << std::endl;
    } else {
      court.judge_case(folder);
    }
  }
  const ExitStatus status = options.generate_only ? ExitStatus::good : court.close();
  return all_made ? status : ExitStatus::bad_data;
}

ExitStatus judge_folders(const Options& options) {
  Court court(options);
  for (const std::string& folder : options.folders) {
    court.judge_case(std::filesystem::path(folder).lexically_normal());
  }
  return court.close();
}

/// What `cost` explains.
struct CostArguments {
  std::string folder;
  unsigned threads = 1;
  bool json = false;
};

ExitStatus cost_of_one(const CostArguments& arguments) {
  google::SetCommandLineOption("minloglevel", "3");
  const auto points = cost_by_length(std::filesystem::path(arguments.folder).lexically_normal(), arguments.threads);
  std::cout << (arguments.json ? json_of(points).dump() + "\n" : table_of(points));
  return ExitStatus::good;
}

void add_threads(CLI::App& command, unsigned& threads) {
  command.add_option("--threads", threads, "threads to use")->check(CLI::Range(1U, 256U))->capture_default_str();
}

void add_cost(CLI::App& program, CostArguments& arguments) {
  CLI::App* command = program.add_subcommand("cost", "Measure what explaining a case costs, over the length of its records");
  command->add_option("folder", arguments.folder, "folder of a case, with given/")->required();
  add_threads(*command, arguments.threads);
  command->add_flag("--json", arguments.json, "print the result as one JSON object");
  command->footer("Example: hotfire-study cost cases/leakage-1");
}

/// What `fit` fits.
struct FitArguments {
  std::string folder;
  std::string effect;
  std::string law;
  unsigned threads = 1;
  bool json = false;
};

ExitStatus fit_one(const FitArguments& arguments) {
  google::SetCommandLineOption("minloglevel", "3");
  const CandidateFit fit = fit_candidate(std::filesystem::path(arguments.folder).lexically_normal(), arguments.effect,
                                         arguments.law, arguments.threads);
  if (arguments.json) {
    std::cout << json_of(fit).dump() << '\n';
    return ExitStatus::good;
  }
  std::cout << fmt::format("{}: {} fitted in {:.2f} s ({:.2f} s of processor); on the unseen record, in sensor noise:",
                           fit.name, fit.candidate, fit.seconds, fit.processor_seconds);
  for (const auto& [channel, error] : fit.after) {
    std::cout << fmt::format(" {} {:.3f}", channel, error);
  }
  std::cout << '\n';
  return ExitStatus::good;
}

void add_fit(CLI::App& program, FitArguments& arguments) {
  CLI::App* command = program.add_subcommand("fit", "Fit one candidate to a case, without a search");
  command->add_option("folder", arguments.folder, "folder of a case, with given/ and kept/")->required();
  command->add_option("--effect", arguments.effect, "name of the candidate effect, as in section 5 of docs/physics.md")
      ->required();
  command->add_option("--law", arguments.law, "law of the effect, if it has several");
  add_threads(*command, arguments.threads);
  command->add_flag("--json", arguments.json, "print the result as one JSON object");
  command->footer("Example: hotfire-study fit cases/leakage-1 --effect leakage");
}

/// What `sensitivity` varies.
struct SensitivityArguments {
  std::vector<std::string> folders;
  std::vector<std::string> only;
  std::string keep;
  unsigned threads = 1;
};

/// A line a ruling as it is made, into a file too if one is given; then the table.
ExitStatus vary_policy(const SensitivityArguments& arguments) {
  google::SetCommandLineOption("minloglevel", "3");
  const std::vector<Variation> varied = variations(arguments.only);
  std::vector<std::filesystem::path> folders;
  for (const std::string& folder : arguments.folders) {
    folders.push_back(std::filesystem::path(folder).lexically_normal());
  }
  std::vector<Ruling> known;
  std::ofstream kept;
  if (!arguments.keep.empty()) {
    known = load_rulings(arguments.keep);
    kept.open(arguments.keep, std::ios::app);
    if (!kept) {
      throw UsageError(arguments.keep + ": cannot be written; give another file with --keep");
    }
  }
  const std::size_t all = varied.size() * folders.size();
  std::size_t made = known.size();
  const auto rulings = sensitivity(folders, varied, std::move(known), arguments.threads, [&](const Ruling& ruling) {
    std::cerr << fmt::format("{} of {}: {} x {}: {} {}\n", ++made, all,
                             ruling.constant.empty() ? "as it is" : ruling.constant, ruling.factor, ruling.name,
                             ruling.good ? "good" : "not good");
    if (kept.is_open()) {
      kept << json_of(ruling).dump() << std::endl;
    }
  });
  const std::vector<Change> changes = changes_of(rulings, varied);
  std::cout << table_of(changes);
  const bool met = std::ranges::all_of(changes, [](const Change& c) { return c.better + c.worse <= kMostChanges; });
  return met ? ExitStatus::good : ExitStatus::bad_verdict;
}

void add_sensitivity(CLI::App& program, SensitivityArguments& arguments) {
  CLI::App* command = program.add_subcommand(
      "sensitivity", "Count the cases whose result changes with each constant of the finder's policy, times 0.7 and 1.4");
  command->add_option("folders", arguments.folders, "cases, as other commands make them with --generate-only or --write")
      ->required();
  command->add_option("--only", arguments.only, "vary only these constants");
  command->add_option("--keep", arguments.keep,
                      "file for the results, one a line; a run that was stopped continues from it");
  add_threads(*command, arguments.threads);
  command->footer("Example: hotfire-study sensitivity --keep rulings.jsonl cases/*");
}

constexpr const char* kExitStatus =
    "Exit status: 0 all figures met, 1 one is not, 2 wrong use, 6 bad data or a case that cannot be made.";

void add_judging(CLI::App& command, Options& options) {
  add_threads(command, options.threads);
  command.add_flag("--json", options.json, "print one JSON object a line: every case, then the summary");
}

void add_study(CLI::App& program, const char* name, const char* what, std::uint64_t seeds, Options& options) {
  CLI::App* command = program.add_subcommand(name, what);
  options.selection.seeds = seeds;
  command->add_option(std::string(name) == "null" ? "--count" : "--seeds", options.selection.seeds, "number of seeds")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}))
      ->capture_default_str();
  command->add_option("--first-seed", options.selection.first_seed, "first seed")->capture_default_str();
  if (std::string(name) != "null") {
    command->add_option("--only", options.selection.only,
                        "only these effects, pairs as in leakage+rate_limit, or conditions of hard data");
  }
  command->add_option("--out", options.out,
                      "folder in which the cases are kept, one folder a case; default: they are removed");
  command->add_flag("--generate-only", options.generate_only, "make the cases and do not explain them; needs --out");
  add_judging(*command, options);
  command->footer(std::string("Example: hotfire-study ") + name + " --out cases --threads 2\n" + kExitStatus);
}

/// Options of `wild`: those of a study but for the names.
void add_wild(CLI::App& program, std::string& write, Options& options) {
  CLI::App* command =
      program.add_subcommand("wild", "Judge the finder on effects drawn at random, from laws that it does not share");
  options.selection.seeds = 100;
  command->add_option("--count", options.selection.seeds, "number of draws")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}))
      ->capture_default_str();
  command->add_option("--first-seed", options.selection.first_seed, "seed of the first draw")->capture_default_str();
  command->add_flag("--listed", options.listed, "add a listed effect, drawn at random, to each draw");
  auto* keep = command->add_option("--out", options.out,
                                   "folder in which the cases are kept, one folder a case; default: they are removed");
  command->add_option("--write", write, "folder in which the cases are made, without explaining them")->excludes(keep);
  add_judging(*command, options);
  command->footer(std::string("Example: hotfire-study wild --count 8 --first-seed 145\n") + kExitStatus);
}

int run(int argc, char** argv) {
  CLI::App program("Measures how often hotfire explain is right, on cases made by an independent simulator.",
                   "hotfire-study");
  program.require_subcommand(1);
  program.footer(std::string("Example: hotfire-study effects --seeds 3 --out cases\n") + kExitStatus);
  Options effects;
  Options pairs;
  Options unlisted;
  Options null;
  Options two_axes;
  Options hard;
  Options folders;
  Options wild;
  Options similarity;
  similarity.similarity = true;
  std::string write;
  add_wild(program, write, wild);
  add_study(program, "effects", "Judge the finder on every listed effect, alone", 3, effects);
  add_study(program, "pairs", "Judge the finder on ten pairs of listed effects", 1, pairs);
  add_study(program, "unlisted", "Judge the finder on effects that are in no list", 1, unlisted);
  add_study(program, "null", "Judge the finder on records in which no effect is missing", 40, null);
  add_study(program, "two-axes", "Judge the finder on engines with two axes, one with a missing effect or none", 1,
            two_axes);
  add_study(program, "hard",
            "Judge the finder on hard data: slow and fast rows, one record or ten, closed loop, faults of a channel ...", 1,
            hard);
  add_study(program, "similarity",
            "Judge the finder on every listed effect, as it is and on a rig of 1/100 the size and ten times the speed", 1,
            similarity);
  FitArguments candidate;
  add_fit(program, candidate);
  CostArguments cost;
  add_cost(program, cost);
  SensitivityArguments varied;
  add_sensitivity(program, varied);
  CLI::App* judging = program.add_subcommand("judge", "Explain and judge existing cases");
  judging->add_option("folders", folders.folders, "folders of cases, with given/ and kept/")->required();
  add_judging(*judging, folders);
  judging->footer(std::string("Example: hotfire-study judge cases/*\n") + kExitStatus);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : static_cast<int>(ExitStatus::wrong_use);
  }
  ExitStatus status = ExitStatus::good;
  if (program.got_subcommand("effects")) {
    status = study(effect_orders(effects.selection), effects);
  } else if (program.got_subcommand("pairs")) {
    status = study(pair_orders(pairs.selection), pairs);
  } else if (program.got_subcommand("unlisted")) {
    status = study(unlisted_orders(unlisted.selection), unlisted);
  } else if (program.got_subcommand("two-axes")) {
    status = study(two_axis_orders(two_axes.selection), two_axes);
  } else if (program.got_subcommand("hard")) {
    status = study(hard_orders(hard.selection), hard);
  } else if (program.got_subcommand("wild")) {
    if (!write.empty()) {
      wild.out = write;
      wild.generate_only = true;
    }
    status = study(wild_orders(wild.selection, wild.listed), wild);
  } else if (program.got_subcommand("similarity")) {
    status = study(effect_orders(similarity.selection), similarity);
  } else if (program.got_subcommand("null")) {
    status = study(null_orders(null.selection), null);
  } else if (program.got_subcommand("fit")) {
    status = fit_one(candidate);
  } else if (program.got_subcommand("cost")) {
    status = cost_of_one(cost);
  } else if (program.got_subcommand("sensitivity")) {
    status = vary_policy(varied);
  } else {
    status = judge_folders(folders);
  }
  return static_cast<int>(status);
}

}  // namespace
}  // namespace hotfire::study

int main(int argc, char** argv) {
  using hotfire::ExitStatus;
  try {
    return hotfire::study::run(argc, argv);
  } catch (const hotfire::UsageError& error) {
    std::cerr << "hotfire-study: " << error.what() << '\n';
    return static_cast<int>(ExitStatus::wrong_use);
  } catch (const std::exception& error) {
    std::cerr << "hotfire-study: " << error.what() << '\n';
    return static_cast<int>(ExitStatus::bad_data);
  }
}
