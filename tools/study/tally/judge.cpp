// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>

#include "tools/explain/explain.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/study/cases/case.hpp"
#include "tools/study/tally/ruling.hpp"

namespace hotfire::study {

using Errors = std::map<std::string, double>;

namespace {

constexpr std::array kScored{"piston", "engine", "piston.pitch", "engine.pitch", "piston.yaw", "engine.yaw"};

/// As `errors_of`, for a model of one axis or several.
template <class Model>
Errors scored_errors(const Model& model, const Record& truth, const std::map<std::string, double>& noise) {
  const Record modelled = simulate(model, truth);
  Errors errors;
  for (const char* name : kScored) {
    const Channel* wanted = truth.find(name);
    if (wanted == nullptr) {
      continue;
    }
    const std::vector<double>& got = modelled.find(name)->values;
    double sum = 0.0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      sum += (got[i] - wanted->values[i]) * (got[i] - wanted->values[i]);
    }
    errors[name] = std::sqrt(sum / static_cast<double>(got.size())) / noise.at(name);
  }
  return errors;
}

}  // namespace

Errors errors_of(const ModelFile& model, const Record& truth, const std::map<std::string, double>& noise) {
  return scored_errors(model, truth, noise);
}

std::vector<Record> given_records(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".csv") {
      paths.insert(entry.path());
    }
  }
  std::vector<Record> records;
  records.reserve(paths.size());
  for (const auto& path : paths) {
    records.push_back(load_record(path));
  }
  return records;
}

namespace {

nlohmann::json truth_of(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "kept/truth.json";
  std::ifstream file(path);
  if (!file) {
    throw FileError(fmt::format("{}: cannot be read; give the folder of a case, with given/ and kept/", path.string()));
  }
  return nlohmann::json::parse(file);
}

std::string joined(std::vector<std::string> words) {
  std::sort(words.begin(), words.end());
  return words.empty() ? "nothing" : fmt::format("{}", fmt::join(words, " + "));
}

std::string pair_of(const Errors& errors) {
  std::vector<std::string> numbers;
  for (const char* channel : kScored) {
    if (errors.contains(channel)) {
      numbers.push_back(fmt::format("{:.2f}", errors.at(channel)));
    }
  }
  if (numbers.empty()) {
    return "-/-";
  }
  return fmt::format("{}", fmt::join(numbers, "/"));
}

std::string ruling(const Judgement& judgement) {
  if (judgement.is_unlisted()) {
    const bool listed_too = judgement.wanted.size() > 1;
    return fmt::format("{}{} {} {}",
                       !listed_too             ? ""
                       : judgement.names_right ? "listed "
                                               : "LISTED ",
                       judgement.wrong_name ? "NAME" : "name", judgement.site_right ? "site" : "SITE",
                       judgement.halved ? "halved" : "HALVED");
  }
  return fmt::format("{} {}", judgement.names_right ? "right" : "WRONG", judgement.below_noise ? "below" : "ABOVE");
}

std::map<std::string, double> noise_of(const ModelFile& model) { return model.noise; }

std::map<std::string, double> noise_of(const VehicleFile& model) {
  std::map<std::string, double> noise;
  const std::vector<std::string> names = axis_names(static_cast<int>(model.axes.size()) / 2);
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    for (const auto& [channel, rms] : model.axes[axis].noise) {
      noise[channel + "." + names[axis]] = rms;
    }
  }
  return noise;
}

/// Runs the finder on a case and compares with the unseen record.
template <class Model>
void explain_case(const Model& declared, const std::vector<Record>& records, const Record& unseen,
                  const std::vector<std::string>& exclusions, unsigned threads, Judgement& judgement) {
  judgement.before = scored_errors(declared, unseen, noise_of(declared));
  const explain::Stopwatch stopwatch;
  try {
    explain::ExplainOptions options;
    options.keep_drift = true;  // the kept record has the clock of the others
    options.threads = threads;
    options.most_effects = 4;
    for (const std::string& text : exclusions) {
      options.exclusions.push_back(explain::exclusion_from(text));
    }
    const auto explanation = explain::explain(declared, records, options);
    const explain::Result& result = explanation.result;
    judgement.verdict = explain::name_of(result.verdict);
    for (const explain::FoundEffect& effect : result.effects) {
      add_find(effect, judgement);
    }
    if (judgement.found.empty() && result.located) {
      explain::FoundEffect residual;
      residual.name = "residual";
      residual.sites = result.located->sites;
      add_find(residual, judgement);
    }
    judgement.after = scored_errors(explanation.model, unseen, noise_of(declared));
  } catch (const std::exception& error) {
    judgement.failure = error.what();
  }
  judgement.seconds = stopwatch.seconds();
  judgement.processor_seconds = stopwatch.processor_seconds();
}

}  // namespace

Judgement judge(const std::filesystem::path& folder, unsigned threads, const std::optional<Similarity>& similarity) {
  const nlohmann::json truth = truth_of(folder);
  Judgement judgement;
  judgement.name = folder.filename().string();
  judgement.wanted = truth.at("effects").get<std::vector<std::string>>();
  judgement.wanted_law = truth.value("law", "");
  const auto kinds = truth.value("kinds", std::vector<std::string>{});
  judgement.is_wild = std::find(kinds.begin(), kinds.end(), kWild) != kinds.end();
  judgement.effect = truth.at("effect_size").get<Errors>();
  const std::vector<Record> records = given_records(folder / "given");
  const Record unseen = load_record(folder / "kept/score_noisefree.csv");
  const std::filesystem::path declared = folder / "given/declared.toml";
  if (const auto path = folder / "kept/true.toml"; std::filesystem::exists(path)) {
    // An effect of physics.md that the model does not have yet is refused.
    try {
      const ModelFile model = load_model(path);
      judgement.truth = errors_of(model, unseen, model.noise);
    } catch (const FileError&) {
      judgement.truth.clear();
    }
  }

  const auto exclusions = truth.value("exclusions", std::vector<std::string>{});
  if (similarity && is_vehicle(declared)) {
    throw FileError(fmt::format("{}: two axes; give a case of one axis", declared.string()));
  }
  if (similarity) {
    std::vector<Record> other;
    other.reserve(records.size());
    for (const Record& record : records) {
      other.push_back(similar(record, *similarity));
    }
    explain_case(similar(load_model(declared), *similarity), other, similar(unseen, *similarity), exclusions, threads,
                 judgement);
  } else if (is_vehicle(declared)) {
    explain_case(load_vehicle(declared), records, unseen, exclusions, threads, judgement);
  } else {
    explain_case(load_model(declared), records, unseen, exclusions, threads, judgement);
  }
  judgement.below_noise = !judgement.after.empty() && std::all_of(judgement.after.begin(), judgement.after.end(),
                                                                  [](const auto& error) { return error.second < 1.0; });
  if (judgement.is_unlisted()) {
    rule_on_unlisted(truth.value("may_name", std::set<std::string>{}), judgement);
  } else {
    const std::multiset<std::string> wanted(judgement.wanted.begin(), judgement.wanted.end());
    const std::multiset<std::string> found(judgement.found.begin(), judgement.found.end());
    const bool verdict_fits = !wanted.empty() || judgement.verdict == "nothing-missing";
    judgement.names_right = judgement.failure.empty() && wanted == found && verdict_fits;
  }
  return judgement;
}

std::string line_of(const Judgement& judgement) {
  const auto part_left = [](const Judgement& j) {
    return j.is_unlisted() && j.left() ? fmt::format("left {:5.1f} % ", 100.0 * *j.left()) : std::string();
  };
  std::vector<std::string> found;
  for (std::size_t i = 0; i < judgement.found.size(); ++i) {
    found.push_back(judgement.found[i] + (judgement.found_laws[i].empty() ? "" : ":" + judgement.found_laws[i]));
  }
  const std::string law = judgement.wanted_law.empty() ? "" : " (" + judgement.wanted_law + ")";
  std::string line = fmt::format(
      "{:<34} {:<16} {:<18} before {:>13} effect {:>13} true {:>9} after {:>11} {}{:6.1f} s ({:.1f} s of processor)  {} -> "
      "{}",
      judgement.name, ruling(judgement), judgement.verdict, pair_of(judgement.before), pair_of(judgement.effect),
      pair_of(judgement.truth), pair_of(judgement.after), part_left(judgement), judgement.seconds,
      judgement.processor_seconds, joined(judgement.wanted) + law, joined(found));
  return judgement.failure.empty() ? line : line + "; failed: " + judgement.failure;
}

nlohmann::json json_of(const Judgement& judgement) {
  nlohmann::json result{{"case", judgement.name},
                        {"wanted", judgement.wanted},
                        {"wanted_law", judgement.wanted_law},
                        {"found", judgement.found},
                        {"laws", judgement.found_laws},
                        {"sites", judgement.found_sites},
                        {"verdict", judgement.verdict},
                        {"before", judgement.before},
                        {"effect", judgement.effect},
                        {"after", judgement.after},
                        {"true_model", judgement.truth},
                        {"seconds", judgement.seconds},
                        {"processor_seconds", judgement.processor_seconds},
                        {"below_noise", judgement.below_noise}};
  if (judgement.is_unlisted()) {
    result["wrong_name"] = judgement.wrong_name;
    result["site_right"] = judgement.site_right;
    result["halved"] = judgement.halved;
    result["is_wild"] = judgement.is_wild;
  }
  if (!judgement.is_unlisted() || judgement.wanted.size() > 1) {
    result["names_right"] = judgement.names_right;
  }
  if (const auto left = judgement.left()) {
    result["left"] = *left;
    result["over_noise"] = *judgement.over_noise();
  }
  if (!judgement.failure.empty()) {
    result["failure"] = judgement.failure;
  }
  return result;
}

}  // namespace hotfire::study
