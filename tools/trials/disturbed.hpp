// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::trials {

/// A hammer blow on an engine whose actuator is locked [SD 2.2, eq. 8-10].
struct Hammer {
  double impulse = 20.0;  ///< angular momentum that the blow gives [N m s]
  double seconds = 4.0;
};

/// The engine's swing after a blow; channels `piston` and `engine`. The lock is a piston of the largest mass and damping
/// that a model file may give, on a valve without flow: it yields less than a thousandth of what the spring does. A `direct`
/// mass is hit as it is, and its channel is `position`. Throws UsageError for a topology without one axis.
Record hammer(const ModelFile& model, const Hammer& blow);

/// The same on a model of several axes: every actuator is locked, the engine is hit about `axis`. Returns the channels of
/// all axes. Throws UsageError for an axis the model has not.
Record hammer(const VehicleFile& model, const std::string& axis, const Hammer& blow);

/// How far a channel is from its first row: the swing about the engine's position before a blow. Throws FileError for a
/// record without it.
std::vector<double> swing(const Record& record, const std::string& channel);

/// A powered actuator that nobody commands, on a vehicle that is not quite still [SD 2.2, fig. 7].
struct Quiescence {
  double torque_density = 1.0;  ///< of the random torque on the engine, one-sided [(N m)^2 / Hz]
  double seconds = 240.0;
  unsigned seed = 1;
};

/// Piston and engine under a white torque, as independent impulses between rows. Throws UsageError for a topology other than
/// `simplex`.
Record quiescent(const ModelFile& model, const Quiescence& ambient);

/// The same on a model of several axes: a torque of its own, of one density, on every axis. Returns the channels of all
/// axes, and has `axis` only to refuse one that the model has not.
Record quiescent(const VehicleFile& model, const std::string& axis, const Quiescence& ambient);

}  // namespace hotfire::trials
