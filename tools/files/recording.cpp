#include "tools/files/recording.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "hal/recording/reader.hpp"
#include "tools/files/error.hpp"
#include "tools/files/record_channels.hpp"

namespace hotfire {

namespace {

/// The actuator asked for, from 0.
std::size_t chosen_actuator(const hal::RecordingHeader& header, const std::filesystem::path& path, unsigned actuator) {
  if (actuator > header.actuators) {
    throw FileError(fmt::format("{}: no actuator {}; allowed: 1 to {}", path.string(), actuator, header.actuators));
  }
  if (actuator == 0 && header.actuators > 1) {
    throw FileError(
        fmt::format("{}: {} actuators, and a record is of one; write the record of one with 'hotfire replay {} --actuator 1 "
                    "--csv actuator1.csv'",
                    path.string(), header.actuators, path.string()));
  }
  return actuator == 0 ? 0 : actuator - 1;
}

/// Rows in the making.
class Rows {
 public:
  Rows(const hal::RecordingHeader& header, std::size_t actuator) : actuator_(actuator) {
    record_.period = static_cast<double>(header.period_ns) * 1e-9;
    record_.channels.push_back({header.input.name, header.input.unit, {}});
    for (std::size_t i = 0; i < header.channels.size(); ++i) {
      const hal::RecordedChannel& channel = header.channels[i];
      if (is_record_channel(channel.name)) {
        record_.channels.push_back({channel.name, channel.unit, {}});
        places_.push_back(actuator * header.channels.size() + i);
      }
    }
  }

  void add(double command, std::span<const double> readings) {
    record_.channels.front().values.push_back(command);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      record_.channels[i + 1].values.push_back(readings[places_[i]]);
    }
    ++record_.rows;
  }

  std::size_t actuator() const { return actuator_; }
  Record& record() { return record_; }

 private:
  std::size_t actuator_;
  std::vector<std::size_t> places_;  ///< of the actuator's channels among the readings
  Record record_;
};

[[noreturn]] void refuse_gap(const std::filesystem::path& path, const hal::RecordedCycle& cycle) {
  throw FileError(fmt::format(
      "{}: {} cycles were dropped before cycle {}, and a record has no gaps; write what lies before or after with 'hotfire "
      "replay {} --csv part.csv [--from {}]'",
      path.string(), cycle.dropped_before, cycle.head.cycle, path.string(), cycle.head.cycle));
}

void read_rows(hal::RecordingReader& reader, const std::filesystem::path& path, const RecordingPart& part, Rows& rows) {
  const double period = rows.record().period;
  std::vector<double> before = reader.header().start;
  bool begun = part.from == 0;
  if (begun) {
    rows.add(0.0, before);
  }
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
    if (begun && cycle.dropped_before > 0) {
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
        rows.record().start = static_cast<double>(cycle.head.cycle + 1) * period;
      }
      rows.add(cycle.commands[rows.actuator()], before);
    }
    // What the sensors read where a row begins is what the cycle before had sent.
    begun = begun || cycle.head.cycle >= part.from;
    before.assign(cycle.readings.begin(), cycle.readings.end());
  }
  if (reader.end() == hal::RecordingReader::End::damaged) {
    throw FileError(fmt::format("{}: damaged after {} cycles: a block in its midst is not what was written; copy it again",
                                path.string(), reader.cycles()));
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
  Rows rows(reader.header(), chosen_actuator(reader.header(), path, part.actuator));
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
