// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/vehicle/vehicle_axes.hpp"

namespace hotfire::explain {

/// Runs one kind of vehicle on all records: every member of `run` but the zeros. False if it runs away.
bool run_vehicle_of(const TaosParameters& parameters, const VehicleAxes& vehicle, unsigned threads, CoupledRun& run);
bool run_vehicle_of(const MasvParameters& parameters, const VehicleAxes& vehicle, unsigned threads, CoupledRun& run);

}  // namespace hotfire::explain
