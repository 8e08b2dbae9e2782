#pragma once

#include <vector>

#include "model/vehicle.hpp"
#include "tools/simulate/normal.hpp"
#include "tools/structure/vehicle_sensors.hpp"

namespace hotfire {

/// What the sensors of a model of several axes read of its states, row by row. A string sees its engine's angles, the
/// bearing give way, and the structure carry its anchor away; none of them can it tell from the others.
template <class Plant>
class VehicleReadings {
 public:
  /// Draws the placement errors; noise comes from the same `seed`. At rest in `start`.
  VehicleReadings(const VehicleSensors& sensors, const typename Plant::State& start, unsigned seed);

  /// Reads a state, `h` seconds after the last one.
  void read(const typename Plant::State& state, double h);

  const std::vector<double>& pistons() const { return pistons_; }  ///< [m]
  const std::vector<double>& strings() const { return strings_; }  ///< change from zero angles, engine by engine [m]

 private:
  using Strings = VehicleSensors::Strings;

  std::vector<double> lengths(const typename Plant::State& state) const;

  VehicleSensors sensors_;
  Normal normal_;
  std::vector<Strings> geometry_;  ///< with anchors where they are
  std::vector<VehicleSensors::Readout::State> piston_lag_;
  std::vector<VehicleSensors::Readout::State> string_lag_;
  std::vector<double> pistons_;
  std::vector<double> strings_;
};

}  // namespace hotfire
