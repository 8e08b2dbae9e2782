// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/loop_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hotfire::loop {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 360.0 / kTurn;

std::string name_of(double amplitude) {
  return amplitude > 0.0 ? fmt::format("{:.4g} deg", amplitude * kDegrees) : std::string("small deviations");
}

const char* word_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::decays:
      return "decays";
    case Outcome::oscillates:
      return "oscillates";
    case Outcome::grows:
      return "grows";
    case Outcome::unsettled:
      break;
  }
  return "unsettled";
}

std::string words_of(double amplitude, double frequency) {
  return fmt::format("{:.4g} deg of command at {:.4g} Hz", amplitude * kDegrees, frequency);
}

std::string words_of(const Oscillation& own) {
  const std::string outcome = word_of(own.outcome);
  return own.outcome == Outcome::oscillates ? outcome + ", " + words_of(own.amplitude, own.frequency) : outcome;
}

std::string words_of(const CheckedCycle& own) {
  if (!own.cycle.stable) {
    return "not stable";
  }
  switch (own.check) {
    case Check::stays:
      return "stable; a simulation that starts on it stays";
    case Check::unsettled:
      return "stable; a simulation that starts on it is unsettled";
    case Check::leaves:
    case Check::none:
      break;
  }
  return "stable; not checked by a simulation";
}

Json json_of(const Oscillation& own) {
  return {{"outcome", word_of(own.outcome)}, {"amplitude_degrees", own.amplitude * kDegrees}, {"hertz", own.frequency}};
}

}  // namespace

std::string text_of(const LoopResult& result) {
  std::string text = fmt::format("{} about {}\n", result.controller, result.axis);
  if (result.stable) {
    text += fmt::format("in small deviations the closed loop is {}\n", *result.stable ? "stable" : "not stable");
  }
  for (const MarginsAt& own : result.margins) {
    text += fmt::format("{}:\n", name_of(own.amplitude));
    for (const PhaseMargin& margin : own.margins.phase) {
      text += fmt::format("  phase margin {:8.2f} deg at {:.4g} Hz\n", margin.degrees, margin.frequency);
    }
    for (const GainMargin& margin : own.margins.gain) {
      text += fmt::format("  gain margin  {:8.2f} dB  at {:.4g} Hz\n", margin.decibels, margin.frequency);
    }
  }
  for (const LoopCurve& own : result.curves) {
    if (!own.without.empty()) {
      text += fmt::format("{}: no balance at {} frequencies, first {:.4g} Hz: left out\n", name_of(own.amplitude),
                          own.without.size(), own.without.front());
    }
  }
  for (const CheckedCycle& own : result.predicted) {
    if (own.check != Check::leaves) {
      text += fmt::format("limit cycle by describing function: {}, {}\n", words_of(own.cycle.amplitude, own.cycle.frequency),
                          words_of(own));
    }
  }
  for (const CheckedCycle& own : result.predicted) {
    if (own.check == Check::leaves) {
      text += fmt::format("no limit cycle: {} is a balance as well; a simulation that starts on it leaves it (end: {})\n",
                          words_of(own.cycle.amplitude, own.cycle.frequency), words_of(own.end));
    }
  }
  if (std::all_of(result.predicted.begin(), result.predicted.end(),
                  [](const CheckedCycle& own) { return own.check == Check::leaves; }) &&
      result.curves.size() > 1) {
    text += "no limit cycle by describing function between these amplitudes\n";
  }
  for (const Flown& own : result.flown) {
    text += fmt::format("simulated from {:.4g} deg of attitude: {}\n", own.attitude * kDegrees, words_of(own.oscillation));
  }
  return text;
}

Json to_json(const LoopResult& result) {
  Json json{{"controller", result.controller}, {"axis", result.axis}};
  json["stable_in_small_deviations"] = result.stable ? Json(*result.stable) : Json(nullptr);
  json["open_loop"] = Json::array();
  for (std::size_t k = 0; k < result.curves.size(); ++k) {
    const LoopCurve& curve = result.curves[k];
    Json own{{"amplitude_degrees", curve.amplitude * kDegrees},
             {"phase_margins", Json::array()},
             {"gain_margins", Json::array()},
             {"response", Json::array()},
             {"without_balance_hertz", curve.without}};
    for (const PhaseMargin& margin : result.margins[k].margins.phase) {
      own["phase_margins"].push_back({{"hertz", margin.frequency}, {"degrees", margin.degrees}});
    }
    for (const GainMargin& margin : result.margins[k].margins.gain) {
      own["gain_margins"].push_back({{"hertz", margin.frequency}, {"decibels", margin.decibels}});
    }
    for (const auto& [frequency, loop] : curve.points) {
      own["response"].push_back({{"hertz", frequency},
                                 {"gain_decibels", 20.0 * std::log10(std::abs(loop))},
                                 {"phase_degrees", std::arg(loop) * kDegrees}});
    }
    json["open_loop"].push_back(std::move(own));
  }
  json["limit_cycles"] = Json::array();
  json["balances_left"] = Json::array();
  for (const CheckedCycle& own : result.predicted) {
    Json cycle{{"amplitude_degrees", own.cycle.amplitude * kDegrees},
               {"hertz", own.cycle.frequency},
               {"stable", own.cycle.stable},
               {"simulation", own.check == Check::none ? Json(nullptr) : json_of(own.end)}};
    json[own.check == Check::leaves ? "balances_left" : "limit_cycles"].push_back(std::move(cycle));
  }
  json["simulations"] = Json::array();
  for (const Flown& own : result.flown) {
    Json flown{{"attitude_degrees", own.attitude * kDegrees}};
    flown.update(json_of(own.oscillation));
    json["simulations"].push_back(std::move(flown));
  }
  return json;
}

analysis::Chart bode_chart(const LoopResult& result) {
  analysis::Chart chart;
  chart.title = fmt::format("Open loop of {} about {}", result.controller, result.axis);
  chart.abscissa = "frequency [Hz]";
  chart.logarithmic = true;
  analysis::Panel gain{"gain [dB]", {}};
  analysis::Panel phase{"phase [deg]", {}};
  for (const LoopCurve& curve : result.curves) {
    analysis::Curve sizes{name_of(curve.amplitude), {}, {}};
    double last = 0.0;
    analysis::Curve angles{name_of(curve.amplitude), {}, {}};
    for (const auto& [frequency, loop] : curve.points) {
      // Continued from point to point.
      last += std::remainder(std::arg(loop) - last, kTurn);
      sizes.x.push_back(frequency);
      sizes.y.push_back(20.0 * std::log10(std::abs(loop)));
      angles.x.push_back(frequency);
      angles.y.push_back(last * kDegrees);
    }
    gain.curves.push_back(std::move(sizes));
    phase.curves.push_back(std::move(angles));
  }
  chart.panels = {std::move(gain), std::move(phase)};
  return chart;
}

}  // namespace hotfire::loop
