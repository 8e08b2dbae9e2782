// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/batch/side_by_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "hal/arithmetic/denormals.hpp"
#include "model/keys.hpp"
#include "model/simplex.hpp"
#include "tools/simulate/batch/set_lane.hpp"
#include "tools/simulate/open_loop.hpp"

namespace hotfire {

namespace {

using Axis = model::Simplex<double>;
using Side = model::Lanes<kSideBySide>;
using AxesSideBySide = model::Simplex<Side, ListedEffects<Axis::Effects>>;
using Readings = std::array<Side, Axis::channels.size()>;

/// Below this many runs, one after the other takes no longer: a register costs about as much as a run alone, and the lanes
/// of all runs fill as many registers.
constexpr std::size_t kFewest = kSideBySide / model::kLanesOfRegister + 1;

/// What runs side by side have in common.
struct Likeness {
  double period = 0.0;
  std::size_t rows = 0;
  int steps = 0;  ///< of the plant, in a row
  bool has_torque = false;
  std::array<bool, Axis::Effects::size> active{};
  std::vector<int> choices;  ///< of every active effect: its law or channel, and the points of its tables

  bool operator<(const Likeness& other) const {
    return std::tie(period, rows, steps, has_torque, active, choices) <
           std::tie(other.period, other.rows, other.steps, other.has_torque, other.active, other.choices);
  }
};

bool has_unlisted_effect(const SimplexParameters& parameters) {
  bool any = false;
  Axis::Effects::for_each(
      [&]<class E, std::size_t I>() { any = any || (!detail::is_listed<E>() && parameters.effects.active[I]); });
  return any;
}

bool has_units_of_one_motion(const Record& inputs) {
  try {
    require_units_of_one_motion(inputs);
    return true;
  } catch (const FileError&) {
    return false;
  }
}

/// True if `simulate` takes the run as it is. What it refuses runs alone, and is refused there.
bool runs_as_it_is(const OpenLoopRun& run) {
  const auto* parameters = std::get_if<SimplexParameters>(&run.model->parameters);
  return parameters != nullptr && run.inputs->find(std::string(Axis::input_channel)) != nullptr && run.inputs->rows > 0 &&
         !has_unlisted_effect(*parameters) && has_units_of_one_motion(*run.inputs);
}

Likeness likeness_of(const SimplexParameters& parameters, const Record& inputs) {
  Likeness own{inputs.period,
               inputs.rows,
               steps_in_row<Axis>(parameters, inputs.period),
               inputs.find("torque") != nullptr,
               parameters.effects.active,
               {}};
  model::visit_effects(parameters, [&]<class E>(std::size_t effect, const auto& values) {
    if (!parameters.effects.active[effect]) {
      return;
    }
    own.choices.push_back(values.option);
    if constexpr (requires { values.tables(); }) {
      for (const auto& table : values.tables()) {
        own.choices.push_back(model::is_used(table.options, values.option) ? (values.*table.member).points : 0);
      }
    }
  });
  return own;
}

/// The inputs of a row in their lanes.
class Inputs {
 public:
  Inputs(std::span<const OpenLoopRun> runs, int steps) {
    for (const OpenLoopRun& run : runs) {
      commands_.push_back(&run.inputs->find(std::string(Axis::input_channel))->values);
      if (const Channel* torque = run.inputs->find("torque")) {
        torques_.emplace_back(torque->values, steps, Excitation::Between::interpolated);
      }
    }
  }

  bool has_torque() const { return !torques_.empty(); }
  Side command(std::size_t row) const {
    return in_lanes([&](std::size_t run) { return (*commands_[run])[row]; });
  }
  /// Against the engine, mean over a plant step of a row.
  Side torque_against(std::size_t row, int step) const {
    return in_lanes([&](std::size_t run) { return -torques_[run](row, step); });
  }

 private:
  /// A lane without a run repeats the first one.
  template <class F>
  Side in_lanes(F&& f) const {
    return Side::by_lane([&](int lane) {
      const auto run = static_cast<std::size_t>(lane);
      return f(run < commands_.size() ? run : 0);
    });
  }

  std::vector<const std::vector<double>*> commands_;
  std::vector<Excitation> torques_;
};

void step(const AxesSideBySide& plant, AxesSideBySide::State& state, const Inputs& inputs, const Side& command,
          std::size_t row, int part) {
  if (!inputs.has_torque()) {
    plant.step(state, command);
    return;
  }
  const Side torque_against = inputs.torque_against(row, part);
  const Side& arm = plant.parameters().actuator.moment_arm;
  plant.step(state, command, [&](const Side&) { return model::Coupling<Side>{Side(0.0), arm, torque_against}; });
}

/// Takes the readings of a row to the records of the runs that have not run away.
class Outcomes {
 public:
  explicit Outcomes(std::span<const OpenLoopRun> runs) : runs_(runs), outcomes_(runs.size()) {
    for (std::size_t run = 0; run < runs.size(); ++run) {
      const Record& inputs = *runs[run].inputs;
      outcomes_[run].record = beside(inputs, *inputs.find(std::string(Axis::input_channel)));
      for (std::size_t c = 0; c < Axis::channels.size(); ++c) {
        outcomes_[run].record.channels.push_back({std::string(Axis::channels[c]), std::string(Axis::channel_units[c]), {}});
        outcomes_[run].record.channels.back().values.reserve(inputs.rows);
      }
    }
  }

  void keep(std::size_t row, const Readings& readings) {
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      RunOutcome& own = outcomes_[run];
      if (own.failure) {
        continue;
      }
      const int lane = static_cast<int>(run);
      if (!std::all_of(readings.begin(), readings.end(), [&](const Side& all) { return !is_runaway(all[lane]); })) {
        own.failure = std::make_exception_ptr(runaway_error(*runs_[run].inputs, row, Axis::input_channel));
        continue;
      }
      for (std::size_t c = 0; c < readings.size(); ++c) {
        own.record.channels[c + 1].values.push_back(readings[c][lane]);
      }
    }
  }

  std::vector<RunOutcome> taken() { return std::move(outcomes_); }

 private:
  std::span<const OpenLoopRun> runs_;
  std::vector<RunOutcome> outcomes_;
};

}  // namespace

std::vector<std::vector<std::size_t>> groups_side_by_side(std::span<const OpenLoopRun> runs, unsigned threads) {
  std::vector<std::vector<std::size_t>> groups;
  std::map<Likeness, std::vector<std::size_t>> alike;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (runs_as_it_is(runs[run])) {
      alike[likeness_of(std::get<SimplexParameters>(runs[run].model->parameters), *runs[run].inputs)].push_back(run);
    } else {
      groups.push_back({run});
    }
  }
  for (const auto& [likeness, members] : alike) {
    constexpr std::size_t kMost = kSideBySide;
    // Its share of the threads, rounded up.
    const std::size_t own_threads = (std::max(threads, 1U) * members.size() + runs.size() - 1) / runs.size();
    const std::size_t parts = std::max((members.size() + kMost - 1) / kMost, own_threads);
    const std::size_t together = (members.size() + parts - 1) / parts;
    const std::size_t size = together < kFewest ? 1 : together;
    for (std::size_t first = 0; first < members.size(); first += size) {
      const auto begin = members.begin() + static_cast<std::ptrdiff_t>(first);
      groups.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(std::min(size, members.size() - first)));
    }
  }
  return groups;
}

std::vector<RunOutcome> simulate_side_by_side(std::span<const OpenLoopRun> runs) {
  const Record& first_inputs = *runs.front().inputs;
  const auto parameters_of = [](const OpenLoopRun& run) -> const SimplexParameters& {
    return std::get<SimplexParameters>(run.model->parameters);
  };
  const int steps = steps_in_row<Axis>(parameters_of(runs.front()), first_inputs.period);
  const double h = first_inputs.period / steps;
  // With the memories of delays a state in lanes has 200 KiB.
  const auto parameters = std::make_unique<AxesSideBySide::Parameters>();
  const auto state = std::make_unique<AxesSideBySide::State>();
  for (int lane = 0; lane < kSideBySide; ++lane) {
    const auto place = static_cast<std::size_t>(lane);
    const OpenLoopRun& run = runs[place < runs.size() ? place : 0];
    const auto plant = std::make_unique<Axis>(parameters_of(run), h);
    set_lane(lane, parameters_of(run), *parameters);
    set_lane(lane, start_of(*plant, *run.inputs), *state);
  }
  const AxesSideBySide plant(*parameters, h);
  const Inputs inputs(runs, steps);
  Outcomes outcomes(runs);
  const hal::FlushDenormals flush;
  for (std::size_t row = 0; row < first_inputs.rows; ++row) {
    outcomes.keep(row, AxesSideBySide::measured(*state));
    const Side command = inputs.command(row);
    for (int part = 0; part < steps; ++part) {
      step(plant, *state, inputs, command, row, part);
    }
  }
  return outcomes.taken();
}

}  // namespace hotfire
