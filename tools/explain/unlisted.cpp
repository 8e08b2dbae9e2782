#include "tools/explain/unlisted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/step_size.hpp"
#include "tools/explain/curve_points.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

constexpr int kPoints = 11;
constexpr int kPhases = 6;

/// Least and largest value of a quantity over the rows that a fit sees: beyond them a table would be a guess.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }

  /// Of the distances from zero.
  Extent distances() const { return {0.0, std::max(std::abs(low), std::abs(high))}; }
};

/// What the plant runs through, by the name that the tables give it.
struct Extents {
  Extent input, opening, flow, pressure, position, rate, angle, angle_rate, other_angle, other_rate, deflection, drive, load,
      time;

  Extent of(model::Site site, std::string_view x_name) const {
    using model::Site;
    const bool is_rate = x_name == "rate";
    if (x_name.starts_with("distance")) {
      return of(site, "position").distances();
    }
    if (x_name == "load_of_friction") {
      return (site == Site::piston ? drive : load).distances();
    }
    if (x_name.starts_with("other")) {
      return x_name == "other_rate" ? other_rate : other_angle;
    }
    if (x_name.starts_with("time")) {
      return time;
    }
    if (x_name == "recent_flow") {
      return flow.distances();
    }
    if (x_name == "load_pressure") {
      return pressure;
    }
    if (x_name == "deflection") {
      return deflection;
    }
    switch (site) {
      case Site::command:
        return input;
      case Site::valve_command:
      case Site::valve:
      case Site::flow:
        return opening;
      case Site::engine_torque:
        return is_rate ? angle_rate : angle;
      default:
        return x_name == "angle" ? angle : is_rate ? rate : position;
    }
  }
};

void take_state(Extents& extents, const model::Simplex<double>& plant, const model::Simplex<double>::State& state) {
  using Plant = model::Simplex<double>;
  extents.opening.take(state.y(Plant::kOpening));
  extents.flow.take(plant.parameters().servovalve.rated_flow * state.y(Plant::kOpening));
  extents.pressure.take(state.y(Plant::kPressure));
  extents.position.take(state.y(Plant::kPiston));
  extents.rate.take(state.y(Plant::kPistonRate));
  extents.angle.take(state.y(Plant::kAngle));
  extents.angle_rate.take(state.y(Plant::kAngleRate));
  extents.drive.take(plant.parameters().actuator.piston_area * state.y(Plant::kPressure));
  extents.load.take(state.spring_force);
  extents.deflection.take(state.y(Plant::kPiston) - plant.parameters().actuator.moment_arm * state.y(Plant::kAngle));
}

void take_state(Extents& extents, const model::Direct<double>&, const model::Direct<double>::State& state) {
  extents.position.take(state.y(0));
  extents.rate.take(state.y(1));
}

template <class Family>
Extents extents_of(const Dataset& data, const PlainParameters<Family>& parameters) {
  using Plant = typename Family::template Plant<double>;
  Extents extents;
  for (const Experiment& experiment : data.experiments) {
    const int steps = model::steps_per_period<Plant>(parameters, experiment.period);
    const Plant plant(parameters, experiment.period / steps);
    typename Plant::State state = [&] {
      if constexpr (Plant::topology == "direct") {
        return plant.moving(experiment.start_state.position, experiment.start_state.velocity);
      } else {
        return plant.steady(experiment.input.front());
      }
    }();
    auto block = experiment.fitted.begin();
    run(plant, experiment.input, state, steps, [&](std::size_t row, const auto&) {
      while (block != experiment.fitted.end() && row >= block->last) {
        ++block;
      }
      if (block != experiment.fitted.end() && row >= block->first) {
        take_state(extents, plant, state);
        extents.input.take(experiment.input[row]);
        extents.time.take(experiment.time_of(row));
        if (experiment.other.is_there()) {
          extents.other_angle.take(experiment.other.angle[row]);
          extents.other_rate.take(experiment.other.rate[row]);
        }
      }
    });
  }
  return extents;
}

template <class Table>
void lay_points(Table& table, Extent extent, bool is_rate) {
  if (!(extent.high > extent.low)) {
    extent = {extent.low - 1e-6, extent.low + 1e-6};
  }
  table.points = kPoints;
  const double reach = std::max(std::abs(extent.low), std::abs(extent.high));
  for (int i = 0; i < kPoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double place = static_cast<double>(i) / (kPoints - 1);
    const double about_zero = 2.0 * place - 1.0;
    table.x[k] = is_rate ? reach * about_zero * std::abs(about_zero) : extent.low + (extent.high - extent.low) * place;
    table.y[k] = 0.0;
  }
}

/// Over the readings of one channel: where what the model leaves of it bends.
template <class Family, class Table>
void lay_points_by_reading(Table& table, const Dataset& data, const Fitted<Family>& current, std::size_t channel) {
  const Evaluator<Family> evaluator(data, Resolution::coarse);
  Prediction prediction;
  if (!evaluator.predict(current.base, current.free, current.u, 1, prediction)) {
    return;
  }
  std::vector<double> reading;
  std::vector<double> left;
  for (const Stretch& s : evaluator.stretches()) {
    if (s.channel == channel) {
      const std::vector<double>& predicted = prediction[s.experiment][channel];
      const std::vector<double>& measured = data.experiments[s.experiment].measured[channel];
      for (std::size_t row = s.first; row < s.last; ++row) {
        reading.push_back(predicted[row]);
        left.push_back((measured[row] - predicted[row]) / data.noise[channel]);
      }
    }
  }
  const std::vector<double> points = curve_points(reading, left, table.x.size());
  std::copy(points.begin(), points.end(), table.x.begin());
  table.points = static_cast<int>(points.size());
}

template <class E>
constexpr bool is_unlisted_effect() {
  return requires { E::is_unlisted; };
}

/// Squared residuals of every record at a point; infinite where it can't be simulated.
template <class Family>
std::vector<double> cost_by_record(const Evaluator<Family>& evaluator, const Fitted<Family>& model,
                                   const std::vector<double>& u) {
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
template <class Family>
std::vector<double> at_best_phases(const Evaluator<Family>& evaluator, const Fitted<Family>& model, std::size_t own_first,
                                   double frequency, double factor) {
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

}  // namespace

template <class Family>
bool is_unlisted(const Candidate& candidate) {
  bool result = false;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    result = result || (index == candidate.effect && is_unlisted_effect<E>());
  });
  return result;
}

bool is_periodic(const Candidate& candidate) {
  return candidate.option_name == "periodic" || candidate.name == model::UnlistedRipple::name;
}

template <class Family>
std::vector<Candidate> unlisted_candidates(const Dataset& data) {
  std::vector<Candidate> candidates;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (is_unlisted_effect<E>()) {
      for (std::size_t option = 0; option < E::options.size(); ++option) {
        if (model::needs_other_axis<E>(static_cast<int>(option)) && !data.has_other_axis()) {
          continue;
        }
        Candidate candidate{index, static_cast<int>(option), std::string(E::name), std::string(E::options[option]),
                            std::string(model::site_name(E::site))};
        if constexpr (E::site == model::Site::sensor) {
          if (!data.used[option]) {
            continue;
          }
          candidate.site = fmt::format("{}.{}", candidate.site, candidate.option_name);
        }
        candidates.push_back(std::move(candidate));
      }
    }
  });
  return candidates;
}

template <class Family>
void activate_unlisted(PlainParameters<Family>& parameters, const Candidate& candidate, const Dataset& data,
                       const Fitted<Family>& current) {
  activate<Family>(parameters, candidate);
  model::visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (is_unlisted_effect<E>()) {
      using Values = std::remove_cvref_t<decltype(values)>;
      if (index != candidate.effect) {
        return;
      }
      if constexpr (requires { Values::tables(); }) {
        for (const auto& field : Values::tables()) {
          if ((field.options >> candidate.option & 1U) != 0) {
            auto& table = values.*field.member;
            if constexpr (std::is_same_v<E, model::UnlistedReading>) {
              lay_points_by_reading<Family>(table, data, current, static_cast<std::size_t>(candidate.option));
            } else {
              const auto parameters_now = Evaluator<Family>::with_values(current.base, current.free, current.u);
              const Extents extents = extents_of<Family>(data, parameters_now);
              lay_points(table, extents.of(E::site, field.x_name), field.x_name.ends_with("rate"));
            }
          }
        }
      }
    }
  });
}

template <class Family>
std::optional<FittedTable> table_of(const PlainParameters<Family>& parameters, const Candidate& candidate) {
  std::optional<FittedTable> result;
  model::visit_effects(parameters, [&]<class E>(std::size_t index, const auto& values) {
    if constexpr (is_unlisted_effect<E>()) {
      using Values = std::remove_cvref_t<decltype(values)>;
      if constexpr (requires { Values::tables(); }) {
        for (const auto& field : Values::tables()) {
          const auto& table = values.*field.member;
          if (index == candidate.effect && (field.options >> candidate.option & 1U) != 0 && table.points > 0) {
            result = FittedTable{std::string(field.x_name),
                                 std::string(field.x_unit),
                                 std::string(field.y_name),
                                 std::string(field.y_unit),
                                 std::string(field.meaning),
                                 {table.x.begin(), table.x.begin() + table.points},
                                 {table.y.begin(), table.y.begin() + table.points}};
          }
        }
      }
    }
  });
  return result;
}

std::vector<FreeParameter> clocks(const Dataset& data) {
  std::vector<FreeParameter> free;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    FreeParameter parameter;
    parameter.key = fmt::format("{}.clock", data.experiments[e].name);
    parameter.unit = std::string("s");
    parameter.experiment = static_cast<int>(e);
    parameter.state = 2;
    parameter.lower = -1e9;
    parameter.upper = 1e9;
    free.push_back(std::move(parameter));
  }
  return free;
}

template <class Family>
std::vector<std::vector<double>> periodic_starts(const Evaluator<Family>& evaluator, const Fitted<Family>& with_candidate,
                                                 std::size_t own_first, const std::vector<double>& frequencies) {
  std::vector<std::vector<double>> starts;
  for (const double frequency : frequencies) {
    for (const double factor : {0.3, 1.0, 3.0}) {
      starts.push_back(at_best_phases(evaluator, with_candidate, own_first, frequency, factor));
    }
  }
  return starts;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                                  \
  template bool is_unlisted<Family>(const Candidate&);                                                               \
  template std::optional<FittedTable> table_of<Family>(const PlainParameters<Family>&, const Candidate&);            \
  template std::vector<Candidate> unlisted_candidates<Family>(const Dataset&);                                       \
  template void activate_unlisted<Family>(PlainParameters<Family>&, const Candidate&, const Dataset&,                \
                                          const Fitted<Family>&);                                                    \
  template std::vector<std::vector<double>> periodic_starts<Family>(const Evaluator<Family>&, const Fitted<Family>&, \
                                                                    std::size_t, const std::vector<double>&);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
