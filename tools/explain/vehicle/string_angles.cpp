// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/vehicle/string_angles.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tools/explain/words/refusals.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

using Strings = VehicleSensors::Strings;
using Lengths = Eigen::Matrix<double, Strings::kStrings, 1>;

Lengths lengths_at(const Strings& strings, const Eigen::Vector2d& angles) {
  const auto lengths = strings.lengths(angles(0), angles(1), model::Vector3<double>::Zero());
  return Eigen::Map<const Lengths>(lengths.data());
}

/// Gauss-Newton from `angles`: lengths are nearly linear in the angles, so that the third step is below rounding.
Eigen::Vector2d angles_at(const Strings& strings, const Lengths& measured, Eigen::Vector2d angles) {
  constexpr int kSteps = 3;
  constexpr double kDifference = 1e-5;  // rad: its square is below rounding
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, Strings::kStrings, 2> slopes;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d aside = kDifference * Eigen::Vector2d::Unit(axis);
      slopes.col(axis) = (lengths_at(strings, angles + aside) - lengths_at(strings, angles - aside)) / (2.0 * kDifference);
    }
    const Lengths left = measured - lengths_at(strings, angles);
    angles += (slopes.transpose() * slopes).ldlt().solve(slopes.transpose() * left);
  }
  return angles;
}

/// Angles of an engine in every row.
std::array<std::vector<double>, 2> angles_of(const Strings& strings, const std::array<const Channel*, 4>& lengths) {
  std::array<std::vector<double>, 2> angles;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (std::size_t row = 0; row < lengths[0]->values.size(); ++row) {
    Lengths measured;
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      measured(static_cast<Eigen::Index>(k)) = lengths[k]->values[row];
    }
    const bool is_whole = measured.allFinite();
    if (is_whole) {
      last = angles_at(strings, measured, last);
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      angles[axis].push_back(is_whole ? last(static_cast<Eigen::Index>(axis)) : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return angles;
}

}  // namespace

Record with_string_angles(const VehicleFile& vehicle, Record record) {
  const auto engines = vehicle.sensors.strings.size();
  const std::vector<std::string> axes = axis_names(static_cast<int>(vehicle.axes.size() / 2));
  for (std::size_t engine = 0; engine < engines; ++engine) {
    const std::string suffix = engines == 1 ? "" : ".engine" + std::to_string(engine + 1);
    std::array<std::string, 4> names;
    std::array<const Channel*, 4> lengths{};
    for (std::size_t k = 0; k < names.size(); ++k) {
      names[k] = "string" + std::to_string(k + 1) + suffix;
      lengths[k] = record.find(names[k]);
    }
    const bool has_engine =
        record.find("engine." + axes[2 * engine]) != nullptr || record.find("engine." + axes[2 * engine + 1]) != nullptr;
    if (has_engine || std::ranges::find(lengths, nullptr) != lengths.end()) {
      continue;
    }
    if (vehicle.sensors.string.lag > 0.0) {
      throw FileError(words::unsupported(vehicle.path.string(), words::Unsupported::string_lag));
    }
    auto angles = angles_of(Strings(vehicle.sensors.strings[engine]), lengths);
    std::erase_if(record.channels,
                  [&](const Channel& channel) { return std::ranges::find(names, channel.name) != names.end(); });
    for (std::size_t axis = 0; axis < 2; ++axis) {
      record.channels.push_back({"engine." + axes[2 * engine + axis], "rad", std::move(angles[axis])});
    }
  }
  return record;
}

}  // namespace hotfire::explain
