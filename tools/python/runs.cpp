// SPDX-License-Identifier: Apache-2.0
#include "tools/python/runs.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <exception>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tools/explain/fit/parallel.hpp"
#include "tools/files/text/error.hpp"
#include "tools/python/models.hpp"
#include "tools/python/vehicle_gradients.hpp"
#include "tools/simulate/batch/side_by_side.hpp"
#include "tools/simulate/gradients.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/fine_sweep.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/results_json.hpp"
#include "tools/trials/sweep.hpp"

namespace py = pybind11;

namespace hotfire::python {

namespace {

struct RunOptions {
  std::size_t fit_start = 0;
  unsigned seed = 1;
};

Record run(const Model& model, const Record& inputs, const RunOptions& options) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    if (options.fit_start > 0) {
      throw UsageError(
          "fit_start is for a direct model; hydraulic axes start in the steady state under their first commands");
    }
    return simulate(*vehicle, inputs, {.seed = options.seed});
  }
  return simulate(std::get<ModelFile>(model.file), inputs, options.fit_start);
}

using Runs = std::vector<std::pair<const Model*, const Record*>>;

/// The places of the runs that one task does: alone, or several side by side.
std::vector<std::vector<std::size_t>> tasks_of(const Runs& runs, const RunOptions& options, unsigned threads) {
  std::vector<std::vector<std::size_t>> tasks;
  std::vector<OpenLoopRun> of_one_axis;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto* file = std::get_if<ModelFile>(&runs[i].first->file);
    if (file == nullptr || options.fit_start > 0) {
      tasks.push_back({i});
    } else {
      of_one_axis.push_back({file, runs[i].second});
      places.push_back(i);
    }
  }
  for (std::vector<std::size_t>& group : groups_side_by_side(of_one_axis, threads)) {
    for (std::size_t& member : group) {
      member = places[member];
    }
    tasks.push_back(std::move(group));
  }
  return tasks;
}

/// Several runs on several threads; the first that fails, in the order of the runs, is what fails.
std::vector<Record> run_many(const Runs& runs, const RunOptions& options, unsigned threads) {
  std::vector<RunOutcome> outcomes(runs.size());
  const auto tasks = tasks_of(runs, options, threads);
  explain::parallel_for(tasks.size(), threads, [&](std::size_t t) {
    const std::vector<std::size_t>& members = tasks[t];
    try {
      if (members.size() == 1) {
        const auto& [model, inputs] = runs[members.front()];
        outcomes[members.front()].record = run(*model, *inputs, options);
        return;
      }
      std::vector<OpenLoopRun> together;
      together.reserve(members.size());
      for (const std::size_t member : members) {
        together.push_back({&std::get<ModelFile>(runs[member].first->file), runs[member].second});
      }
      std::vector<RunOutcome> own = simulate_side_by_side(together);
      for (std::size_t i = 0; i < members.size(); ++i) {
        outcomes[members[i]] = std::move(own[i]);
      }
    } catch (...) {
      outcomes[members.front()].failure = std::current_exception();
    }
  });
  std::vector<Record> records;
  for (RunOutcome& outcome : outcomes) {
    if (outcome.failure) {
      std::rethrow_exception(outcome.failure);
    }
    records.push_back(std::move(outcome.record));
  }
  return records;
}

/// The derivatives by channel, as arrays of rows and keys.
py::dict gradients_of(const Model& model, const Record& inputs, const std::vector<std::string>& keys, unsigned threads) {
  std::vector<ChannelSlopes> channels;
  {
    const py::gil_scoped_release released;
    require_acting(model, keys);
    const auto* vehicle = std::get_if<VehicleFile>(&model.file);
    channels = vehicle != nullptr ? vehicle_gradients(*vehicle, inputs, keys, threads)
                                  : gradients(std::get<ModelFile>(model.file), inputs, keys);
  }
  py::dict result;
  for (const ChannelSlopes& channel : channels) {
    py::array_t<double> slopes({inputs.rows, keys.size()});
    std::copy(channel.slopes.begin(), channel.slopes.end(), slopes.mutable_data());
    result[py::str(channel.name)] = std::move(slopes);
  }
  return result;
}

/// The profile of a sweep by sines: amplitudes [rad], frequencies [Hz].
struct Sines {
  std::vector<double> amplitudes;
  double from;
  double to;
  int count;
  bool coarse;
};

struct Sweep {
  Record record;
  std::string results;  ///< as `hotfire sweep --json` prints them
};

/// The command of an axis, on a model.
Record run_command(const Model& model, const std::string& axis, std::vector<double> command) {
  return run(model, trials::command_record(std::move(command), trials::channel_of("command", axis)), {});
}

trials::LeastDwell dwell_of(const Model& model, const Sines& sines) {
  if (sines.coarse) {
    return [](double) { return trials::kShortestDwell; };
  }
  const auto* vehicle = std::get_if<VehicleFile>(&model.file);
  return vehicle != nullptr ? trials::settled_dwell(*vehicle, sines.from, sines.to)
                            : trials::settled_dwell(std::get<ModelFile>(model.file));
}

double moment_arm(const Model& model, const std::string& axis) {
  const auto* vehicle = std::get_if<VehicleFile>(&model.file);
  return vehicle != nullptr ? moment_arm_of(*vehicle, axis) : moment_arm_of(std::get<ModelFile>(model.file));
}

/// `hotfire sweep --profile sines`.
Sweep sweep(const Model& model, const Sines& sines, trials::SweepGoal goal) {
  std::vector<trials::SineBand> bands;
  bands.reserve(sines.amplitudes.size());
  for (const double amplitude : sines.amplitudes) {
    bands.push_back({amplitude, trials::spaced(sines.from, sines.to, sines.count)});
  }
  goal.moment_arm = moment_arm(model, goal.axis);
  const trials::LeastDwell dwell = dwell_of(model, sines);
  Record record = run_command(model, goal.axis, trials::stepped_sines(bands, dwell));
  if (!sines.coarse) {
    record = run_command(model, goal.axis, trials::fine_sines(bands, trials::analyse_sweep(record, goal), dwell));
  }
  std::string results = trials::to_json(trials::analyse_sweep(record, goal)).dump();
  return {std::move(record), std::move(results)};
}

}  // namespace

void add_runs(py::module_& module) {
  module.def(
      "simulate",
      [](const Model& model, const Record& inputs, std::size_t fit_start, unsigned seed) {
        const py::gil_scoped_release released;
        return run(model, inputs, {fit_start, seed});
      },
      py::arg("model"), py::arg("inputs"), py::arg("fit_start"), py::arg("seed"));
  module.def(
      "simulate_many",
      [](const Runs& runs, std::size_t fit_start, unsigned seed, unsigned threads) {
        const py::gil_scoped_release released;
        return run_many(runs, {fit_start, seed}, threads);
      },
      py::arg("runs"), py::arg("fit_start"), py::arg("seed"), py::arg("threads"));
  module.def("acting_keys", &acting_keys, py::arg("model"));
  module.def("gradients", &gradients_of, py::arg("model"), py::arg("inputs"), py::arg("keys"), py::arg("threads"));
  module.def(
      "sweep",
      [](const Model& model, const std::vector<double>& amplitudes, double from, double to, int count, bool coarse,
         const std::string& axis, double lowest, double highest) {
        const py::gil_scoped_release released;
        Sweep swept =
            sweep(model, {amplitudes, from, to, count, coarse}, {.axis = axis, .lowest = lowest, .highest = highest});
        return std::make_pair(std::move(swept.record), std::move(swept.results));
      },
      py::arg("model"), py::arg("amplitudes"), py::arg("from_"), py::arg("to"), py::arg("count"), py::arg("coarse"),
      py::arg("axis"), py::arg("lowest"), py::arg("highest"));
  module.def(
      "analyse_sweep",
      [](const Record& record, const std::string& axis, double moment_arm, double lowest, double highest, double segment) {
        const py::gil_scoped_release released;
        return trials::to_json(trials::analyse_sweep(record, {axis, moment_arm, lowest, highest, segment})).dump();
      },
      py::arg("record"), py::arg("axis"), py::arg("moment_arm"), py::arg("lowest"), py::arg("highest"), py::arg("segment"));
}

}  // namespace hotfire::python
