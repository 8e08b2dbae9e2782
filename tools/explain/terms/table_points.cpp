// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/table_points.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "model/numerics/step_size.hpp"
#include "tools/explain/data/statistics.hpp"
#include "tools/explain/fit/curve_points.hpp"
#include "tools/explain/fit/experiment_run.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// Of a table as it is laid for the search.
constexpr int kPoints = 11;

/// Of the distances of a quantity from zero.
Extent distances(const Extent& extent) { return {0.0, std::max(std::abs(extent.low), std::abs(extent.high))}; }

/// What the plant runs through over the rows that a fit sees, by the name that the tables give it: beyond an extent a table
/// would be a guess.
struct Extents {
  Extent input, opening, flow, pressure, position, rate, angle, angle_rate, other_angle, other_rate, deflection, drive, load,
      time;

  Extent of(model::Site site, std::string_view x_name) const {
    using model::Site;
    const bool is_rate = x_name == "rate";
    if (x_name.starts_with("distance")) {
      return distances(of(site, "position"));
    }
    if (x_name == "load_of_friction") {
      return distances(site == Site::piston ? drive : load);
    }
    if (x_name.starts_with("other")) {
      return x_name == "other_rate" ? other_rate : other_angle;
    }
    if (x_name.starts_with("time")) {
      return time;
    }
    if (x_name == "recent_flow") {
      return distances(flow);
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

/// Of the joint.
void take_state(Extents& extents, const model::Modal<double>& plant, const model::Modal<double>::State& state) {
  extents.position.take(plant.joint_position(state));
  extents.rate.take(plant.joint_rate(state));
}

/// Of the load.
void take_state(Extents& extents, const model::Electromechanical<double>& plant,
                const model::Electromechanical<double>::State& state) {
  extents.position.take(plant.load_position(state));
  extents.rate.take(plant.load_rate(state));
}

/// Of a driven mass or a moved body.
template <class Plant>
void take_state(Extents& extents, const Plant&, const typename Plant::State& state) {
  extents.position.take(state.y(0));
  extents.rate.take(state.y(1));
}

template <class Parameters>
Extents extents_under(const Dataset& data, const Parameters& parameters) {
  using Plant = PlantOf<Parameters, double>;
  Extents extents;
  for (const Experiment& experiment : data.experiments) {
    const int steps = steps_in_row<Plant>(parameters, experiment.period);
    const Plant plant(parameters, experiment.period / steps);
    typename Plant::State state = [&] {
      if constexpr (Plant::topology == "imposed_motion") {
        return enter_path(plant, experiment.input, experiment.period, experiment.start);
      } else if constexpr (Plant::topology == "direct") {
        return plant.moving(experiment.start_state.position, experiment.start_state.velocity, experiment.input.front());
      } else if constexpr (Plant::topology == "modal") {
        return plant.at_rest(0.0);
      } else if constexpr (Plant::topology == "electromechanical") {
        return at_first_row(plant, experiment.input.front(), experiment.measured[Plant::kPosition],
                            experiment.measured[Plant::kMotorPosition]);
      } else {
        return plant.resting(experiment.input.front(),
                             first_piston(plant, experiment.input, experiment.measured[0], experiment.measured[1]));
      }
    }();
    auto block = experiment.fitted.begin();
    run_experiment(plant, data, experiment, state, steps, [&](std::size_t row, const auto&) {
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

Extents extents_of(const Dataset& data, const ModelParameters& parameters) {
  return std::visit([&](const auto& own) { return extents_under(data, own); }, parameters);
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
template <class Table>
void lay_points_by_reading(Table& table, const Dataset& data, const Fitted& current, std::size_t channel) {
  const Evaluator evaluator(data, Resolution::coarse);
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
        left.push_back((measured[row] - predicted[row]) / data.experiments[s.experiment].noise[channel]);
      }
    }
  }
  const std::vector<double> points = curve_points(reading, left, table.x.size());
  std::copy(points.begin(), points.end(), table.x.begin());
  table.points = static_cast<int>(points.size());
}

/// How many further points, `spacing` apart, a table needs to reach `missing` beyond its end.
int points_beyond(double missing, double spacing) {
  return missing < 0.5 * spacing ? 0 : static_cast<int>(std::ceil(missing / spacing - 0.5));
}

/// Points from an end of a table on, to one that lies `missing` beyond it; where none is needed the end itself is moved.
/// What the table says at its end holds there until a fit knows better.
template <class Table>
void lay_beyond(Table& table, Extent extent) {
  const auto count = static_cast<std::size_t>(table.points);
  std::vector<double> x(table.x.begin(), table.x.begin() + table.points);
  std::vector<double> y(table.y.begin(), table.y.begin() + table.points);
  const double below = std::max(0.0, x.front() - extent.low);
  const double above = std::max(0.0, extent.high - x.back());
  int first = points_beyond(below, x[1] - x[0]);
  int last = points_beyond(above, x[count - 1] - x[count - 2]);
  const int room = static_cast<int>(table.x.size() - count);
  if (first + last > room) {
    first = std::min(first, static_cast<int>(std::lround(room * below / (below + above))));
    last = std::min(last, room - first);
  }
  const double low = x.front();
  const double high = x.back();
  if (first == 0) {
    x.front() -= below;
  }
  if (last == 0) {
    x.back() += above;
  }
  for (int i = 1; i <= first; ++i) {
    x.insert(x.begin(), low - below * i / first);
    y.insert(y.begin(), table.y.front());
  }
  for (int i = 1; i <= last; ++i) {
    x.push_back(high + above * i / last);
    y.push_back(table.y[count - 1]);
  }
  table.points = static_cast<int>(x.size());
  std::copy(x.begin(), x.end(), table.x.begin());
  std::copy(y.begin(), y.end(), table.y.begin());
}

}  // namespace

void lay_table(ModelParameters& parameters, const Candidate& candidate, const Dataset& data, const Fitted& current) {
  visit_table(parameters, candidate, [&]<class E>(const auto& field, auto& table) {
    if constexpr (std::is_same_v<E, model::UnlistedReading>) {
      lay_points_by_reading(table, data, current, static_cast<std::size_t>(candidate.option));
    } else {
      const auto now = current.parameters();
      lay_points(table, extents_of(data, now).of(E::site, field.x_name), field.x_name.ends_with("rate"));
    }
  });
}

Fitted reaching_over(const Dataset& data, const Fitted& fitted, const Candidate& candidate) {
  Fitted wide = fitted;
  const auto now = fitted.parameters();
  visit_table(wide.base, candidate, [&]<class E>(const auto& field, auto& table) {
    const auto is_own = [&](const FreeParameter& p) {
      return p.is_ordinate() && p.is_of_effect(candidate.effect) && p.address.field == field.y_name;
    };
    const auto first = std::ranges::find_if(wide.free, is_own);
    // A term's curve was laid over all rows.
    if (table.points < 2 || first == wide.free.end() || !candidate.choices.empty()) {
      return;
    }
    const std::vector<double> fitted_y = table_of(now, candidate)->y;
    std::copy(fitted_y.begin(), fitted_y.end(), table.y.begin());
    lay_beyond(table, extents_of(data, now).of(E::site, field.x_name));
    FreeParameter ordinate = *first;
    const auto at = first - wide.free.begin();
    const auto behind = std::find_if_not(first, wide.free.end(), is_own) - wide.free.begin();
    wide.free.erase(wide.free.begin() + at, wide.free.begin() + behind);
    wide.u.erase(wide.u.begin() + at, wide.u.begin() + behind);
    for (int i = 0; i < table.points; ++i) {
      ordinate.address.point = i;
      ordinate.key = ordinate.address.key();
      wide.free.insert(wide.free.begin() + at + i, ordinate);
      wide.u.insert(wide.u.begin() + at + i, ordinate.coordinate(table.y[static_cast<std::size_t>(i)]));
      ++ordinate.index;
    }
  });
  return wide;
}

}  // namespace hotfire::explain
