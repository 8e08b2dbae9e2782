// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/engine/gimbal.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// What a record may have beside its commands that acts on the engines of a plant.
enum class DisturbanceKind : std::uint8_t { torque, force, vibration, thrust };

/// One channel of that kind.
struct Disturbance {
  DisturbanceKind kind;
  std::size_t place;  ///< torque, vibration: axis; force: 3 x engine + direction; thrust: engine; all from 0
  const Channel* channel;
};

/// The channels `kind` of places such as axes, by place; null where the record has none. Throws FileError for a channel of a
/// place that the model has not.
std::vector<const Channel*> channels_by_place(const Record& inputs, std::string_view kind,
                                              const std::vector<std::string>& places);

/// The disturbances in a record for a model of several axes (simulate_vehicle.hpp lists the channels), of which `gimbals`
/// are the bearings by engine. Throws FileError for an axis, a direction or an engine that the model has not, a thrust below
/// zero, and a vibration of a bearing whose law has it already.
std::vector<Disturbance> disturbances_of(const Record& inputs, std::span<const model::GimbalParameters<double>> gimbals);

/// The disturbance in a record for a hydraulic axis alone: its `torque`, if it has one.
std::vector<Disturbance> disturbances_of(const Record& inputs);

/// The disturbances as lines of a plant image, which plays them row by row from its first cycle. Throws FileError if there
/// are none, if they have more values than an image has room for, or for a value outside the bounds of its kind, with its
/// line.
std::string disturbances_image_text(const Record& inputs, const std::vector<Disturbance>& disturbances);

}  // namespace hotfire
