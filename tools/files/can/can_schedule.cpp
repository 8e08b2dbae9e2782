// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/can_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "hal/schedule/frame_time.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

namespace {

constexpr double kLowestBitRate = 10e3;
constexpr double kHighestBitRate = 1e6;
constexpr double kHighestDataBitRate = 8e6;
constexpr double kShortestScheduledPeriod = 250e-6;
constexpr double kLongestScheduledPeriod = 10.0;

const toml::node& required(const TomlSource& source, const toml::table& table, const std::string& where,
                           std::string_view key, std::string_view problem) {
  const toml::node* found = table.get(key);
  if (found == nullptr) {
    source.refuse_missing(table, where + std::string{key}, problem);
  }
  return *found;
}

double number_within(const TomlSource& source, const toml::node& node, const std::string& key, const std::string& unit,
                     double lowest, double highest) {
  const double value = source.number(node, key, unit);
  if (!(value >= lowest && value <= highest)) {
    source.refuse(node, key, fmt::format("allowed: {} to {} {}", lowest, highest, unit));
  }
  return value;
}

void read_bus(const TomlSource& source, CanSchedule& schedule) {
  const toml::table& bus = source.table(required(source, source.root(), "", "bus", "missing"), "bus");
  refuse_unknown_keys(source, bus, "bus.", {"bit_rate", "data_bit_rate"});
  schedule.bit_rate = number_within(source, required(source, bus, "bus.", "bit_rate", "missing; 1e6 for 1 Mbit/s"),
                                    "bus.bit_rate", "1/s", kLowestBitRate, kHighestBitRate);
  if (const toml::node* rate = bus.get("data_bit_rate")) {
    schedule.data_bit_rate =
        number_within(source, *rate, "bus.data_bit_rate", "1/s", schedule.bit_rate, kHighestDataBitRate);
  }
}

double longest(const CanMessage& message, const CanSchedule& schedule) {
  return message.fd ? hal::longest_fd_frame(message.length, schedule.bit_rate, schedule.data_bit_rate)
                    : hal::longest_classic_frame(message.length, schedule.bit_rate);
}

void read_frames(const TomlSource& source, const CanMap& map, CanSchedule& schedule) {
  const toml::table& frames = source.table(required(source, source.root(), "", "frames", "missing"), "frames");
  std::vector<std::string_view> names;
  for (const CanMessage& message : map.messages) {
    names.push_back(message.name);
  }
  refuse_unknown_keys(source, frames, "frames.", names);
  for (const CanMessage& message : map.messages) {
    const toml::node* node = frames.get(message.name);
    if (node == nullptr) {
      continue;
    }
    if (message.fd && schedule.data_bit_rate == 0.0) {
      source.refuse(*node, "frames." + message.name, "an FD frame; allowed: classic frames, or give bus.data_bit_rate");
    }
    const double period =
        number_within(source, *node, "frames." + message.name, "s", kShortestScheduledPeriod, kLongestScheduledPeriod);
    schedule.frames.push_back({message.name, period, longest(message, schedule)});
  }
  if (schedule.frames.empty()) {
    source.refuse_missing(frames, "frames", "no frame; write for example SERVOVALVE_COMMAND = \"1 ms\"");
  }
}

void require_fit(const CanSchedule& schedule) {
  const double load = schedule.load();
  if (load <= hal::kLargestBusLoad) {
    return;
  }
  std::vector<ScheduledFrame> frames = schedule.frames;
  std::sort(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.load() > b.load(); });
  std::string most;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, frames.size()); ++i) {
    most += fmt::format("{}{} {:.1f} % ({:.0f} us every {:g} ms)", i == 0 ? "" : ", ", frames[i].message,
                        100.0 * frames[i].load(), 1e6 * frames[i].longest, 1e3 * frames[i].period);
  }
  throw FileError(
      fmt::format("{}: worst-case bus load {:.1f} %; allowed: {:.0f} %. Most is taken by {}. Longer periods, a "
                  "higher bit rate or FD frames lower it",
                  schedule.path.string(), 100.0 * load, 100.0 * hal::kLargestBusLoad, most));
}

}  // namespace

double CanSchedule::load() const {
  return std::accumulate(frames.begin(), frames.end(), 0.0,
                         [](double sum, const ScheduledFrame& frame) { return sum + frame.load(); });
}

bool is_can_schedule(const std::filesystem::path& path) { return TomlSource(path).root().contains("bus"); }

CanSchedule load_can_schedule(const std::filesystem::path& path, const CanMap& map) {
  const TomlSource source(path);
  refuse_unknown_keys(source, source.root(), "", {"schema", "bus", "frames"});
  source.require_schema();
  CanSchedule schedule;
  schedule.path = path;
  read_bus(source, schedule);
  read_frames(source, map, schedule);
  require_fit(schedule);
  return schedule;
}

}  // namespace hotfire
