// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "tools/files/can/candump.hpp"
#include "tools/files/can/candump_frame.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

/// Frames of a record, row by row.
class LogWriter {
 public:
  LogWriter(const Record& record, const CanMap& map) : record_(record), map_(map) {}

  /// Appends a frame of this message to `text`, with these channels' values of a row behind its check and counter.
  void append(std::string& text, const std::string& name, std::size_t row, double time,
              std::initializer_list<std::pair<const char*, const std::vector<double>*>> values) {
    const CanMessage& message = map_.at(name);
    CandumpFrame frame{time, "can0", message.id, true, message.fd, std::vector<std::uint8_t>(message.length)};
    for (const auto& [signal_name, channel] : values) {
      const CanSignal& signal = message.at(signal_name);
      const double value = (*channel)[row];
      if (!signal.can_carry(value)) {
        throw FileError(fmt::format("{}: row {}: {} = {} {} cannot be sent; allowed: {:g} to {:g}", record_.path.string(),
                                    row + 1, signal_name, value, signal.unit, signal.physical(signal.lowest_raw),
                                    signal.physical(signal.highest_raw)));
      }
      signal.write(signal.nearest_raw(value), frame.data);
    }
    message.counter().write(counters_[message.id]++, frame.data);
    message.seal(frame.data);
    text += candump_line(frame);
  }

 private:
  const Record& record_;
  const CanMap& map_;
  std::map<std::uint32_t, std::uint8_t> counters_;
};

/// The servovalve's current of every row.
std::vector<double> currents(const Record& record, const CandumpOptions& options) {
  if (const Channel* current = record.find("current")) {
    return current->values;
  }
  if (options.command_per_current == 0.0) {
    require_channel(record, "current", "a CAN log carries currents; give the command that a current represents (rad/A)");
  }
  require_channel(record, "command", "a CAN log carries the commands of the plant");
  std::vector<double> values = record.find("command")->values;
  for (double& value : values) {
    value /= options.command_per_current;
  }
  return values;
}

}  // namespace

void write_candump(const Record& record, const std::filesystem::path& path, const CandumpOptions& options,
                   const CanMap& map) {
  if (options.actuator < 1 || options.actuator > 2) {
    throw UsageError(fmt::format("actuator {}; a log is written in the classic layout, allowed: 1, 2", options.actuator));
  }
  require_channel(record, "piston", "a CAN log carries the readings of the plant's potentiometers");
  const std::vector<double> current = currents(record, options);
  const std::vector<double>& piston = record.find("piston")->values;
  const Channel* const pressure = record.find("load_pressure");
  const std::string pressure_signal = fmt::format("load_pressure_{}", options.actuator);
  std::array<const Channel*, 4> strings{record.find("string1"), record.find("string2"), record.find("string3"),
                                        record.find("string4")};
  const bool with_strings = std::find(strings.begin(), strings.end(), nullptr) == strings.end();
  const std::string reading = fmt::format("PISTON_{}", options.actuator);
  const std::string signal = fmt::format("current_{}", options.actuator);

  WholeFile file(path);
  LogWriter writer(record, map);
  std::string text;
  for (std::size_t row = 0; row < record.rows; ++row) {
    // The command of a row holds until the next reading: it follows this row's.
    const double time = record.start + static_cast<double>(row) * record.period;
    if (with_strings) {
      writer.append(text, "STRINGS_12", row, time, {{"string_1", &strings[0]->values}, {"string_2", &strings[1]->values}});
      writer.append(text, "STRINGS_34", row, time, {{"string_3", &strings[2]->values}, {"string_4", &strings[3]->values}});
    }
    writer.append(text, reading, row, time, {{"piston_a", &piston}, {"piston_b", &piston}});
    if (pressure != nullptr) {
      writer.append(text, "LOAD_PRESSURES", row, time, {{pressure_signal.c_str(), &pressure->values}});
    }
    writer.append(text, "SERVOVALVE_COMMAND", row, time, {{signal.c_str(), &current}});
    file.write_block(text);
  }
  file.write(text);
  file.commit();
}

}  // namespace hotfire
