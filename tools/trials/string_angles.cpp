// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/string_angles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/files/text/error.hpp"

namespace hotfire::trials {

namespace {

std::array<const std::vector<double>*, 4> strings_of(const Record& record, const std::string& engine) {
  std::array<const std::vector<double>*, 4> strings{};
  for (std::size_t k = 0; k < strings.size(); ++k) {
    const std::string name = fmt::format("string{}{}{}", k + 1, engine.empty() ? "" : ".engine", engine);
    require_channel(record, name, "an engine's angles follow from its four strings");
    strings[k] = &record.find(name)->values;
  }
  return strings;
}

/// The mean over rows [from, to).
double mean_of(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t row = from; row < to; ++row) {
    sum += values[row];
  }
  return sum / static_cast<double>(to - from);
}

/// Puts angles into their channel. Returns the rms of what they differ by from what was there; negative if nothing was.
double replace(Record& record, const std::string& name, std::vector<double> angles) {
  const auto found = std::find_if(record.channels.begin(), record.channels.end(),
                                  [&name](const Channel& channel) { return channel.name == name; });
  if (found == record.channels.end()) {
    record.channels.push_back({name, "rad", std::move(angles)});
    return -1.0;
  }
  double square = 0.0;
  for (std::size_t row = 0; row < angles.size(); ++row) {
    square += (angles[row] - found->values[row]) * (angles[row] - found->values[row]);
  }
  found->values = std::move(angles);
  return std::sqrt(square / static_cast<double>(record.rows));
}

}  // namespace

std::vector<analysis::SettledAngles> settled_poses(const Record& record, const std::string& engine, double hold) {
  const auto strings = strings_of(record, engine);
  const Channel* pitch = record.find("command.pitch" + engine);
  const Channel* yaw = record.find("command.yaw" + engine);
  if (pitch == nullptr && yaw == nullptr) {
    require_channel(record, "command.pitch" + engine, "the commands give the poses");
  }
  const auto at = [](const Channel* command, std::size_t row) { return command != nullptr ? command->values[row] : 0.0; };
  const auto moves = [&](std::size_t row) {
    return row == record.rows || at(pitch, row) != at(pitch, row - 1) || at(yaw, row) != at(yaw, row - 1);
  };
  std::vector<analysis::SettledAngles> poses;
  std::size_t start = 0;
  for (std::size_t row = 1; row <= record.rows; ++row) {
    if (!moves(row)) {
      continue;
    }
    if (static_cast<double>(row - start) * record.period >= hold) {
      analysis::SettledAngles pose{{}, at(pitch, start), at(yaw, start)};
      for (std::size_t k = 0; k < strings.size(); ++k) {
        pose.lengths[k] = mean_of(*strings[k], row - std::max<std::size_t>(1, (row - start) / 4), row);
      }
      poses.push_back(pose);
    }
    start = row;
  }
  return poses;
}

StringAngles string_angles(const Record& record, const analysis::AngleCalibration& calibration, const std::string& engine) {
  const auto strings = strings_of(record, engine);
  std::vector<double> pitch(record.rows);
  std::vector<double> yaw(record.rows);
  for (std::size_t row = 0; row < record.rows; ++row) {
    std::array<double, 4> lengths{};
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      lengths[k] = (*strings[k])[row];
    }
    const std::array<double, 2> angles = calibration.angles(lengths);
    pitch[row] = angles[0];
    yaw[row] = angles[1];
  }
  StringAngles result{record};
  result.pitch = replace(result.record, "engine.pitch" + engine, std::move(pitch));
  result.yaw = replace(result.record, "engine.yaw" + engine, std::move(yaw));
  result.known = result.pitch >= 0.0 && result.yaw >= 0.0;
  return result;
}

}  // namespace hotfire::trials
