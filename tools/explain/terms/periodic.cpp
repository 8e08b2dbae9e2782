// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/periodic.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>

namespace hotfire::explain {

namespace {

constexpr int kPhases = 6;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Squared residuals of every record at a point; infinite where it can't be simulated.
std::vector<double> cost_by_record(const Evaluator& evaluator, const Fitted& model, const std::vector<double>& u) {
  const std::size_t records = evaluator.data().experiments.size();
  Prediction prediction;
  if (!evaluator.predict(model.base, model.free, u, 1, prediction)) {
    return std::vector<double>(records, std::numeric_limits<double>::infinity());
  }
  std::vector<double> cost(records, 0.0);
  const Eigen::VectorXd residual = evaluator.residuals(prediction);
  for (const Stretch& s : evaluator.stretches()) {
    cost[s.experiment] +=
        residual.segment(static_cast<Eigen::Index>(s.offset), static_cast<Eigen::Index>(s.last - s.first)).squaredNorm();
  }
  return cost;
}

/// A sinusoid's own coordinates at a frequency and a factor of its typical amplitude, each record's clock at the best of the
/// phases tried. Records do not depend on each other's clock: one simulation tries a phase on all of them.
std::vector<double> at_best_phases(const Evaluator& evaluator, const Fitted& model, std::size_t own_first, double frequency,
                                   double factor) {
  const std::span<const FreeParameter> own = std::span(model.free).subspan(own_first);
  const std::size_t records = evaluator.data().experiments.size();
  std::vector<double> best(records, 0.0);
  std::vector<double> least(records, std::numeric_limits<double>::infinity());
  const auto point_at = [&](auto&& clock) {
    std::vector<double> point;
    for (const FreeParameter& parameter : own) {
      const double amplitude = factor * parameter.unit_size;
      const double value = parameter.is_initial_state() ? clock(static_cast<std::size_t>(parameter.experiment))
                           : parameter.unit == "Hz"     ? frequency
                                                        : amplitude;
      point.push_back(parameter.coordinate(value));
    }
    return point;
  };
  for (int phase = 0; phase < kPhases; ++phase) {
    const double clock = static_cast<double>(phase) / (kPhases * frequency);
    const std::vector<double> point = point_at([&](std::size_t) { return clock; });
    std::vector<double> u(model.u.begin(), model.u.begin() + static_cast<std::ptrdiff_t>(own_first));
    u.insert(u.end(), point.begin(), point.end());
    const std::vector<double> cost = cost_by_record(evaluator, model, u);
    for (std::size_t e = 0; e < records; ++e) {
      if (cost[e] < least[e]) {
        least[e] = cost[e];
        best[e] = clock;
      }
    }
  }
  return point_at([&](std::size_t e) { return best[e]; });
}

/// The phase of an effect's sinusoid as a free parameter.
FreeParameter phase_of(const ModelParameters& base, const Candidate& candidate) {
  FreeParameter phase;
  std::size_t index = 0;
  visit_parameters(base, [&](const model::Key& key, const auto& field, const double&) {
    if (key.is_effect && key.effect_index == candidate.effect && field.name == "phase") {
      phase = FreeParameter::at(index, {key, field.name}, field.unit);
      phase.lower = field.lower;
      phase.upper = field.upper;
    }
    ++index;
  });
  return phase;
}

}  // namespace

bool is_periodic(const Candidate& candidate) {
  return candidate.option_name == "periodic" || candidate.name == model::UnlistedRipple::name;
}

std::vector<FreeParameter> clocks(const Dataset& data) {
  std::vector<FreeParameter> free;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    FreeParameter parameter;
    parameter.key = fmt::format("{}.clock", data.experiments[e].name);
    parameter.unit = std::string("s");
    parameter.experiment = static_cast<int>(e);
    parameter.state = InitialState::clock;
    parameter.lower = -1e9;
    parameter.upper = 1e9;
    free.push_back(std::move(parameter));
  }
  return free;
}

std::vector<std::vector<double>> periodic_starts(const Evaluator& evaluator, const Fitted& with_candidate,
                                                 std::size_t own_first, const std::vector<double>& frequencies) {
  std::vector<std::vector<double>> starts;
  for (const double frequency : frequencies) {
    for (const double factor : {0.3, 1.0, 3.0}) {
      starts.push_back(at_best_phases(evaluator, with_candidate, own_first, frequency, factor));
    }
  }
  return starts;
}

Fitted with_common_phase(const Dataset& data, const Fitted& fitted, const Candidate& candidate) {
  double frequency = 0.0;
  for (std::size_t k = 0; k < fitted.free.size(); ++k) {
    if (fitted.free[k].is_of_effect(candidate.effect) && fitted.free[k].address.field == "frequency") {
      frequency = fitted.free[k].value(fitted.u[k]);
    }
  }
  std::complex<double> mean = 0.0;
  for (std::size_t k = 0; k < fitted.free.size(); ++k) {
    if (fitted.free[k].is_clock()) {
      const Experiment& experiment = data.experiments[static_cast<std::size_t>(fitted.free[k].experiment)];
      const double late = fitted.free[k].value(fitted.u[k]) - experiment.start;
      mean += std::polar(static_cast<double>(experiment.rows()), kTurn * frequency * late);
    }
  }
  Fitted common = fitted;
  drop_parameters(common, [](const FreeParameter& parameter) { return parameter.is_clock(); });
  common.free.push_back(phase_of(fitted.base, candidate));
  common.u.push_back(common.free.back().coordinate(std::arg(mean)));
  return common;
}

}  // namespace hotfire::explain
