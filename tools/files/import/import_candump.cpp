// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/files/can/candump_frame.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/import/resample.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/record/time_grid.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

namespace {

constexpr std::size_t kNamesShown = 5;

/// A channel of the map and the signal that it is.
struct Source {
  ImportColumn column;
  const DbcMessage* message = nullptr;
  const DbcSignal* signal = nullptr;
  bool is_held = false;
  double newest = std::nan("");

  std::string name() const { return message->name + "." + signal->name; }
};

bool is_known(const std::string& unit) {
  try {
    require_known_unit(unit);
  } catch (const UnitError&) {
    return false;
  }
  return !unit.empty();
}

/// Whether both are the same, whatever they are called: "deg", "degree".
bool are_same(const std::string& unit, const std::string& other) {
  constexpr double kImportRounding = 1e-12;
  try {
    const UnitConverter convert(unit, other);
    return std::abs(convert(0.0)) < kImportRounding && std::abs(convert(1.0) - 1.0) < kImportRounding;
  } catch (const UnitError&) {
    return false;
  }
}

/// Finds the signals of a map in a DBC file.
class SignalFinder {
 public:
  SignalFinder(const Dbc& dbc, const ImportMap& map) : dbc_(dbc), map_(map) {}

  std::vector<Source> sources() const {
    std::vector<Source> sources;
    for (const ImportColumn& column : map_.columns) {
      Source& source = sources.emplace_back(Source{column});
      find(source);
      // A load that a frame sets holds until the next.
      source.is_held = is_held_input(column.channel) || own_name(column.channel) == "force";
      source.column.unit = unit_of(source);
    }
    return sources;
  }

  const DbcMessage& rows(const std::vector<Source>& sources) const {
    if (!map_.rows.empty()) {
      const DbcMessage* message = dbc_.find(map_.rows);
      if (message == nullptr) {
        std::vector<std::string_view> names;
        for (const DbcMessage& known : dbc_.messages) {
          names.push_back(known.name);
        }
        throw FileError(fmt::format("{}: can.rows = \"{}\": no message of {}; nearest: {}", map_.path.string(), map_.rows,
                                    dbc_.path.string(), fmt::join(nearest_words(map_.rows, names, kNamesShown), ", ")));
      }
      return *message;
    }
    std::set<std::string> names;
    for (const Source& source : sources) {
      names.insert(source.message->name);
    }
    if (names.size() > 1) {
      throw FileError(fmt::format(
          "{}: can.rows: missing; the signals are of {}: name the message whose frames make the rows, [can] rows = \"{}\"",
          map_.path.string(), fmt::join(names, ", "), *names.begin()));
    }
    return *sources.front().message;
  }

 private:
  [[noreturn]] void refuse(const ImportColumn& column, const std::string& problem) const {
    throw FileError(fmt::format("{}:{}: channels.{}: {}", map_.path.string(), column.line, column.channel, problem));
  }

  void find(Source& source) const {
    const std::string& wanted = source.column.column;
    const bool with_message = wanted.find('.') != std::string::npos;
    std::vector<std::string> found;
    std::set<std::string> names;
    for (const DbcMessage& message : dbc_.messages) {
      for (const DbcSignal& signal : message.signals) {
        const std::string full = message.name + "." + signal.name;
        const std::string& name = with_message ? full : signal.name;
        names.insert(name);
        if (name == wanted) {
          source.message = &message;
          source.signal = &signal;
          found.push_back(full);
        }
      }
    }
    if (found.empty()) {
      const std::vector<std::string_view> known(names.begin(), names.end());
      refuse(source.column, fmt::format("no signal \"{}\" in {}; nearest: {}", wanted, dbc_.path.string(),
                                        fmt::join(nearest_words(wanted, known, kNamesShown), ", ")));
    }
    if (found.size() > 1) {
      refuse(source.column, fmt::format("several messages of {} have a signal \"{}\"; write one of {}", dbc_.path.string(),
                                        wanted, fmt::join(found, ", ")));
    }
    if (source.signal->selected_by &&
        (source.message->has_extended_multiplexing || source.message->multiplexer() == nullptr)) {
      refuse(source.column, fmt::format("{}: {}:{}: multiplexed by other than one value of one multiplexer of its message, "
                                        "which is not read",
                                        source.name(), dbc_.path.string(), source.signal->line));
    }
  }

  std::string unit_of(const Source& source) const {
    const std::string& given = source.column.unit;
    const std::string& declared = source.signal->unit;
    if (!is_known(declared)) {
      if (given.empty()) {
        refuse(source.column,
               fmt::format("unit: missing, and of {} the DBC file says \"{}\", which is not a known unit; write "
                           "for example unit = \"mm\"",
                           source.name(), declared));
      }
      return given;
    }
    // A factor other than a sign may convert between them.
    if (!given.empty() && std::abs(source.column.factor) == 1.0 && !are_same(given, declared)) {
      refuse(source.column,
             fmt::format("unit = \"{}\": {}:{} says that {} is in \"{}\"; leave unit out, or correct the wrong one", given,
                         dbc_.path.string(), source.signal->line, source.name(), declared));
    }
    return given.empty() ? declared : given;
  }

  const Dbc& dbc_;
  const ImportMap& map_;
};

/// Takes in the lines of a log, and makes rows of them.
class LogColumns {
 public:
  LogColumns(const std::filesystem::path& path, const Dbc& dbc, std::vector<Source> sources, const DbcMessage& rows)
      : path_(path),
        dbc_(dbc),
        sources_(std::move(sources)),
        rows_(rows),
        lines_(path),
        open_(sources_.size()),
        values_(sources_.size()) {
    add_message(rows_);
    for (const Source& source : sources_) {
      add_message(*source.message);
    }
  }

  ImportedColumns read() {
    while (const auto frame = next_candump_frame(lines_)) {
      take(*frame);
    }
    close_row();  // the last command holds on
    return columns();
  }

 private:
  struct Heard {
    const DbcMessage* message;
    double last;  ///< stamp of its last frame [s]
  };

  void add_message(const DbcMessage& message) {
    if (std::none_of(heard_.begin(), heard_.end(), [&](const Heard& heard) { return heard.message == &message; })) {
      heard_.push_back({&message, std::nan("")});
    }
  }

  void take(const CandumpFrame& frame) {
    if (!frame.is_data) {
      return;
    }
    ids_.insert(frame.id);
    const auto heard =
        std::find_if(heard_.begin(), heard_.end(), [&](const Heard& known) { return known.message->id == frame.id; });
    if (heard == heard_.end()) {
      return;
    }
    const DbcMessage& message = *heard->message;
    require_good(message, frame);
    if (&message == &rows_) {
      close_row();
    }
    heard->last = frame.time;
    for (Source& source : sources_) {
      if (source.message == &message && is_carried(*source.signal, message, frame)) {
        source.newest = value_of(source, frame);
      }
    }
    if (&message == &rows_) {
      open_row(frame);
    }
  }

  void require_good(const DbcMessage& message, const CandumpFrame& frame) {
    if (!interface_.empty() && interface_ != frame.interface) {
      lines_.refuse(fmt::format("{}: interface {} after {}; allowed: one, see 'grep {}'", message.name, frame.interface,
                                interface_, interface_));
    }
    interface_ = frame.interface;
    const std::size_t length = frame.data.size();
    // FD frames have lengths in steps: what is behind the message is padding.
    if (length != message.length && !(frame.fd && length > message.length)) {
      lines_.refuse(
          fmt::format("{}: {} bytes; {}:{} has {}", message.name, length, dbc_.path.string(), message.line, message.length));
    }
  }

  static bool is_carried(const DbcSignal& signal, const DbcMessage& message, const CandumpFrame& frame) {
    return !signal.selected_by || message.multiplexer()->raw(frame.data) == *signal.selected_by;
  }

  double value_of(const Source& source, const CandumpFrame& frame) const {
    const DbcSignal& signal = *source.signal;
    const double value = signal.physical(frame.data);
    if (!signal.allows(value)) {
      lines_.refuse(
          fmt::format("{} = {:g} {}: {}:{} allows {:g} to {:g}; cut the log there, or correct the range ([0|0]: "
                      "none)",
                      source.name(), value, signal.unit, dbc_.path.string(), signal.line, signal.lowest, signal.highest));
    }
    return value;
  }

  void open_row(const CandumpFrame& frame) {
    constexpr double kCycles = 2.5;
    for (const Heard& heard : heard_) {
      const double silent = frame.time - heard.last;
      const double cycle = 1e-3 * heard.message->cycle_ms;
      if (cycle > 0.0 && silent > kCycles * cycle) {
        lines_.refuse(
            fmt::format("{}: silent for {:.6g} s, and {}:{} has it every {:g} s: frames are lost; cut the log "
                        "there, or take its GenMsgCycleTime out if it is sent on change",
                        heard.message->name, silent, dbc_.path.string(), heard.message->line, cycle));
      }
    }
    is_open_ = true;
    open_time_ = frame.time;
    open_line_ = lines_.number();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      open_[i] = sources_[i].newest;
    }
  }

  void close_row() {
    if (!is_open_) {
      return;
    }
    is_open_ = false;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      open_[i] = sources_[i].is_held ? sources_[i].newest : open_[i];
    }
    if (std::any_of(open_.begin(), open_.end(), [](double value) { return std::isnan(value); })) {
      return;
    }
    if (times_.size() == kMostRows) {
      lines_.refuse(fmt::format("more than {} frames of {}; cut the log into parts", kMostRows, rows_.name));
    }
    times_.push_back(open_time_);
    numbers_.push_back(open_line_);
    for (std::size_t i = 0; i < open_.size(); ++i) {
      values_[i].push_back(open_[i]);
    }
  }

  void require_rows() const {
    for (const Source& source : sources_) {
      if (std::isnan(source.newest)) {
        refuse_absent(source.name() + " of channel " + source.column.channel, *source.message);
      }
    }
    if (std::isnan(heard_.front().last)) {
      refuse_absent(rows_.name + ", whose frames make the rows,", rows_);
    }
    if (times_.size() < 2) {
      throw FileError(fmt::format("{}: {} frames of {} with a value of every channel; allowed: at least 2", path_.string(),
                                  times_.size(), rows_.name));
    }
  }

  [[noreturn]] void refuse_absent(const std::string& what, const DbcMessage& message) const {
    std::vector<std::string> present;
    for (const DbcMessage& known : dbc_.messages) {
      if (ids_.contains(known.id)) {
        present.push_back(known.name);
      }
    }
    throw FileError(fmt::format("{}: {} never occurs (id {:X}); of {} there are: {}", path_.string(), what,
                                message.id & ~kExtendedId, dbc_.path.string(),
                                present.empty() ? "none" : fmt::format("{}", fmt::join(present, ", "))));
  }

  ImportedColumns columns() const {
    require_rows();
    if (const std::size_t row = first_reading_after_gap(times_); row != 0) {
      throw FileError(
          fmt::format("{}:{}: {}: {:.6g} s after the one before: frames are lost; a record has no gaps, cut the "
                      "log here",
                      path_.string(), numbers_[row], rows_.name, times_[row] - times_[row - 1]));
    }
    const auto [start, period] = stamped_grid(times_, path_);
    ImportedColumns imported;
    ImportColumn& time = imported.columns.emplace_back();
    time.channel = "time";
    time.unit = "s";
    std::vector<double>& times = imported.values.emplace_back();
    for (std::size_t row = 0; row < times_.size(); ++row) {
      times.push_back(start + static_cast<double>(row) * period);
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      imported.columns.push_back(sources_[i].column);
      imported.values.push_back(values_[i]);
    }
    return imported;
  }

  std::filesystem::path path_;
  const Dbc& dbc_;
  std::vector<Source> sources_;
  const DbcMessage& rows_;
  CsvLines lines_;
  std::string interface_;
  std::vector<Heard> heard_;  ///< messages of the map, first that of the rows
  std::set<std::uint32_t> ids_;
  bool is_open_ = false;
  double open_time_ = 0.0;
  std::size_t open_line_ = 0;
  std::vector<double> open_;  ///< row in the making
  std::vector<double> times_;
  std::vector<std::size_t> numbers_;  ///< lines
  std::vector<std::vector<double>> values_;
};

}  // namespace

ImportedColumns read_candump_columns(const std::filesystem::path& path, const Dbc& dbc, const ImportMap& map) {
  const SignalFinder finder(dbc, map);
  const std::vector<Source> sources = finder.sources();
  return LogColumns(path, dbc, sources, finder.rows(sources)).read();
}

}  // namespace hotfire
