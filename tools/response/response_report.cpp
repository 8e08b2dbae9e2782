// SPDX-License-Identifier: Apache-2.0
#include "tools/response/response_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire::response {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMega = 1e6;

double decibels(const std::complex<double>& response) { return 20.0 * std::log10(std::abs(response)); }
double phase_degrees(const std::complex<double>& response) { return std::arg(response) * 180.0 / std::numbers::pi; }

const MeasuredAxis* measured_of(const Comparison& comparison, const Condition& condition, const ConditionAxis& axis) {
  const auto found = std::find_if(comparison.measured.begin(), comparison.measured.end(), [&](const MeasuredAxis& own) {
    return own.condition == condition.name && own.axis == axis.name;
  });
  return found != comparison.measured.end() ? &*found : nullptr;
}

/// What a measured load resonance says: the total stiffness [SD eq. 10], and the load stiffness that it leaves beside the
/// equivalent actuator [SD eq. 9], infinite if the total is no softer than the actuator [N/m].
struct MeasuredStiffness {
  double total;
  double load;
};
std::optional<MeasuredStiffness> stiffness_of(const Comparison& comparison, const Condition& condition,
                                              const ConditionAxis& axis) {
  const MeasuredAxis* own = measured_of(comparison, condition, axis);
  if (own == nullptr) {
    return {};
  }
  const double total = analysis::total_stiffness(axis.spring.load, own->resonance);
  return MeasuredStiffness{total, analysis::beside(axis.stiffness.actuator, total)};
}

/// Responses of one condition over the grid: of every port to its own force, and of every actuator.
struct Responses {
  std::vector<std::string> names;  ///< ports, then "actuator.AXIS"
  std::vector<std::string> units;
  std::vector<std::vector<std::complex<double>>> values;
};

Responses responses_of(const Comparison& comparison, const Condition& condition) {
  Responses own;
  own.names = port_names(condition.modes.engines);
  const std::size_t attach_points = own.names.size() / 2;
  for (std::size_t port = 0; port < own.names.size(); ++port) {
    own.units.emplace_back(port < attach_points ? "m/N" : "rad/(N.m)");
  }
  for (const ConditionAxis& axis : condition.axes) {
    own.names.push_back("actuator." + axis.name);
    own.units.emplace_back("m/N");
  }
  own.values.resize(own.names.size());
  for (const double frequency : comparison.frequencies) {
    const Eigen::MatrixXcd ports = structure_response(condition, frequency);
    for (Eigen::Index port = 0; port < ports.rows(); ++port) {
      own.values[static_cast<std::size_t>(port)].push_back(ports(port, port));
    }
    if (!condition.axes.empty()) {
      const Eigen::MatrixXcd motion = actuator_response(condition, frequency).motion;
      for (Eigen::Index axis = 0; axis < motion.rows(); ++axis) {
        own.values[static_cast<std::size_t>(ports.rows() + axis)].push_back(motion(axis, axis));
      }
    }
  }
  return own;
}

/// Curves of those responses whose name begins so, in decibels.
std::vector<analysis::Curve> curves_of(const Comparison& comparison, const Responses& responses, const std::string& kind) {
  std::vector<analysis::Curve> curves;
  for (std::size_t i = 0; i < responses.names.size(); ++i) {
    if (responses.names[i].starts_with(kind)) {
      analysis::Curve curve{responses.names[i].substr(kind.size()), comparison.frequencies, {}};
      std::transform(responses.values[i].begin(), responses.values[i].end(), std::back_inserter(curve.y), decibels);
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

analysis::Chart modal_integral_chart(const Comparison& comparison) {
  analysis::Chart chart{"Load stiffness by modal integral up to a frequency", "frequency [Hz]", true, {}};
  for (const Condition& condition : comparison.conditions) {
    analysis::Panel panel{condition.name + " [MN/m]", {}};
    const std::vector<std::string> ports = port_names(condition.modes.engines);
    for (int axis = 0; axis < 2 * condition.modes.engines; ++axis) {
      const StiffnessByFrequency own = load_stiffness_by_frequency(condition, axis);
      analysis::Curve curve{ports[static_cast<std::size_t>(axis)].substr(7), {}, {}};
      // A stair: the stiffness falls at each mode.
      double before = std::numeric_limits<double>::quiet_NaN();
      const double end = comparison.frequencies.back();
      for (std::size_t k = 0; k < own.frequency.size() && own.frequency[k] <= end; ++k) {
        const double frequency = std::max(own.frequency[k], comparison.frequencies.front());
        curve.x.insert(curve.x.end(), {frequency, frequency});
        curve.y.insert(curve.y.end(), {before, own.stiffness[k] / kMega});
        before = own.stiffness[k] / kMega;
      }
      curve.x.push_back(end);
      curve.y.push_back(before);
      panel.curves.push_back(std::move(curve));
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

/// Load resonance over total stiffness: the law as lines, each axis of a condition as a dot, measured ones too [SD fig. 6].
analysis::Chart resonance_chart(const Comparison& comparison) {
  analysis::Panel panel{"load resonance [Hz]", {}};
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  std::vector<analysis::Curve> dots;
  for (const Condition& condition : comparison.conditions) {
    analysis::Curve predicted{condition.name, {}, {}, true};
    analysis::Curve measured{condition.name + " measured", {}, {}, true};
    for (const ConditionAxis& axis : condition.axes) {
      predicted.x.push_back(axis.stiffness.total / kMega);
      predicted.y.push_back(axis.stiffness.frequency);
      least = std::min(least, axis.stiffness.total);
      greatest = std::max(greatest, axis.spring.load.load_stiffness);
      if (const MeasuredAxis* own = measured_of(comparison, condition, axis)) {
        // Where the model expects this axis, so that what is off is seen as a distance from the line.
        measured.x.push_back(axis.stiffness.total / kMega);
        measured.y.push_back(own->resonance);
      }
    }
    dots.push_back(std::move(predicted));
    if (!measured.x.empty()) {
      dots.push_back(std::move(measured));
    }
  }
  constexpr int kPoints = 60;
  const analysis::LoadResonance& load = comparison.conditions.front().axes.front().spring.load;
  analysis::Curve law{"eq. 10", {}, {}};
  for (int i = 0; i <= kPoints; ++i) {
    const double total = 0.7 * least + (greatest - 0.7 * least) * i / kPoints;
    law.x.push_back(total / kMega);
    law.y.push_back(analysis::load_frequency(load, total));
  }
  panel.curves = std::move(dots);
  panel.curves.push_back(std::move(law));
  return {"Load resonance over total stiffness", "total stiffness [MN/m]", false, {panel}};
}

analysis::Chart location_chart(const Comparison& comparison) {
  analysis::Panel panel{"load stiffness [MN/m]", {}};
  std::string order;
  for (const Condition& condition : comparison.conditions) {
    analysis::Curve predicted{condition.name, {}, {}, true};
    analysis::Curve measured{condition.name + " measured", {}, {}, true};
    for (std::size_t i = 0; i < condition.axes.size(); ++i) {
      const ConditionAxis& axis = condition.axes[i];
      const double location = static_cast<double>(i) + 1.0;
      predicted.x.push_back(location);
      predicted.y.push_back(axis.spring.load.load_stiffness / kMega);
      if (const auto stiffness = stiffness_of(comparison, condition, axis)) {
        measured.x.push_back(location);
        measured.y.push_back(stiffness->load / kMega);
      }
      if (&condition == &comparison.conditions.front()) {
        order += fmt::format("{}{} {}", i == 0 ? "" : ", ", i + 1, axis.name);
      }
    }
    panel.curves.push_back(std::move(predicted));
    if (!measured.x.empty()) {
      panel.curves.push_back(std::move(measured));
    }
  }
  return {"Load stiffness by location", "location: " + order, false, {panel}};
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json responses_json(const Comparison& comparison, const Condition& condition) {
  const Responses responses = responses_of(comparison, condition);
  Json all = Json::object();
  for (std::size_t i = 0; i < responses.names.size(); ++i) {
    Json gain = Json::array();
    Json phase = Json::array();
    for (const std::complex<double>& value : responses.values[i]) {
      gain.push_back(std::abs(value));
      phase.push_back(phase_degrees(value));
    }
    all[responses.names[i]] = {{"unit", responses.units[i]}, {"gain", gain}, {"phase_degrees", phase}};
  }
  return all;
}

}  // namespace

void require_known(const Comparison& comparison) {
  for (const MeasuredAxis& own : comparison.measured) {
    std::vector<std::string_view> conditions;
    std::vector<std::string_view> axes;
    for (const Condition& condition : comparison.conditions) {
      conditions.push_back(condition.name);
      if (condition.name == own.condition) {
        std::for_each(condition.axes.begin(), condition.axes.end(),
                      [&](const ConditionAxis& axis) { axes.push_back(axis.name); });
      }
    }
    if (std::find(conditions.begin(), conditions.end(), own.condition) == conditions.end()) {
      throw UsageError(fmt::format("--measured: condition \"{}\" is not compared; {}", own.condition,
                                   suggestion(own.condition, conditions)));
    }
    if (std::find(axes.begin(), axes.end(), own.axis) == axes.end()) {
      throw UsageError(fmt::format("--measured: axis \"{}\" of condition \"{}\" is not there; {}", own.axis, own.condition,
                                   suggestion(own.axis, axes)));
    }
  }
}

Json to_json(const Comparison& comparison, bool responses) {
  Json conditions = Json::array();
  for (const Condition& condition : comparison.conditions) {
    Json axes = Json::array();
    for (const ConditionAxis& axis : condition.axes) {
      const auto measured = stiffness_of(comparison, condition, axis);
      axes.push_back({{"axis", axis.name},
                      {"load_stiffness", axis.spring.load.load_stiffness},
                      {"actuator_stiffness", axis.stiffness.actuator},
                      {"total_stiffness", axis.stiffness.total},
                      {"resonance_hertz", axis.stiffness.frequency},
                      {"peak_force", axis.stiffness.peak_force},
                      {"measured_load_stiffness", measured ? number_or_null(measured->load) : Json(nullptr)},
                      {"measured_total_stiffness", measured ? Json(measured->total) : Json(nullptr)}});
    }
    Json integrals = Json::object();
    const std::vector<std::string> ports = port_names(condition.modes.engines);
    for (int axis = 0; axis < 2 * condition.modes.engines; ++axis) {
      const StiffnessByFrequency integral = load_stiffness_by_frequency(condition, axis);
      integrals[ports[static_cast<std::size_t>(axis)]] = {{"hertz", integral.frequency},
                                                          {"load_stiffness", integral.stiffness}};
    }
    Json all{
        {"condition", condition.name}, {"modes", condition.modes.modes()}, {"axes", axes}, {"modal_integral", integrals}};
    if (responses) {
      all["responses"] = responses_json(comparison, condition);
    }
    conditions.push_back(std::move(all));
  }
  Json all{{"conditions", conditions}};
  if (responses) {
    all["hertz"] = comparison.frequencies;
  }
  return all;
}

std::string text_of(const Comparison& comparison) {
  std::string text;
  for (const Condition& condition : comparison.conditions) {
    text += fmt::format("{}: {} modes\n", condition.name, condition.modes.modes());
    for (const ConditionAxis& axis : condition.axes) {
      text += fmt::format("  {}: load {:.3g} N/m, actuator {:.3g} N/m, total {:.3g} N/m, load resonance {:.2f} Hz",
                          axis.name, axis.spring.load.load_stiffness, axis.stiffness.actuator, axis.stiffness.total,
                          axis.stiffness.frequency);
      if (const auto measured = stiffness_of(comparison, condition, axis)) {
        text += fmt::format("; measured: load {:.3g} N/m, total {:.3g} N/m", measured->load, measured->total);
      }
      text += '\n';
    }
    if (condition.axes.empty()) {
      const std::vector<std::string> ports = port_names(condition.modes.engines);
      for (int axis = 0; axis < 2 * condition.modes.engines; ++axis) {
        const StiffnessByFrequency own = load_stiffness_by_frequency(condition, axis);
        text += fmt::format("  {}: load {}\n", ports[static_cast<std::size_t>(axis)],
                            own.stiffness.empty() ? std::string("rigid") : fmt::format("{:.3g} N/m", own.stiffness.back()));
      }
    }
  }
  return text;
}

std::string table_of(const Comparison& comparison) {
  std::string text = "frequency[Hz]";
  std::vector<Responses> all;
  for (const Condition& condition : comparison.conditions) {
    all.push_back(responses_of(comparison, condition));
    for (std::size_t i = 0; i < all.back().names.size(); ++i) {
      text += fmt::format(",{0}.{1}[{2}],{0}.{1}.phase[deg]", condition.name, all.back().names[i], all.back().units[i]);
    }
  }
  text += '\n';
  for (std::size_t row = 0; row < comparison.frequencies.size(); ++row) {
    text += fmt::format("{}", comparison.frequencies[row]);
    for (const Responses& responses : all) {
      for (const auto& values : responses.values) {
        text += fmt::format(",{},{}", std::abs(values[row]), phase_degrees(values[row]));
      }
    }
    text += '\n';
  }
  return text;
}

std::map<std::string, analysis::Chart> pictures_of(const Comparison& comparison) {
  std::map<std::string, analysis::Chart> pictures;
  analysis::Chart structure{"Force to displacement at the attach points, engines free", "frequency [Hz]", true, {}};
  analysis::Chart actuators{"Force to displacement across the actuators, as springs", "frequency [Hz]", true, {}};
  for (const Condition& condition : comparison.conditions) {
    const Responses responses = responses_of(comparison, condition);
    structure.panels.push_back({condition.name + " [dB m/N]", curves_of(comparison, responses, "attach.")});
    structure.panels.push_back({condition.name + " gimbals [dB rad/(N m)]", curves_of(comparison, responses, "gimbal.")});
    if (!condition.axes.empty()) {
      actuators.panels.push_back({condition.name + " [dB m/N]", curves_of(comparison, responses, "actuator.")});
    }
  }
  pictures["structure.svg"] = std::move(structure);
  pictures["modal_integral.svg"] = modal_integral_chart(comparison);
  if (!actuators.panels.empty()) {
    pictures["actuators.svg"] = std::move(actuators);
  }
  const bool has_engines = std::all_of(comparison.conditions.begin(), comparison.conditions.end(),
                                       [](const Condition& condition) { return !condition.axes.empty(); });
  if (has_engines) {
    pictures["resonances.svg"] = resonance_chart(comparison);
    pictures["locations.svg"] = location_chart(comparison);
  }
  return pictures;
}

}  // namespace hotfire::response
