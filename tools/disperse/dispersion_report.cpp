// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/dispersion_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/disperse/quantities.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire::disperse {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// The last member number of a list whose numbers are quantities of their own unless they are named. The twelve steps of
/// `hotfire step` are such, the frequencies of a response are not.
constexpr int kLastOfShortList = 23;
/// Curves of one picture: as many as its legend has room for.
constexpr std::size_t kMostCurves = 6;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string{}; }

/// True for the members of a list that is long, a number in the name being the place in it.
bool is_of_long_list(const std::string& name) {
  int number = -1;
  for (const char letter : name + ".") {
    if (letter == '.') {
      if (number > kLastOfShortList) {
        return true;
      }
      number = 0;
    } else if (letter < '0' || letter > '9' || number < 0) {
      number = -1;
    } else {
      number = std::min(10 * number + (letter - '0'), 1'000'000);
    }
  }
  return false;
}

/// "overshoot" of "engine.0.overshoot".
std::string kind_of(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool varies(const Quantity& quantity) {
  const std::vector<double> ordered = statistics_of(quantity.values).ordered;
  return !ordered.empty() && (ordered.front() < ordered.back() || ordered.front() != quantity.declared);
}

std::string percentile_name(double percentile) { return fmt::format("{:g}", percentile); }

}  // namespace

DispersionReport::DispersionReport(const Dispersion& dispersion, ReportGoal goal)
    : dispersion_(dispersion), goal_(std::move(goal)), tolerance_values_(dispersion.tolerances().variables.size()) {
  collect();
  select();
}

void DispersionReport::collect() {
  std::map<std::string, std::size_t> place;
  const auto draws = static_cast<std::size_t>(dispersion_.plan().draws);
  for (const auto& [draw, result] : dispersion_.store().results()) {
    const std::vector<double> values = dispersion_.values(draw);
    for (std::size_t i = 0; i < values.size(); ++i) {
      tolerance_values_[i].push_back(values[i]);
    }
    failed_ += result.complaint.empty() ? 0 : 1;
    auto numbers = numbers_of(result.result);
    for (const auto& [channel, own] : result.channels.items()) {
      for (const char* what : {"least", "greatest", "last"}) {
        numbers.emplace_back(fmt::format("record.{}.{}", channel, what), own.at(what).get<double>());
      }
    }
    for (const auto& [name, value] : numbers) {
      const auto [known, is_new] = place.emplace(name, quantities_.size());
      if (is_new) {
        quantities_.push_back({name, kNone, std::vector<double>(draws, kNone)});
      }
      Quantity& quantity = quantities_[known->second];
      (draw == 0 ? quantity.declared : quantity.values[static_cast<std::size_t>(draw) - 1]) = value;
    }
  }
}

void DispersionReport::select() {
  if (goal_.quantities.empty()) {
    std::erase_if(quantities_, [](const Quantity& own) { return is_of_long_list(own.name); });
    return;
  }
  const auto fits = [](const std::string& wanted, const Quantity& own) {
    return fnmatch(wanted.c_str(), own.name.c_str(), 0) == 0;
  };
  for (const std::string& wanted : goal_.quantities) {
    if (std::none_of(quantities_.begin(), quantities_.end(), [&](const Quantity& own) { return fits(wanted, own); })) {
      std::vector<std::string_view> known;
      for (const Quantity& own : quantities_) {
        known.push_back(own.name);
      }
      throw UsageError(fmt::format("--quantity {}: the command gives no such number; near: {}", wanted,
                                   fmt::join(nearest_words(wanted, known, 4), ", ")));
    }
  }
  std::erase_if(quantities_, [&](const Quantity& own) {
    return std::none_of(goal_.quantities.begin(), goal_.quantities.end(),
                        [&](const std::string& wanted) { return fits(wanted, own); });
  });
}

std::string DispersionReport::table() const {
  std::string text = "draw,status";
  for (const Tolerance& tolerance : dispersion_.tolerances().variables) {
    text +=
        tolerance.unit.empty() ? fmt::format(",{}", tolerance.key) : fmt::format(",{}[{}]", tolerance.key, tolerance.unit);
  }
  for (const Quantity& quantity : quantities_) {
    text += "," + quantity.name;
  }
  text += '\n';
  for (const auto& [draw, result] : dispersion_.store().results()) {
    const auto row = static_cast<std::size_t>(draw);
    text += fmt::format("{},{}", draw, result.status);
    for (const std::vector<double>& values : tolerance_values_) {
      text += "," + cell(values[row]);
    }
    for (const Quantity& quantity : quantities_) {
      text += "," + cell(draw == 0 ? quantity.declared : quantity.values[row - 1]);
    }
    text += '\n';
  }
  return text;
}

Json DispersionReport::json() const {
  const Plan& plan = dispersion_.plan();
  Json tolerances = Json::array();
  for (std::size_t i = 0; i < tolerance_values_.size(); ++i) {
    const Tolerance& own = dispersion_.tolerances().variables[i];
    tolerances.push_back({{"key", own.key}, {"unit", own.unit}, {"declared", tolerance_values_[i].front()}});
  }
  Json quantities = Json::object();
  for (const Quantity& quantity : quantities_) {
    const Statistics own = statistics_of(quantity.values);
    Json entry{{"declared", number_or_null(quantity.declared)}, {"draws", own.ordered.size()}};
    if (!own.ordered.empty()) {
      entry["mean"] = own.mean;
      entry["standard_deviation"] = own.standard_deviation;
      entry["least"] = own.ordered.front();
      entry["greatest"] = own.ordered.back();
      for (const double percentile : goal_.percentiles) {
        entry["percentiles"][percentile_name(percentile)] = quantile(own.ordered, 0.01 * percentile);
      }
      for (std::size_t i = 0; i < tolerance_values_.size(); ++i) {
        const std::vector<double> drawn(tolerance_values_[i].begin() + 1, tolerance_values_[i].end());
        entry["rank_correlation"][dispersion_.tolerances().variables[i].key] =
            number_or_null(rank_correlation(drawn, quantity.values));
      }
    }
    quantities[quantity.name] = std::move(entry);
  }
  Json failures = Json::array();
  for (const auto& [draw, result] : dispersion_.store().results()) {
    if (!result.complaint.empty()) {
      failures.push_back({{"draw", draw}, {"status", result.status}, {"complaint", result.complaint}});
    }
  }
  return {{"command", fmt::format("{}", fmt::join(plan.command, " "))},
          {"draws", plan.draws},
          {"seed", plan.seed},
          {"failed", failures},
          {"tolerances", tolerances},
          {"quantities", quantities}};
}

std::string DispersionReport::text() const {
  std::size_t width = 8;
  std::vector<const Quantity*> shown;
  for (const Quantity& quantity : quantities_) {
    if (varies(quantity)) {
      shown.push_back(&quantity);
      width = std::max(width, quantity.name.size());
    }
  }
  std::string text = fmt::format("{:<{}} {:>11} {:>11}", "quantity", width, "declared", "mean");
  for (const double percentile : goal_.percentiles) {
    text += fmt::format(" {:>11}", percentile_name(percentile) + " %");
  }
  text += "  most correlated with\n";
  for (const Quantity* quantity : shown) {
    const Statistics own = statistics_of(quantity->values);
    text += fmt::format("{:<{}} {:>11.4g} {:>11.4g}", quantity->name, width, quantity->declared, own.mean);
    for (const double percentile : goal_.percentiles) {
      text += fmt::format(" {:>11.4g}", quantile(own.ordered, 0.01 * percentile));
    }
    double largest = 0.0;
    std::string with;
    for (std::size_t i = 0; i < tolerance_values_.size(); ++i) {
      const std::vector<double> drawn(tolerance_values_[i].begin() + 1, tolerance_values_[i].end());
      const double correlation = rank_correlation(drawn, quantity->values);
      if (std::abs(correlation) > std::abs(largest)) {
        largest = correlation;
        with = fmt::format("  {} ({:+.2f})", dispersion_.tolerances().variables[i].key, correlation);
      }
    }
    text += with + "\n";
  }
  return text;
}

analysis::Chart DispersionReport::channel_chart(const std::string& channel) const {
  std::vector<std::vector<double>> by_row;
  const Json* declared = nullptr;
  for (const auto& [draw, result] : dispersion_.store().results()) {
    if (!result.complaint.empty()) {
      continue;
    }
    const Json& own = result.channels.at(channel);
    declared = draw == 0 ? &own : declared;
    const Json& rows = own.at("rows");
    by_row.resize(std::max(by_row.size(), rows.size()));
    for (std::size_t row = 0; draw > 0 && row < rows.size(); ++row) {
      by_row[row].push_back(rows[row].get<double>());
    }
  }
  const double start = declared->at("start");
  const double period = declared->at("period");
  std::vector<double> time;
  for (std::size_t row = 0; row < by_row.size(); ++row) {
    std::sort(by_row[row].begin(), by_row[row].end());
    time.push_back(start + period * static_cast<double>(row));
  }
  analysis::Panel panel{fmt::format("{} [{}]", channel, declared->at("unit").get<std::string>()), {}};
  for (const double percentile : goal_.percentiles) {
    analysis::Curve curve{percentile_name(percentile) + " %", time, {}};
    for (const std::vector<double>& ordered : by_row) {
      curve.y.push_back(ordered.empty() ? kNone : quantile(ordered, 0.01 * percentile));
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.curves.push_back({"declared", time, declared->at("rows").get<std::vector<double>>()});
  panel.curves.back().x.resize(panel.curves.back().y.size(), kNone);
  return {fmt::format("{} of {} draws", channel, dispersion_.plan().draws), "time [s]", false, {panel}};
}

std::map<std::string, analysis::Chart> DispersionReport::pictures() const {
  std::map<std::string, std::vector<const Quantity*>> kinds;
  for (const Quantity& quantity : quantities_) {
    if (varies(quantity)) {
      kinds[kind_of(quantity.name)].push_back(&quantity);
    }
  }
  std::map<std::string, analysis::Chart> pictures;
  for (const auto& [kind, members] : kinds) {
    for (std::size_t first = 0; first < members.size(); first += kMostCurves) {
      const std::string number = members.size() > kMostCurves ? fmt::format("-{}", first / kMostCurves + 1) : std::string{};
      analysis::Panel panel{kind, {}};
      for (std::size_t i = first; i < std::min(first + kMostCurves, members.size()); ++i) {
        const std::vector<double> ordered = statistics_of(members[i]->values).ordered;
        const std::string& name = members[i]->name;
        const std::string label = name.substr(0, name.size() - std::min(name.size(), kind.size() + 1));
        analysis::Curve curve{label.empty() ? kind : label, {}, ordered};
        for (std::size_t k = 0; k < ordered.size(); ++k) {
          curve.x.push_back(ordered.size() > 1 ? 100.0 * static_cast<double>(k) / static_cast<double>(ordered.size() - 1)
                                               : 50.0);
        }
        analysis::Curve marks{curve.label, goal_.percentiles, {}, true};
        for (const double percentile : goal_.percentiles) {
          marks.y.push_back(quantile(ordered, 0.01 * percentile));
        }
        panel.curves.push_back(std::move(curve));
        panel.curves.push_back(std::move(marks));
      }
      pictures[kind + number + ".svg"] = {fmt::format("{} of {} draws, with the percentiles {}", kind,
                                                      dispersion_.plan().draws, fmt::join(goal_.percentiles, ", ")),
                                          "draws below [%]",
                                          false,
                                          {panel}};
    }
  }
  for (const std::string& channel : dispersion_.plan().channels) {
    pictures["channel-" + channel + ".svg"] = channel_chart(channel);
  }
  return pictures;
}

}  // namespace hotfire::disperse
