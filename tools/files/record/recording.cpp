// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/recording.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <numeric>
#include <span>
#include <utility>

#include "hal/recording/reader.hpp"
#include "model/vehicle.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/record/record_channels.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// A plant whose actuators are the axes of one model: a record is of all of them.
bool is_of_several_axes(const hal::RecordingHeader& header) {
  return header.topology == model::Taos<double>::topology || header.topology == model::Masv<double>::topology;
}

/// The actuators that a record is made of, from 0.
std::vector<std::size_t> chosen_actuators(const hal::RecordingHeader& header, const std::filesystem::path& path,
                                          unsigned actuator) {
  if (actuator > header.actuators) {
    throw FileError(fmt::format("{}: no actuator {}; allowed: 1 to {}", path.string(), actuator, header.actuators));
  }
  if (actuator > 0) {
    return {actuator - 1};
  }
  if (header.actuators > 1 && !is_of_several_axes(header)) {
    throw FileError(
        fmt::format("{}: {} actuators, and a record is of one; write the record of one with 'hotfire replay {} --actuator 1 "
                    "--csv actuator1.csv'",
                    path.string(), header.actuators, path.string()));
  }
  std::vector<std::size_t> all(header.actuators);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Rows in the making.
class RecordedRows {
 public:
  RecordedRows(const hal::RecordingHeader& header, const std::vector<std::size_t>& actuators)
      : begins_at_rest_(!is_of_several_axes(header)) {
    record_.period = static_cast<double>(header.period_ns) * 1e-9;
    const std::vector<std::string> axes = axis_names(static_cast<int>(header.actuators) / 2);
    for (const std::size_t actuator : actuators) {
      const std::string axis = actuators.size() > 1 ? "." + axes[actuator] : "";
      commands_.push_back(actuator);
      record_.channels.push_back({header.input.name + axis, header.input.unit, {}});
      for (std::size_t i = 0; i < header.channels.size(); ++i) {
        const hal::RecordedChannel& channel = header.channels[i];
        if (is_record_channel(channel.name)) {
          record_.channels.push_back({channel.name + axis, channel.unit, {}});
          readings_.emplace_back(record_.channels.size() - 1, actuator * header.channels.size() + i);
        }
      }
    }
  }

  void add(std::span<const double> commands, std::span<const double> readings) {
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      const std::size_t channel = i * (record_.channels.size() / commands_.size());
      record_.channels[channel].values.push_back(commands[commands_[i]]);
    }
    for (const auto& [channel, reading] : readings_) {
      record_.channels[channel].values.push_back(readings[reading]);
    }
    ++record_.rows;
  }

  /// Whether the first row is a period at rest before the first cycle. A plant of several axes has none: what holds it at
  /// rest is not at rest itself (a bearing vibrates, friction creeps), so that the period would change what follows.
  bool begins_at_rest() const { return begins_at_rest_; }
  Record& record() { return record_; }

 private:
  bool begins_at_rest_;
  std::vector<std::size_t> commands_;                          ///< place among a cycle's commands, by actuator
  std::vector<std::pair<std::size_t, std::size_t>> readings_;  ///< channel of the record, place among a cycle's readings
  Record record_;
};

[[noreturn]] void refuse_gap(const std::filesystem::path& path, const hal::RecordedCycle& cycle) {
  throw FileError(fmt::format(
      "{}: {} cycles were dropped and {} skipped before cycle {}, and a record has no gaps; write what lies before or after "
      "with 'hotfire replay {} --csv part.csv [--from {}]'",
      path.string(), cycle.dropped_before, cycle.skipped_before, cycle.head.cycle, path.string(), cycle.head.cycle));
}

void read_rows(hal::RecordingReader& reader, const std::filesystem::path& path, const RecordingPart& part,
               RecordedRows& rows) {
  const double period = rows.record().period;
  std::vector<double> before = reader.header().start;
  const std::vector<double> no_commands(reader.header().actuators, 0.0);
  bool begun = part.from == 0;
  if (begun && rows.begins_at_rest()) {
    rows.add(no_commands, before);
  }
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
    if (begun && cycle.dropped_before + cycle.skipped_before > 0) {
      if (!part.up_to_gap) {
        refuse_gap(path, cycle);
      }
      return;
    }
    if (rows.record().rows == kMostRows) {
      throw FileError(fmt::format("{}: more than {} rows; write a part with 'hotfire replay {} --from CYCLE --csv part.csv'",
                                  path.string(), kMostRows, path.string()));
    }
    if (begun) {
      if (rows.record().rows == 0) {
        rows.record().start = static_cast<double>(cycle.head.cycle + (rows.begins_at_rest() ? 1 : 0)) * period;
      }
      rows.add(cycle.commands, before);
    }
    // What the sensors read where a row begins is what the cycle before had sent.
    begun = begun || cycle.head.cycle >= part.from;
    before.assign(cycle.readings.begin(), cycle.readings.end());
  }
  if (reader.end() == hal::RecordingReader::End::damaged) {
    throw FileError(fmt::format("{}: damaged after {} cycles: a block within it has changed; copy it again", path.string(),
                                reader.cycles()));
  }
}

}  // namespace

bool is_recording(const std::filesystem::path& path) {
  std::array<char, hal::kRecordingMark.size()> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  return std::string_view(start.data(), start.size()) == hal::kRecordingMark;
}

Record load_recording(const std::filesystem::path& path, const RecordingPart& part) {
  hal::RecordingReader reader(path.string());
  if (!reader.error().empty()) {
    throw FileError(reader.error());
  }
  RecordedRows rows(reader.header(), chosen_actuators(reader.header(), path, part.actuator));
  read_rows(reader, path, part, rows);
  Record& record = rows.record();
  if (record.rows < 2) {
    throw FileError(fmt::format("{}: {} rows; allowed: at least 2", path.string(), record.rows));
  }
  record.path = path;
  record.name = path.filename().string();
  return std::move(record);
}

}  // namespace hotfire
