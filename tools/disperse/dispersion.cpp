// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/dispersion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

#include "tools/disperse/latin_hypercube.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/private_folder.hpp"
#include "tools/files/text/sha256.hpp"

namespace hotfire::disperse {

namespace {

using Json = nlohmann::ordered_json;

/// The most rows of a channel that are kept of a draw: more than a picture resolves.
constexpr std::size_t kMostRowsKept = 500;

/// True if what matters of a command is the record that it writes.
bool gives_a_record(const Plan& plan) { return plan.command.front() == "simulate" || !plan.channels.empty(); }

/// What a command prints, without the times that differ from run to run.
Json without_times(const std::string& command, Json printed) {
  if (command == "simulate") {
    return Json::object();
  }
  if (command == "explain") {
    for (const char* key : {"seconds", "date", "command_line"}) {
      printed.erase(key);
    }
  }
  return printed;
}

/// `to` does not contain `from`.
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The value of an option of a command line, `--output x` or `--output=x`; null if it has none.
const std::string* value_of(const std::vector<std::string>& words, const std::string& option, std::string& joined) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == option && i + 1 < words.size()) {
      return &words[i + 1];
    }
    if (words[i].starts_with(option + "=")) {
      joined = words[i].substr(option.size() + 1);
      return &joined;
    }
  }
  return nullptr;
}

void require_runnable(const Plan& plan) {
  for (const std::string& word : plan.command) {
    const std::string option = word.substr(0, word.find('='));
    if (option == "--model" || option == "--json" || option == "--record") {
      throw UsageError(
          fmt::format("{}: in the command; leave it out: each draw's model is given to the command, and its JSON "
                      "is read",
                      option));
    }
  }
  for (const char* option : {"--output", "--picture", "--out"}) {
    std::string joined;
    const std::string* value = value_of(plan.command, option, joined);
    if (value != nullptr && value->find(kDrawWord) == std::string::npos) {
      throw UsageError(
          fmt::format("{} {}: each draw would replace the file of the one before; write {} into the name, which "
                      "becomes the number of the draw",
                      option, *value, kDrawWord));
    }
  }
}

Tolerances tolerances_in(const Plan& plan, DeclaredModel& model) {
  return plan.tolerances.empty() ? tolerances_of(plan.model, model) : load_tolerances(plan.tolerances, model);
}

/// Least, greatest and last value of each channel, and the rows that are kept of those that were asked for.
Json channels_of(const std::filesystem::path& path, const std::vector<std::string>& kept) {
  const Record record = load_record(path);
  Json channels = Json::object();
  for (const std::string& name : kept) {
    require_channel(record, name, "--channel asks for it");
  }
  for (const Channel& channel : record.channels) {
    const auto [least, greatest] = std::minmax_element(channel.values.begin(), channel.values.end());
    Json own{{"least", *least}, {"greatest", *greatest}, {"last", channel.values.back()}};
    if (std::find(kept.begin(), kept.end(), channel.name) != kept.end()) {
      const std::size_t stride = (record.rows + kMostRowsKept - 1) / kMostRowsKept;
      own["unit"] = channel.unit;
      own["start"] = record.start;
      own["period"] = record.period * static_cast<double>(stride);
      own["rows"] = Json::array();
      for (std::size_t row = 0; row < record.rows; row += stride) {
        own["rows"].push_back(channel.values[row]);
      }
    }
    channels[channel.name] = std::move(own);
  }
  return channels;
}

}  // namespace

Dispersion::Dispersion(Plan plan, const std::filesystem::path& folder, Share share)
    : plan_((require_runnable(plan), std::move(plan))),
      model_(plan_.model),
      tolerances_(tolerances_in(plan_, model_)),
      sample_(latin_hypercube(plan_.draws, tolerances_.correlation, plan_.seed)),
      share_(share),
      store_(folder, inputs(), share) {
  for (const auto& [draw, result] : store_.results()) {
    if (draw < 0 || draw > plan_.draws || result.model != model_digest(draw)) {
      throw FileError(
          fmt::format("{}: draw {} is of another model than this run draws; it was drawn on a machine that rounds "
                      "otherwise; give another --out, or remove the folder",
                      folder.string(), draw));
    }
  }
}

Json Dispersion::inputs() const {
  Json files = Json::object();
  for (const std::string& word : plan_.command) {
    const std::string value =
        word.starts_with("--") && word.find('=') != std::string::npos ? word.substr(word.find('=') + 1) : word;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(value, ignored)) {
      files[word] = sha256_of(value);
    }
  }
  return {{"format", 1},
          {"program", plan_.program},
          {"model", sha256_of_text(model_.text(DeclaredModel::TableName::without_folder))},
          {"mode_table", model_.modes_table().empty() ? Json(nullptr) : Json(sha256_of(model_.modes_table()))},
          {"tolerances", plan_.tolerances.empty() ? Json(nullptr) : Json(sha256_of(plan_.tolerances))},
          {"command", plan_.command},
          {"files", files},
          {"channels", plan_.channels},
          {"draws", plan_.draws},
          {"seed", plan_.seed}};
}

Eigen::VectorXd Dispersion::variables(int draw) const {
  Eigen::VectorXd x(sample_.cols());
  for (Eigen::Index i = 0; i < sample_.cols(); ++i) {
    x(i) = tolerances_.variables[static_cast<std::size_t>(i)].at(sample_(draw - 1, i));
  }
  return x;
}

std::vector<double> Dispersion::values(int draw) const {
  DeclaredModel model = model_;
  if (draw == 0) {
    std::vector<double> declared;
    const std::vector<DeclaredNumber> numbers = model.numbers();
    for (const Tolerance& tolerance : tolerances_.variables) {
      const auto number = std::find_if(numbers.begin(), numbers.end(), [&](const DeclaredNumber& own) {
        return std::find(own.keys.begin(), own.keys.end(), tolerance.key) != own.keys.end();
      });
      declared.push_back(*number->value);
    }
    return declared;
  }
  return drawn_values(model, tolerances_.variables, variables(draw));
}

std::string Dispersion::model_digest(int draw) const {
  const DeclaredModel drawn = draw == 0 ? model_ : with_variables(model_, tolerances_.variables, variables(draw));
  return sha256_of_text(drawn.text(DeclaredModel::TableName::without_folder));
}

bool Dispersion::is_complete() const { return store_.results().size() == static_cast<std::size_t>(plan_.draws) + 1; }

DrawResult Dispersion::result_of(int draw, const CommandRunner& run, const std::filesystem::path& scratch) const {
  const DeclaredModel drawn = draw == 0 ? model_ : with_variables(model_, tolerances_.variables, variables(draw));
  const std::filesystem::path model = scratch / "draw.toml";
  std::filesystem::path record = scratch / "draw.csv";
  if (!(std::ofstream(model) << drawn.text() << std::flush)) {
    throw FileError(fmt::format("{}: cannot be written; is the disk full?", model.string()));
  }

  const std::string number = fmt::format("{:0{}}", draw, std::to_string(plan_.draws).size());
  std::vector<std::string> words;
  for (const std::string& word : plan_.command) {
    words.push_back(replaced(word, kDrawWord, number));
  }
  std::string joined;
  if (const std::string* output = value_of(words, "--output", joined)) {
    record = *output;
  } else if (gives_a_record(plan_)) {
    words.insert(words.end(), {"--output", record.string()});
  }
  words.insert(words.end(), {"--model", model.string(), "--json"});

  CommandOutcome outcome = run(words);
  // The folder has another name in every run.
  const std::string folder = scratch.string() + "/";
  outcome.printed = replaced(std::move(outcome.printed), folder, "");
  outcome.complained = replaced(std::move(outcome.complained), folder, "");
  DrawResult result{.draw = draw,
                    .model = sha256_of_text(drawn.text(DeclaredModel::TableName::without_folder)),
                    .status = outcome.status,
                    .complaint = outcome.complained,
                    .result = Json::object(),
                    .channels = Json::object()};
  if (outcome.status != static_cast<int>(ExitStatus::good) && outcome.status != static_cast<int>(ExitStatus::bad_verdict)) {
    return result;
  }
  result.complaint.clear();
  result.result = without_times(words.front(), Json::parse(outcome.printed, nullptr, false));
  if (result.result.is_discarded()) {
    throw FileError(fmt::format("'hotfire {}' prints no JSON; allowed: a command with --json", words.front()));
  }
  if (gives_a_record(plan_)) {
    result.channels = channels_of(record, plan_.channels);
  }
  return result;
}

void Dispersion::run(const CommandRunner& run, const std::function<void(int, int)>& progress) {
  const PrivateFolder scratch;
  std::vector<int> missing;
  int all = 0;
  for (int draw = 0; draw <= plan_.draws; ++draw) {
    if (share_.has(draw)) {
      ++all;
      if (!store_.results().contains(draw)) {
        missing.push_back(draw);
      }
    }
  }
  int done = all - static_cast<int>(missing.size());
  for (const int draw : missing) {
    this->run(draw, run, scratch.path());
    progress(++done, all);
  }
}

void Dispersion::run(int draw, const CommandRunner& run, const std::filesystem::path& scratch) {
  if (store_.results().contains(draw)) {
    return;
  }
  const DrawResult result = result_of(draw, run, scratch);
  // The same words are wrong in every draw, and the declared model must run.
  if (result.status == static_cast<int>(ExitStatus::wrong_use)) {
    throw UsageError(fmt::format("'{}' is refused: {}", fmt::join(plan_.command, " "), result.complaint));
  }
  if (draw == 0 && !result.complaint.empty()) {
    throw FileError(fmt::format("{}: the declared model itself cannot be run: {}", plan_.model.string(), result.complaint));
  }
  store_.add(result);
}

}  // namespace hotfire::disperse
