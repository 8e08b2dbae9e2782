// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/unlisted_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "tools/explain/terms/periodic.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/terms/visit_term.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

/// Share of a curve's square from which on it is called by one property alone.
constexpr double kMostly = 0.9;

double at(const FittedTable& table, double x) { return model::curve_value<double>(table.x, table.y, table.x.size(), x); }

/// "load pressure", "rate times angle": the argument of a term of the grammar.
std::string quantity_of_term(const Candidate& candidate) {
  const auto argument = static_cast<std::size_t>(candidate.choices[0]);
  const auto factor = static_cast<std::size_t>(candidate.choices[1]);
  return words::spoken(model::kArgumentNames[argument]) +
         (factor == 0 ? "" : " times " + words::spoken(model::term::kFactorNames[factor]));
}

/// "through a delay": its memory; empty if it has none.
std::string memory_of_term(const Candidate& candidate) {
  constexpr std::array<std::string_view, model::kMemoryNames.size()> kMemories{"",
                                                                               "through a delay",
                                                                               "through a first-order lag",
                                                                               "through a washout filter",
                                                                               "through a resonance",
                                                                               "through a band-pass filter",
                                                                               "with hysteresis",
                                                                               "through play",
                                                                               "through a stop operator",
                                                                               "through a rate limit",
                                                                               "through a sample-and-hold",
                                                                               "through quantisation",
                                                                               "through a dead zone",
                                                                               "through saturation",
                                                                               "through a periodic function",
                                                                               "through the frequency of an oscillator",
                                                                               "through an odd power",
                                                                               "through an even power"};
  static_assert(!kMemories.back().empty());
  return std::string(kMemories[static_cast<std::size_t>(candidate.option)]);
}

/// "load pressure, through a delay": both.
std::string dependence_of_term(const Candidate& candidate) {
  const std::string memory = memory_of_term(candidate);
  return quantity_of_term(candidate) + (memory.empty() ? "" : ", " + memory);
}

/// "rad", "(m/s).(rad)": the unit of that argument.
std::string unit_of_term(const Candidate& candidate) {
  const auto factor = static_cast<std::size_t>(candidate.choices[1]);
  const std::string_view own = model::kArgumentUnits[static_cast<std::size_t>(candidate.choices[0])];
  const std::string_view other = factor == 0 ? "1" : model::kArgumentUnits[factor - 1];
  if (own == "1" || other == "1") {
    return std::string(own == "1" ? other : own);
  }
  return own == other ? fmt::format("({})^2", own) : fmt::format("({}).({})", own, other);
}

/// "0.01 m"; "0.01" of what has no dimension.
std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.3g}", value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// "addition to the flow": what a term adds at its site.
std::string added_by_term(const Candidate& candidate) {
  using model::Site;
  using model::term::Names;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kAdded{
      {{Names<Site::command, -1>::name, "addition to the command"},
       {Names<Site::valve_command, -1>::name, "addition to the valve command"},
       {Names<Site::valve, -1>::name, "addition to the opening of the valve"},
       {Names<Site::flow, -1>::name, "addition to the flow"},
       {Names<Site::piston, -1>::name, "added force against the piston"},
       {Names<Site::load_spring, -1>::name, "addition to the deflection of the load spring"},
       {Names<Site::engine_torque, -1>::name, "added torque against the engine"},
       {Names<Site::sensor, 0>::name, "addition to the reading of the piston"},
       {Names<Site::sensor, 1>::name, "addition to the reading of the engine"}}};
  return std::string(std::ranges::find(kAdded, candidate.name, &decltype(kAdded)::value_type::first)->second);
}

}  // namespace

FittedTable with_own_axes(FittedTable table, const Candidate& candidate) {
  if (candidate.choices.empty()) {
    return table;
  }
  const std::string quantity = quantity_of_term(candidate);
  table.x_unit = unit_of_term(candidate);
  if (candidate.option == static_cast<int>(model::Memory::stops)) {
    table.x_name = "stop width of " + quantity;
    table.y_name = table.meaning = "weight of a stop operator";
    table.y_unit = table.x_unit == "1" ? table.y_unit : fmt::format("({})/({})", table.y_unit, table.x_unit);
  } else if (is_oscillator(candidate)) {
    table.x_name = quantity;
    table.y_name = table.meaning = "frequency of an oscillator";
    table.y_unit = "Hz";
  } else {
    const std::string memory = memory_of_term(candidate);
    const std::string aside = memory.empty() ? memory : fmt::format(" ({})", memory);
    const bool curve_first = candidate.choices[2] == static_cast<int>(model::term::Order::curve_first);
    table.x_name = quantity + (curve_first ? "" : aside);
    table.y_name = added_by_term(candidate);
    table.meaning = table.y_name + (curve_first ? aside : "");
  }
  return table;
}

std::string in_words(const FittedTable& table) {
  const auto [least, most] = std::minmax_element(table.y.begin(), table.y.end());
  std::string text = fmt::format(
      "{} from {:.3g} to {} over {} from {:.3g} to {}. Beyond these bounds the value at the end holds", table.meaning,
      *least, with_unit(*most, table.y_unit), table.x_name, table.x.front(), with_unit(table.x.back(), table.x_unit));
  constexpr int kSamples = 101;
  const double reach = std::min(std::abs(table.x.front()), std::abs(table.x.back()));
  const bool two_sided = table.x.front() < 0.0 && table.x.back() > 0.0;
  double mean = 0.0;
  double square = 0.0;
  double odd = 0.0;
  double even = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double place = static_cast<double>(i) / (kSamples - 1);
    const double y = at(table, table.x.front() + place * (table.x.back() - table.x.front()));
    mean += y / kSamples;
    square += y * y / kSamples;
    const double forward = at(table, reach * place);
    const double backward = at(table, -reach * place);
    odd += 0.25 * (forward - backward) * (forward - backward);
    even += 0.25 * (forward + backward) * (forward + backward);
  }
  if (square > 0.0 && mean * mean > kMostly * square) {
    text += ". The curve is mostly constant";
  } else if (two_sided && odd > kMostly * (odd + even)) {
    text += ". The curve is odd";
    const double near_zero = at(table, 0.1 * reach) - at(table, -0.1 * reach);
    const double whole = table.y.back() - table.y.front();
    if (std::abs(near_zero) > 0.5 * std::abs(whole)) {
      text += ", with most of its range in a jump at zero, as in dry friction";
    }
  } else if (two_sided && even > kMostly * (odd + even)) {
    text += ". The curve is even";
  }
  const bool rises = std::is_sorted(table.y.begin(), table.y.end());
  const bool falls = std::is_sorted(table.y.rbegin(), table.y.rend());
  if (rises != falls) {
    text += rises ? ". It rises throughout" : ". It falls throughout";
  }
  return text;
}

std::string law_in_words(const Candidate& candidate) {
  if (!candidate.choices.empty()) {
    return "proportional to " + dependence_of_term(candidate);
  }
  if (is_periodic(candidate)) {
    return "a sinusoid of one frequency and one amplitude over the whole of every record, independent of the motion";
  }
  if (candidate.option_name == "creep") {
    return "a part of the deflection that follows the load through a first-order lag";
  }
  if (candidate.option_name == "deflection_rate") {
    return "a damper in series with a spring, beside the load spring: it relaxes with one time constant";
  }
  if (candidate.option_name == "lag") {
    return "a first-order lag of the command: it delays the command and attenuates its fast part";
  }
  if (candidate.option_name == "slew") {
    return "a spool with a limited speed";
  }
  if (candidate.option_name == "slip") {
    return "a joint beside the load spring that sticks and slips beyond a fixed stretch: a hysteresis loop whose width does "
           "not depend on the speed";
  }
  if (candidate.name == model::UnlistedWiperPlay::name) {
    return "a reading that changes only after the motion exceeds a play, as with a sticking wiper or a slack linkage";
  }
  return "";
}

std::string width_in_words(const ModelParameters& parameters, const Candidate& candidate) {
  std::string text;
  if (is_power(candidate)) {
    visit_term(parameters, candidate, [&](const auto& values) {
      text = fmt::format(" with a width of {}", with_unit(values.width, unit_of_term(candidate)));
    });
  }
  return text;
}

std::string dependence_in_words(const Candidate& candidate) {
  if (!candidate.choices.empty()) {
    return "that depends on " + dependence_of_term(candidate);
  }
  if (is_periodic(candidate)) {
    return "that is a sinusoid over time";
  }
  if (candidate.name == model::UnlistedWiperPlay::name) {
    return "with play";
  }
  if (candidate.name == model::UnlistedReading::name) {
    return "that depends on the reading itself";
  }
  if (candidate.name == model::UnlistedDrift::name) {
    return "that depends on the time of the record";
  }
  for (const auto& [law, clause] :
       {std::pair("creep", "with creep"), std::pair("lag", "with a first-order lag"), std::pair("slew", "with a rate limit"),
        std::pair("slip", "with slip"), std::pair("value", "that depends on the signal itself")}) {
    if (candidate.option_name == law) {
      return clause;
    }
  }
  // "friction_along_position": one quantity as a curve over another.
  constexpr std::string_view kAlong = "_along_";
  if (const auto along = candidate.option_name.find(kAlong); along != std::string::npos) {
    const std::string quantity = words::spoken(candidate.option_name.substr(along + kAlong.size()));
    return fmt::format("whose {} depends on {}", words::spoken(candidate.option_name.substr(0, along)),
                       quantity == "distance" ? "the distance from zero" : quantity);
  }
  return "that depends on " + words::spoken(candidate.option_name);
}

}  // namespace hotfire::explain
