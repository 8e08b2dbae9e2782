// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/candump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/files/can/candump_frame.hpp"
#include "tools/files/record/time_grid.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr std::size_t kStrings = 4;  ///< of one engine
constexpr unsigned kPerEngine = 2;   ///< actuators

/// Where the numbers of one actuator are in the map. In a split layout reading B comes in a message of its own.
struct ActuatorPlaces {
  const CanMessage* command;
  const CanSignal* current;
  const CanMessage* reading;
  const CanSignal* piston_a;
  const CanMessage* second_reading;
  const CanSignal* piston_b;
  const CanMessage* pressures;  ///< none in a map without them
  const CanSignal* pressure;
  std::array<const CanMessage*, kStrings> string_messages;
  std::array<const CanSignal*, kStrings> strings;
};

void find_pressure(ActuatorPlaces& places, const CanMap& map, const char* message, unsigned actuator) {
  places.pressures = map.find(message);
  if (places.pressures != nullptr) {
    places.pressure = &places.pressures->at(fmt::format("load_pressure_{}", actuator));
  }
}

ActuatorPlaces classic_places(const CanMap& map, unsigned actuator, bool split) {
  ActuatorPlaces places{};
  places.command = &map.at("SERVOVALVE_COMMAND");
  places.current = &places.command->at(fmt::format("current_{}", actuator));
  places.reading = &map.at(fmt::format("PISTON_{}{}", actuator, split ? "_A" : ""));
  places.piston_a = &places.reading->at(split ? "piston" : "piston_a");
  places.second_reading = &map.at(fmt::format("PISTON_{}{}", actuator, split ? "_B" : ""));
  places.piston_b = &places.second_reading->at(split ? "piston" : "piston_b");
  find_pressure(places, map, "LOAD_PRESSURES", actuator);
  for (std::size_t i = 0; i < kStrings; ++i) {
    places.string_messages[i] = &map.at(i < 2 ? "STRINGS_12" : "STRINGS_34");
    places.strings[i] = &places.string_messages[i]->at(fmt::format("string_{}", i + 1));
  }
  return places;
}

ActuatorPlaces fd_places(const CanMap& map, unsigned actuator, bool split) {
  ActuatorPlaces places{};
  places.command = &map.at("SERVOVALVE_COMMAND_FD");
  places.current = &places.command->at(fmt::format("current_{}", actuator));
  places.reading = &map.at(split ? "PISTONS_A_FD" : "PISTONS_FD");
  places.piston_a = &places.reading->at(fmt::format("piston_{}{}", actuator, split ? "" : "_a"));
  places.second_reading = &map.at(split ? "PISTONS_B_FD" : "PISTONS_FD");
  places.piston_b = &places.second_reading->at(fmt::format("piston_{}{}", actuator, split ? "" : "_b"));
  find_pressure(places, map, "LOAD_PRESSURES_FD", actuator);
  const std::size_t first = (actuator - 1) / kPerEngine * kStrings;
  for (std::size_t i = 0; i < kStrings; ++i) {
    places.string_messages[i] = &map.at("STRINGS_FD");
    places.strings[i] = &places.string_messages[i]->at(fmt::format("string_{}", first + i + 1));
  }
  return places;
}

/// Takes in the lines of a log, and makes rows of them.
class LogReader {
 public:
  LogReader(const std::filesystem::path& path, const CandumpOptions& options, const CanMap& map)
      : path_(path), options_(options), map_(map), lines_(path) {
    strings_.fill(std::nan(""));
  }

  Record read() {
    while (const auto frame = next_candump_frame(lines_)) {
      take(*frame);
    }
    if (open_ && (!has_both_ || lacks_pressure(*open_))) {
      open_.reset();  // the log ends between two readings of one row
    }
    close_row();  // the last command holds on
    return record();
  }

 private:
  struct Row {
    double time;
    double piston;
    double current;
    double pressure;
    std::array<double, kStrings> strings;
  };

  void take(const CandumpFrame& frame) {
    const CanMessage* message = frame.is_data ? map_.find(frame.id, frame.fd) : nullptr;
    if (message == nullptr) {
      return;
    }
    if (!interface_.empty() && interface_ != frame.interface) {
      lines_.refuse(
          fmt::format("interface {} after {}; allowed: one, see 'grep {}'", frame.interface, interface_, interface_));
    }
    interface_ = frame.interface;
    require_good(*message, frame);
    choose_layout(*message);
    if (!places_) {
      return;
    }
    if (message == places_->reading) {
      close_row();
      require_next(last_reading_, *message, frame);
      open_row(frame);
    }
    if (message == places_->second_reading && open_) {
      add_second_reading(frame);
    }
    if (message == places_->pressures && last_reading_) {
      add_pressure(frame);
    }
    if (message == places_->command) {
      require_next(last_command_, *message, frame);
      current_ = places_->current->physical(places_->current->read(frame.data));
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
      if (message == places_->string_messages[i]) {
        strings_[i] = places_->strings[i]->physical(places_->strings[i]->read(frame.data));
      }
    }
  }

  void require_good(const CanMessage& message, const CandumpFrame& frame) const {
    if (frame.data.size() != message.length) {
      lines_.refuse(fmt::format("{}: {} bytes; allowed: {}", message.name, frame.data.size(), message.length));
    }
    if (!message.is_intact(frame.data)) {
      lines_.refuse(fmt::format("{}: its check is wrong; the log is damaged, or of another CAN map: 'hotfire import --dbc'",
                                message.name));
    }
    for (const CanSignal& signal : message.signals) {
      const std::int64_t raw = signal.read(frame.data);
      if (raw < signal.lowest_raw || raw > signal.highest_raw) {
        lines_.refuse(fmt::format("{}: {} = {:g} {}; allowed: {:g} to {:g}", message.name, signal.name, signal.physical(raw),
                                  signal.unit, signal.physical(signal.lowest_raw), signal.physical(signal.highest_raw)));
      }
    }
  }

  /// By the first command or string, which says classic or FD, and by the first reading, which says whether it is split.
  void choose_layout(const CanMessage& message) {
    const auto begins = [&](std::string_view word) { return message.name.starts_with(word); };
    const bool is_reading = begins("PISTON");
    if (!begins("SERVOVALVE_COMMAND") && !is_reading && !begins("STRINGS")) {
      return;
    }
    const bool fd = message.fd;
    if (is_fd_ && *is_fd_ != fd) {
      lines_.refuse(fmt::format("{}: a frame of the {} layout after one of the other; allowed: one layout", message.name,
                                fd ? "FD" : "classic"));
    }
    if (!is_fd_ && !fd && options_.actuator > kPerEngine) {
      lines_.refuse(
          fmt::format("the log is of the classic layout, which has no actuator {}; allowed: 1, 2", options_.actuator));
    }
    const bool split =
        is_reading ? message.find("piston") != nullptr || message.find("piston_1") != nullptr : is_split_.value_or(false);
    if (is_reading && is_split_ && *is_split_ != split) {
      lines_.refuse(fmt::format("{}: a frame of the {} layout after one of the other; allowed: one layout", message.name,
                                split ? "split" : "joint"));
    }
    if (!is_fd_ || (is_reading && !is_split_)) {
      places_ = fd ? fd_places(map_, options_.actuator, split) : classic_places(map_, options_.actuator, split);
    }
    is_fd_ = fd;
    is_split_ = is_reading ? split : is_split_;
  }

  void require_next(std::optional<std::uint8_t>& last, const CanMessage& message, const CandumpFrame& frame) const {
    const auto counter = static_cast<std::uint8_t>(message.counter().read(frame.data));
    if (last && counter != static_cast<std::uint8_t>(*last + 1)) {
      lines_.refuse(fmt::format("{}: counter {} after {}: frames are lost; a record has no gaps, cut the log here",
                                message.name, counter, *last));
    }
    last = counter;
  }

  /// With reading A only: B belongs to the same row, if it is of another frame too.
  void open_row(const CandumpFrame& frame) {
    const double a = places_->piston_a->physical(places_->piston_a->read(frame.data));
    open_ = Row{frame.time, a, std::nan(""), std::nan(""), strings_};
    has_both_ = false;
  }

  void add_second_reading(const CandumpFrame& frame) {
    const auto counter = static_cast<std::uint8_t>(places_->second_reading->counter().read(frame.data));
    if (has_both_ || counter != last_reading_) {
      lines_.refuse(fmt::format("{}: counter {} after {} {} of the other reading; allowed: both readings with one counter",
                                places_->second_reading->name, counter, places_->reading->name, *last_reading_));
    }
    const double b = places_->piston_b->physical(places_->piston_b->read(frame.data));
    open_->piston = 0.5 * (open_->piston + b);
    has_both_ = true;
  }

  void add_pressure(const CandumpFrame& frame) {
    const auto counter = static_cast<std::uint8_t>(places_->pressures->counter().read(frame.data));
    if (!open_ || counter != last_reading_ || !std::isnan(open_->pressure)) {
      lines_.refuse(fmt::format("{}: counter {} after {} {}; allowed: one after each reading, with its counter",
                                places_->pressures->name, counter, places_->reading->name, *last_reading_));
    }
    open_->pressure = places_->pressure->physical(places_->pressure->read(frame.data));
    has_pressures_ = true;
  }

  /// Where a row before it had one.
  bool lacks_pressure(const Row& row) const { return has_pressures_ && std::isnan(row.pressure); }

  void close_row() {
    if (open_ && !has_both_) {
      lines_.refuse(
          fmt::format("{}: none with the counter {} of {}: frames are lost; a record has no gaps, cut the log here",
                      places_->second_reading->name, *last_reading_, places_->reading->name));
    }
    if (open_ && lacks_pressure(*open_)) {
      lines_.refuse(
          fmt::format("{}: none with the counter {} of {}: frames are lost; a record has no gaps, cut the log here",
                      places_->pressures->name, *last_reading_, places_->reading->name));
    }
    if (open_ && !std::isnan(current_)) {
      if (rows_.size() == kMostRows) {
        lines_.refuse(fmt::format("more than {} readings; cut the log into parts", kMostRows));
      }
      open_->current = current_;
      rows_.push_back(*open_);
    }
    open_.reset();
  }

  static bool has_strings(const Row& row) {
    return std::none_of(row.strings.begin(), row.strings.end(), [](double value) { return std::isnan(value); });
  }

  /// Strings come less often than readings: rows before the first of each have none. Load pressures come with each reading
  /// from a plant that sends them.
  void drop_rows_without_all() {
    const auto drop_before = [this](const auto& is_complete) {
      const auto first = std::find_if(rows_.begin(), rows_.end(), is_complete);
      if (first != rows_.end()) {
        rows_.erase(rows_.begin(), first);
      }
    };
    drop_before(has_strings);
    drop_before([](const Row& row) { return !std::isnan(row.pressure); });
  }

  Record record() {
    drop_rows_without_all();
    if (rows_.size() < 2) {
      throw FileError(
          fmt::format("{}: {} readings of actuator {} with a command; allowed: at least 2. The log needs the "
                      "frames SERVOVALVE_COMMAND and PISTON_1 of the CAN map, or those of the FD layout; 'hotfire import "
                      "--dbc' reads other frames",
                      path_.string(), rows_.size(), options_.actuator));
    }
    std::vector<double> times;
    times.reserve(rows_.size());
    for (const Row& row : rows_) {
      times.push_back(row.time);
    }
    const auto [start, period] = stamped_grid(times, path_);
    Record record{path_, path_.filename().string(), start, period, rows_.size(), {}};
    const auto add = [&](const std::string& name, const std::string& unit, const auto& value) {
      Channel& channel = record.channels.emplace_back(Channel{name, unit, {}});
      for (const Row& row : rows_) {
        channel.values.push_back(value(row));
      }
    };
    if (options_.command_per_current != 0.0) {
      add("command", "rad", [this](const Row& row) { return row.current * options_.command_per_current; });
    }
    add("current", "A", [](const Row& row) { return row.current; });
    add("piston", "m", [](const Row& row) { return row.piston; });
    if (!std::isnan(rows_.front().pressure)) {
      add("load_pressure", "Pa", [](const Row& row) { return row.pressure; });
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
      if (has_strings(rows_.front())) {
        add(fmt::format("string{}", i + 1), "m", [i](const Row& row) { return row.strings[i]; });
      }
    }
    return record;
  }

  std::filesystem::path path_;
  CandumpOptions options_;
  const CanMap& map_;
  CsvLines lines_;
  std::string interface_;
  std::optional<bool> is_fd_;
  std::optional<bool> is_split_;
  std::optional<ActuatorPlaces> places_;
  std::optional<std::uint8_t> last_reading_;
  std::optional<std::uint8_t> last_command_;
  double current_ = std::nan("");
  std::array<double, kStrings> strings_{};
  std::optional<Row> open_;
  bool has_both_ = false;       ///< redundant readings are in the open row
  bool has_pressures_ = false;  ///< a row has had one
  std::vector<Row> rows_;
};

void require_actuator(const CandumpOptions& options, unsigned most) {
  if (options.actuator < 1 || options.actuator > most) {
    throw UsageError(fmt::format("actuator {}; allowed: 1 to {}", options.actuator, most));
  }
}

}  // namespace

Record load_candump(const std::filesystem::path& path, const CandumpOptions& options, const CanMap& map) {
  constexpr unsigned kMost = 8;
  require_actuator(options, kMost);
  return LogReader(path, options, map).read();
}

Record load_record_or_log(const std::filesystem::path& path, const CandumpOptions& options,
                          const std::vector<DropOut>& drop_outs) {
  return path.extension() == ".log" ? load_candump(path, options) : load_record(path, drop_outs);
}

}  // namespace hotfire
