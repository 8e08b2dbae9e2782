// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::explain {

using VehicleParameters = std::variant<TaosParameters, MasvParameters>;

/// The plant of one of these.
template <class Parameters>
using VehicleOf = std::conditional_t<std::is_same_v<Parameters, TaosParameters>, model::Taos<double>, model::Masv<double>>;

/// One axis of a vehicle, as a model and records of one axis.
struct AxisOfVehicle {
  std::string name;  ///< "pitch"; of several engines "pitch2"
  ModelFile model;
  std::vector<Record> records;              ///< channels "command", "piston" ...
  std::vector<std::vector<double>> inputs;  ///< the command by record; zero where a record has none
  bool measured = false;                    ///< false: its records have no channel of the model, and it has no data
  Dataset data;
};

/// The axes of a vehicle, and what acts on its engines beside their commands.
struct VehicleAxes {
  std::vector<AxisOfVehicle> axes;
  std::vector<Record> disturbances;  ///< torques, forces, vibrations and thrusts, by record

  /// An axis that is measured.
  const AxisOfVehicle& first_measured() const;
};

/// Splits a model and its records into the axes. Throws FileError for what the finder does not take (explain.hpp), for a
/// record without any command, and for one without the channels of an axis that another record has.
VehicleAxes axes_of(const VehicleFile& vehicle, const std::vector<Record>& records,
                    const std::vector<Exclusion>& exclusions);

/// What the model of the whole vehicle says of every record, by axis.
struct CoupledRun {
  std::vector<Prediction> prediction;               ///< by record, channel, row; with the zeros of a measured axis
  std::vector<Zeros> zeros;                         ///< of a measured axis
  std::vector<std::vector<OtherAxis>> motion;       ///< of each axis, by record
  std::vector<std::vector<RestOfVehicle>> vehicle;  ///< around each axis, by record
};

/// Runs the model of all axes on all records, under the disturbances that they measured. Nothing if it runs away.
std::optional<CoupledRun> run_coupled(const VehicleParameters& parameters, const VehicleAxes& vehicle, unsigned threads);

/// Puts each axis beside the motion of the other one of its engine: as simulated, and corrected by what the other's measured
/// angle says below about 12 Hz, so that it is right whatever is missing in the other axis. What the rest of the vehicle
/// does to it is as simulated.
void put_beside(const CoupledRun& run, VehicleAxes& vehicle);

}  // namespace hotfire::explain
