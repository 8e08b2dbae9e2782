// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/two_axis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

using nlohmann::json;

namespace {

/// Keys of the residual with one value for each channel.
constexpr std::array kByChannel{"autocorrelation", "input_correlation", "by_frequency", "by_amplitude"};

/// "engine.inertia" of the pitch axis is "engine.pitch.inertia".
std::string key_of_axis(const std::string& key, const std::string& axis) {
  const auto dot = key.find('.');
  return key.substr(0, dot + 1) + axis + key.substr(dot);
}

/// Adds `own` to `all`, each name ended by the axis.
void add_named(const json& own, const std::string& axis, json& all) {
  for (const auto& [name, value] : own.items()) {
    all[fmt::format("{}.{}", name, axis)] = value;
  }
}

void add_rows(const json& own, const std::string& axis, json& all) {
  for (json row : own) {
    row["axis"] = axis;
    all.push_back(std::move(row));
  }
}

/// Texts that every axis has are given once, others with their axis.
json joined_texts(const std::vector<AxisReport>& reports, const char* key) {
  json texts = json::array();
  for (const AxisReport& own : reports) {
    for (const json& text : own.report.at(key)) {
      const bool common = std::all_of(reports.begin(), reports.end(), [&](const AxisReport& other) {
        const json& others = other.report.at(key);
        return std::find(others.begin(), others.end(), text) != others.end();
      });
      const json named = common ? text : json(fmt::format("{}: {}", own.axis, text.get<std::string>()));
      if (std::find(texts.begin(), texts.end(), named) == texts.end()) {
        texts.push_back(named);
      }
    }
  }
  return texts;
}

std::string joined_verdict(const std::vector<AxisReport>& reports) {
  constexpr std::array<const char*, 5> kFromWorst{"undecided", "unlisted-effect", "partly-explained", "explained",
                                                  "nothing-missing"};
  for (const char* verdict : kFromWorst) {
    if (std::any_of(reports.begin(), reports.end(),
                    [&](const AxisReport& r) { return r.report.at("verdict") == verdict; })) {
      return verdict;
    }
  }
  return kFromWorst.back();
}

std::string joined_sentence(const std::vector<AxisReport>& reports) {
  std::string sentence;
  for (const AxisReport& own : reports) {
    sentence += (sentence.empty() ? "" : " ") + words::of_axis(own.axis, own.report.at("sentence").get<std::string>());
  }
  return sentence;
}

}  // namespace

json joined_channels(const std::vector<AxisReport>& reports) {
  json joined = reports.front().report;
  joined["channels"] = json::object();
  for (const AxisReport& own : reports) {
    add_named(own.report.at("channels"), own.axis, joined["channels"]);
  }
  return joined;
}

json joined_report(const std::vector<AxisReport>& reports) {
  json joined = reports.front().report;
  joined["verdict"] = joined_verdict(reports);
  joined["sentence"] = joined_sentence(reports);
  joined["warnings"] = joined_texts(reports, "warnings");
  joined["held_out"] = joined_texts(reports, "held_out");
  joined["channels"] = joined["calibration"] = json::object();
  joined["effects"] = joined["search"] = joined["identifiability"] = json::array();
  joined.erase("trace");
  json& residual = joined["residual"];
  residual.erase("next_experiment");
  for (const char* by_channel : kByChannel) {
    residual[by_channel] = json::object();
  }
  for (const AxisReport& own : reports) {
    add_named(own.report.at("channels"), own.axis, joined["channels"]);
    for (const auto& [key, value] : own.report.at("calibration").items()) {
      joined["calibration"][key_of_axis(key, own.axis)] = value;
    }
    add_rows(own.report.at("effects"), own.axis, joined["effects"]);
    add_rows(own.report.at("search"), own.axis, joined["search"]);
    for (const json& text : own.report.at("identifiability")) {
      joined["identifiability"].push_back({{"text", words::of_axis(own.axis, text.at("text").get<std::string>())}});
    }
    const json& left = own.report.at("residual");
    residual["white"] = residual.at("white").get<bool>() && left.at("white").get<bool>();
    residual["unexplained_percent"] =
        std::max(residual.at("unexplained_percent").get<double>(), left.at("unexplained_percent").get<double>());
    for (const char* by_channel : kByChannel) {
      add_named(left.at(by_channel), own.axis, residual[by_channel]);
    }
    if (left.contains("next_experiment")) {
      const std::string before = residual.value("next_experiment", "");
      residual["next_experiment"] =
          before + (before.empty() ? "" : " ") + words::of_axis(own.axis, left.at("next_experiment").get<std::string>());
    }
    // The trace of the first axis with a missing effect, else of the first that has one.
    const json& missing = own.report.at("effects");
    const bool is_first_missing = !missing.empty() && joined["effects"].size() == missing.size();
    if (own.report.contains("trace") && (is_first_missing || !joined.contains("trace"))) {
      joined["trace"] = own.report.at("trace");
      joined["trace"]["text"] = words::of_axis(own.axis, own.report.at("trace").at("text").get<std::string>());
    }
  }
  return joined;
}

void append_series(const std::string& axis, ReportSeries own, ReportSeries& all) {
  for (ReportRecord& record : own.records) {
    record.name += " (" + axis + ")";
    record.input_name += "." + axis;
    for (ReportChannel& channel : record.channels) {
      channel.name += "." + axis;
    }
    all.records.push_back(std::move(record));
  }
}

}  // namespace hotfire::explain
