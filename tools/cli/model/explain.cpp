// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/explain.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

#include "tools/cli/shared/any_record.hpp"
#include "tools/cli/shared/candump_options.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/progress.hpp"
#include "tools/explain/pace.hpp"
#include "tools/explain/report/report_json.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/sha256.hpp"
#include "tools/files/text/whole_file.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

namespace {

struct ExplainArguments {
  std::string model;
  std::string out;
  std::vector<std::string> records;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  int most_effects = 4;
  std::optional<double> seconds;
  std::vector<std::string> excluded;
  std::vector<std::string> held_out;
  std::string lab;
  bool keep_drift = false;
  bool json = false;
  CandumpOptions candump;
};

/// The next experiment, for `hotfire simulate` and for `hotfire lab`.
constexpr const char* kNextRecord = "next_experiment.csv";
constexpr const char* kNextProfile = "next_experiment.toml";

volatile std::sig_atomic_t interrupted = 0;

/// A line for each channel: its rms error under the three models.
std::string error_rows(const std::vector<explain::ChannelErrors>& channels) {
  std::string text;
  for (const explain::ChannelErrors& channel : channels) {
    text += fmt::format("{:<14} {:<6} {:>12.4g} {:>12.4g} {:>12.4g}   noise {:.4g}{}\n", channel.name, channel.unit,
                        channel.declared.rms, channel.calibrated.rms, channel.explained.rms, channel.noise,
                        channel.black_box ? fmt::format(", linear black box {:.4g}", channel.black_box->rms) : "");
  }
  return text;
}

std::string effect_rows(const explain::FoundEffect& effect) {
  std::string text = fmt::format("\n{} at {}{}{}\n", effect.name, effect.site,
                                 effect.axis.empty() ? "" : " of the " + effect.axis + " axis",
                                 effect.law.empty() ? "" : ", " + effect.law);
  for (const std::string& words : {effect.looks_like, effect.is_not}) {
    if (!words.empty()) {
      text += "  " + words + "\n";
    }
  }
  for (const explain::EffectParameter& parameter : effect.parameters) {
    const std::string interval =
        parameter.interval ? fmt::format("95 % {:.4g} .. {:.4g}", parameter.interval->first, parameter.interval->second)
                           : "not determined by the data";
    text += fmt::format("  {:<20} {:>12.4g} {:<10} {}\n", parameter.name, parameter.value, parameter.unit, interval);
  }
  return text;
}

/// What a person wants to read first, in a dozen lines.
std::string summary(const explain::Result& result, const std::filesystem::path& out) {
  std::string text = fmt::format("{}: {}\n\n", explain::name_of(result.verdict), result.sentence);
  text += fmt::format("{:<14} {:<6} {:>12} {:>12} {:>12}   (rms error on held-out data)\n", "channel", "unit", "declared",
                      "calibrated", "explained");
  text += error_rows(result.channels);
  for (const explain::HeldOutRecord& record : result.held_out_records) {
    text += fmt::format("\n{} (test record, --hold-out)\n", record.path);
    text += error_rows(record.channels);
  }
  if (result.baseline) {
    text += "\n" + result.baseline->sentence + "\n";
  }
  for (const explain::FoundEffect& effect : result.effects) {
    text += effect_rows(effect);
  }
  if (!result.residual.next_experiment.empty()) {
    text += "\nnext experiment: " + result.residual.next_experiment + "\n";
  }
  for (const std::string& warning : result.warnings) {
    text += "\nwarning: " + warning;
  }
  return text + fmt::format("\n{}: explained.toml, report.json, report.html\n", out.string());
}

/// What a run leaves behind, of a model of one axis or of two.
struct Outcome {
  explain::Result result;
  ReportSeries series;
  std::string model;
  std::optional<explain::NextExperiment> next_experiment;
};

using AnyModel = std::variant<ModelFile, VehicleFile>;

AnyModel load_any(const std::filesystem::path& path) {
  return is_vehicle(path) ? AnyModel(load_vehicle(path)) : AnyModel(load_model(path));
}

Outcome outcome_of(const AnyModel& model, const std::vector<Record>& records, const explain::ExplainOptions& options) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model)) {
    explain::VehicleExplanation found = explain::explain(*vehicle, records, options);
    return {std::move(found.result), std::move(found.series), vehicle_text(found.model), std::nullopt};
  }
  explain::Explanation found = explain::explain(std::get<ModelFile>(model), records, options);
  return {std::move(found.result), std::move(found.series), model_text(found.model), std::move(found.next_experiment)};
}

std::string file_name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::vector<explain::Exclusion> exclusions_of(const ExplainArguments& arguments) {
  std::vector<explain::Exclusion> exclusions;
  exclusions.reserve(arguments.excluded.size());
  for (const std::string& text : arguments.excluded) {
    exclusions.push_back(explain::exclusion_from(text));
  }
  std::vector<std::string> names;
  for (const auto* paths : {&arguments.records, &arguments.held_out}) {
    std::transform(paths->begin(), paths->end(), std::back_inserter(names), file_name_of);
  }
  explain::require_known_records(exclusions, names);
  return exclusions;
}

std::vector<Record> loaded(const std::vector<std::string>& paths, const CandumpOptions& candump,
                           const std::vector<explain::Exclusion>& exclusions) {
  std::vector<Record> records;
  records.reserve(paths.size());
  for (const std::string& path : paths) {
    records.push_back(load_any_record(path, candump, explain::drop_outs_of(exclusions, file_name_of(path))));
  }
  return records;
}

/// The next experiment is searched for on one hydraulic axis alone.
void require_one_axis(const AnyModel& model) {
  const auto* one = std::get_if<ModelFile>(&model);
  if (one == nullptr || !std::holds_alternative<SimplexParameters>(one->parameters)) {
    throw UsageError(
        "--lab: the next experiment is simulated for a \"simplex\" model only; leave --lab out, or explain one axis as "
        "\"simplex\"");
  }
}

/// What a report was made of, so that a reviewer can verify it: taken before the search, as the files were read.
std::vector<std::string> digests_of(const std::vector<std::string>& paths) {
  std::vector<std::string> digests(paths.size());
  std::transform(paths.begin(), paths.end(), digests.begin(), sha256_of);
  return digests;
}

void put_digests(const std::vector<std::string>& digests, nlohmann::json& records) {
  for (std::size_t i = 0; i < digests.size(); ++i) {
    records.at(i)["sha256"] = digests[i];
  }
}

void run_explain(const ExplainArguments& arguments, const std::string& command_line) {
  const AnyModel model = load_any(arguments.model);
  explain::ExplainOptions options;
  options.exclusions = exclusions_of(arguments);
  const std::vector<Record> records = loaded(arguments.records, arguments.candump, options.exclusions);
  options.kept_back = loaded(arguments.held_out, arguments.candump, options.exclusions);
  const std::string model_digest = sha256_of(arguments.model);
  const std::vector<std::string> record_digests = digests_of(arguments.records);
  const std::vector<std::string> held_out_digests = digests_of(arguments.held_out);
  if (!arguments.lab.empty()) {
    require_one_axis(model);
    const LabProfile lab = load_profile(arguments.lab);
    options.limits = explain::CommandLimits{lab.lowest_command, lab.highest_command, lab.command_rate};
  }
  const std::filesystem::path out(arguments.out);
  std::error_code failed;
  std::filesystem::create_directories(out, failed);
  if (failed) {
    throw UsageError(fmt::format("--out {}: {}; give a folder that can be written", arguments.out, failed.message()));
  }
  google::SetCommandLineOption("minloglevel", "3");

  std::signal(SIGINT, [](int) { interrupted = 1; });
  Progress progress(arguments.seconds);
  options.threads = arguments.threads;
  options.most_effects = arguments.most_effects;
  options.keep_drift = arguments.keep_drift;
  explain::Pace pace(arguments.most_effects);
  options.watch.progress = [&](const explain::Doing& doing) {
    const explain::ShareDone done = pace.done(doing);
    progress.say(doing.what, done.expected, done.least);
  };
  options.watch.interrupted = [&] {
    return interrupted != 0 || (arguments.seconds && progress.seconds() > *arguments.seconds);
  };
  const Outcome outcome = outcome_of(model, records, options);
  nlohmann::json report = explain::report_json(outcome.result);
  report["hotfire"] = HOTFIRE_VERSION;
  report["model_sha256"] = model_digest;
  put_digests(record_digests, report["records"]);
  if (!held_out_digests.empty()) {
    put_digests(held_out_digests, report["held_out_records"]);
  }
  report["date"] = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  report["command_line"] = command_line;
  report["seconds"] = progress.seconds();

  write_whole_file(out / "explained.toml", outcome.model);
  // One of an earlier run would be taken for this one's.
  std::filesystem::remove(out / kNextRecord);
  std::filesystem::remove(out / kNextProfile);
  if (outcome.next_experiment) {
    write_record(outcome.next_experiment->command, out / kNextRecord);
    if (!arguments.lab.empty()) {
      write_whole_file(out / kNextProfile, profile_with_parts(arguments.lab, outcome.next_experiment->parts));
    }
  }
  write_whole_file(out / "report.json", report.dump(1) + "\n");
  write_whole_file(out / "report.html", report_page(report, outcome.series));
  std::cout << (arguments.json ? report.dump(1) + "\n" : summary(outcome.result, out));
  if (interrupted != 0) {
    throw CLI::RuntimeError(130);
  }
}

}  // namespace

void add_explain(CLI::App& program, const std::string& typed) {
  const auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command =
      program.add_subcommand("explain", "Identify the effects that a declared model is missing, from measured records");
  command->add_option("--model", arguments->model, "declared model (.toml)")->required();
  command->add_option("--out", arguments->out, "folder for explained.toml, report.json and report.html")->required();
  command->add_option("records", arguments->records, "measured records (.csv, candump .log, .hfr, .mf4, .h5, .mat)")
      ->required();
  command->add_option("--threads", arguments->threads, "threads to use")->check(CLI::Range(1U, 256U))->capture_default_str();
  command->add_option("--most-effects", arguments->most_effects, "largest number of effects to add; 0: calibrate only")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  command
      ->add_option("--seconds", arguments->seconds,
                   "time limit of the search [s]; the report then has the best result so far and names what was not "
                   "examined; default: none")
      ->check(CLI::Range(1.0, 1e6));
  command
      ->add_option("--exclude", arguments->excluded,
                   "RECORD@FROM-TO [s]: rows known to be wrong, such as a drop-out; values and rows may be missing there")
      ->allow_extra_args(false);
  command
      ->add_option("--hold-out", arguments->held_out,
                   "hold-out record: no fit and no decision uses it, and the report gives the errors on it")
      ->allow_extra_args(false);
  command->add_option(
      "--lab", arguments->lab,
      "profile of the rig (docs/lab.md): the next experiment stays within its limits and is written as a profile");
  add_candump_options(*command, arguments->candump);
  command->add_flag("--keep-drift", arguments->keep_drift,
                    "write a drift over the time of a record into explained.toml as a table over time, not as its mean");
  command->add_flag("--json", arguments->json, "print report.json instead of the summary");
  command->footer(
      "Example: hotfire explain --model declared.toml --out found sweep.csv steps.csv --hold-out ramps.csv\n"
      "A model of several axes takes records with channels of its axes: command.pitch, piston.pitch, engine.yaw ...\n"
      "Ctrl-C ends the search and reports what is known so far (exit status 130).");
  command->callback([arguments, typed] { run_explain(*arguments, typed); });
}

}  // namespace hotfire
