// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/results_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/trials/profiles.hpp"

namespace hotfire::trials {

namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const ResonanceStiffness& stiffness) {
  return {{"hertz", stiffness.frequency},
          {"peak_force", stiffness.peak_force},
          {"total_stiffness", stiffness.total},
          {"actuator_stiffness", number_or_null(stiffness.actuator)}};
}

}  // namespace

Json to_json(const std::vector<ChannelSweep>& sweeps) {
  Json all = Json::array();
  for (const ChannelSweep& sweep : sweeps) {
    Json own{{"channel", sweep.channel}, {"amplitude_degrees", degrees(sweep.amplitude)}};
    own["notch"] = sweep.notch ? Json{{"hertz", sweep.notch->frequency},
                                      {"gain_decibels", sweep.notch->gain},
                                      {"depth_decibels", sweep.notch->depth}}
                               : Json(nullptr);
    own["peak"] = sweep.peak ? Json{{"hertz", sweep.peak->frequency}, {"gain_decibels", sweep.peak->gain}} : Json(nullptr);
    const std::vector<double> phase = analysis::phase_degrees(sweep.response);
    own["response"] = Json::array();
    for (std::size_t k = 0; k < phase.size(); ++k) {
      own["response"].push_back({{"hertz", sweep.response[k].frequency},
                                 {"gain_decibels", analysis::gain_decibels(sweep.response[k])},
                                 {"phase_degrees", phase[k]},
                                 {"coherence", sweep.response[k].coherence}});
    }
    all.push_back(std::move(own));
  }
  return all;
}

Json to_json(const std::vector<analysis::StepResponse>& steps, double period) {
  Json all = Json::array();
  for (const analysis::StepResponse& step : steps) {
    all.push_back({{"seconds", static_cast<double>(step.row) * period},
                   {"from_degrees", degrees(step.from)},
                   {"to_degrees", degrees(step.to)},
                   {"change", step.change},
                   {"rise_time", number_or_null(step.rise_time)},
                   {"overshoot", step.overshoot},
                   {"settling_time", number_or_null(step.settling_time)},
                   {"hesitation", step.hesitation}});
  }
  return all;
}

Json to_json(const std::vector<SineStiffness>& stiffnesses, const LoadSpring& spring) {
  Json sines = Json::array();
  for (const SineStiffness& own : stiffnesses) {
    sines.push_back({{"amplitude_degrees", degrees(own.amplitude)},
                     {"test", own.test ? to_json(*own.test) : Json(nullptr)},
                     {"expected", to_json(own.expected)}});
  }
  return {{"load_stiffness", spring.load.load_stiffness},
          {"asymptote", {{"hertz", asymptote(spring)}, {"actuator_stiffness", spring.loaded}}},
          {"sines", sines}};
}

}  // namespace hotfire::trials
