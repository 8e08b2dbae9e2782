// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::explain {

/// One of the two axes of an engine, as a model and records of one axis.
struct AxisOfTwo {
  std::string name;  ///< "pitch"
  ModelFile model;
  std::vector<Record> records;              ///< channels "command", "piston" ...
  std::vector<std::vector<double>> inputs;  ///< the command by record; zero where a record has none
  std::vector<std::vector<double>> torque;  ///< measured, on the engine, by record [N m]; empty where a record has none
  bool measured = false;                    ///< false: its records have no channel of the model, and it has no data
  Dataset data;
};
using TwoAxes = std::array<AxisOfTwo, 2>;

/// Splits a model and its records into the axes. Throws FileError for what the finder does not take (explain.hpp), for a
/// record without any command, and for one without the channels of an axis that another record has.
TwoAxes axes_of(const VehicleFile& vehicle, const std::vector<Record>& records, const std::vector<Exclusion>& exclusions);

/// What the model of both axes together says of every record, by axis.
struct CoupledRun {
  std::array<Prediction, 2> prediction;          ///< by record, channel, row; with the zeros of a measured axis
  std::array<Zeros, 2> zeros;                    ///< of a measured axis
  std::array<std::vector<OtherAxis>, 2> motion;  ///< of each axis, by record
};

/// Runs the model of both axes on all records, under the torques that they measured. Nothing if it runs away.
std::optional<CoupledRun> run_coupled(const TaosParameters& parameters, const TwoAxes& axes, unsigned threads);

/// Puts each axis beside the motion of the other: as simulated, and corrected by what the other's measured angle says below
/// about 12 Hz, so that it is right whatever is missing in the other axis.
void put_beside(const CoupledRun& run, TwoAxes& axes);

}  // namespace hotfire::explain
