// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/cli/shared/progress.hpp"
#include "tools/disperse/dispersion_report.hpp"
#include "tools/disperse/worker.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/sha256.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

constexpr int kMostDraws = 1'000'000;

struct DisperseOptions {
  disperse::Plan plan;
  disperse::ReportGoal goal;
  std::string model;
  std::string tolerances;
  std::string out;
  std::string share = "1/1";
  std::string merge;
  bool print_draws = false;
  bool worker = false;
  bool json = false;
};

disperse::Share share_of(const std::string& text) {
  disperse::Share share;
  const std::size_t slash = text.find('/');
  const auto read = [&](std::string_view part, int& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size();
  };
  const std::string_view view = text;
  const bool good = slash != std::string::npos && read(view.substr(0, slash), share.index) &&
                    read(view.substr(slash + 1), share.count) && 1 <= share.index && share.index <= share.count;
  if (!good) {
    throw UsageError(fmt::format("--share {}: allowed: K/N with K from 1 to N, as in 2/8", text));
  }
  return share;
}

/// Refuses a command that has no model to draw or no figures to read.
void require_command(const CLI::App& program, const std::string& name) {
  std::vector<std::string> allowed;
  for (const CLI::App* command : program.get_subcommands(is_listed)) {
    const bool takes_a_model = command->get_option_no_throw("--model") != nullptr;
    if (takes_a_model && command->get_option_no_throw("--json") != nullptr && command->get_name() != "disperse") {
      allowed.push_back(command->get_name());
    }
  }
  if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
    throw UsageError(fmt::format("'{}' is not run per draw; {}", name, suggestion(name, {allowed.begin(), allowed.end()})));
  }
}

std::string merged_text(const std::string& path) {
  if (path == "-") {
    return {std::istreambuf_iterator<char>(std::cin), {}};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw FileError(fmt::format("{}: cannot be opened; name a file that --print-draws has printed", path));
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_report(const disperse::DispersionReport& report, const std::filesystem::path& out) {
  write_whole_file(out / "table.csv", report.table());
  write_whole_file(out / "dispersions.json", report.json().dump(1) + "\n");
  for (const auto& [name, chart] : report.pictures()) {
    write_whole_file(out / name, analysis::svg(chart));
  }
}

void run_disperse(const DisperseOptions& options, const disperse::CommandRunner& run) {
  const disperse::Share share = share_of(options.share);
  disperse::Plan plan = options.plan;
  plan.model = options.model;
  plan.tolerances = options.tolerances;
  plan.program = sha256_of("/proc/self/exe");
  disperse::Dispersion dispersion(plan, options.out, share);
  if (!options.merge.empty()) {
    dispersion.store().merge(merged_text(options.merge), options.merge == "-" ? "standard input" : options.merge);
  }
  {
    Progress progress;
    const auto say = [&](int done, int all) {
      progress.say(fmt::format("draw {} of {}", done, all), static_cast<double>(done) / all);
    };
    const auto say_of_all = [&](int done, int all) {
      if (share.index == 1) {  // the first worker alone knows the results of all
        say(done, all);
      }
    };
    if (!options.worker) {
      dispersion.run(run, say);
    } else if (!disperse::work(dispersion, run, say_of_all, std::cin, std::cout)) {
      return;
    }
  }
  if (options.print_draws) {
    std::cout << dispersion.store().text(share);
    return;
  }
  if (!dispersion.is_complete()) {
    std::cout << fmt::format(
        "{}: share {} is done; the draws of other shares are missing. Without --share, the "
        "command runs them and writes the table\n",
        options.out, options.share);
    return;
  }
  const disperse::DispersionReport report(dispersion, options.goal);
  write_report(report, options.out);
  if (options.json) {
    print_json(report.json());
  } else {
    std::cout << fmt::format("{}: {} draws of {} tolerances, {} failed\n{}", options.out, plan.draws,
                             dispersion.tolerances().variables.size(), report.failed(), report.text());
  }
  if (report.failed() > 0) {
    throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_verdict));
  }
}

}  // namespace

void add_disperse(CLI::App& program, const disperse::CommandRunner& run) {
  const auto options = std::make_shared<DisperseOptions>();
  CLI::App* command = program.add_subcommand(
      "disperse", "Draw a model's parameters within their tolerances, and run a command for each draw");
  command->add_option("--model", options->model, "declared model (.toml)")->required();
  command->add_option("--tolerances", options->tolerances,
                      "tolerances and correlated factors of locations (.toml); default: [tolerance] of the model");
  command->add_option("--out", options->out, "folder for the results; a run that was stopped continues there")->required();
  command->add_option("--draws", options->plan.draws, "number of draws")
      ->check(CLI::Range(2, kMostDraws))
      ->capture_default_str();
  command->add_option("--seed", options->plan.seed, "seed of the draws")->capture_default_str();
  command
      ->add_option("--quantity", options->goal.quantities,
                   "report only these numbers of the command's JSON, as in engine.*.overshoot; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--percentiles", options->goal.percentiles, "percentiles to report")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--channel", options->plan.channels,
                   "draw the percentiles of this channel of the command's record over time; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--share", options->share, "run only share K of N of the draws, as in 2/8")->capture_default_str();
  command->add_option("--merge", options->merge,
                      "take the results of another machine, as --print-draws prints them; -: standard input");
  command->add_flag("--print-draws", options->print_draws, "print the results of the share for --merge, and no table");
  command
      ->add_flag(
          "--worker", options->worker,
          "for hotfire-disperse-mpi: run the draws whose numbers come on standard input, a line each, and print each result")
      ->excludes("--print-draws");
  command->add_flag("--json", options->json, "print the statistics as JSON");
  command
      ->add_option("command", options->plan.command,
                   "command of hotfire to run for each draw, after --, without --model and --json")
      ->required();
  command->footer(
      "Example: hotfire disperse --model taos.toml --tolerances tolerances.toml --draws 1000 --out spread -- step --axis "
      "pitch\n"
      "         mpirun -n 8 hotfire-disperse-mpi --model taos.toml --out spread -- sweep --axis pitch --coarse --profile "
      "sines\n"
      "The number of the draw replaces {draw} in an argument of the command.\n"
      "Exit status: 1 if the command failed for some draws; the table says which.");
  command->callback([options, &program, run] {
    require_command(program, options->plan.command.front());
    run_disperse(*options, run);
  });
}

}  // namespace hotfire
