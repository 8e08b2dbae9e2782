// SPDX-License-Identifier: Apache-2.0
#include "tools/report/series_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace hotfire {
namespace {

using Rows = std::vector<std::uint32_t>;

/// The models in the order in which the page names them.
struct Model {
  const char* key;
  std::vector<double> ReportChannel::*values;
};
constexpr Model kModels[] = {
    {"declared", &ReportChannel::declared}, {"calibrated", &ReportChannel::calibrated}, {"after", &ReportChannel::after}};

/// One line that is drawn of a record: the input, a measurement, or a measurement minus a model.
class Trace {
 public:
  /// `place`: where in the record's JSON its base64 goes.
  Trace(nlohmann::json::json_pointer place, std::span<const double> values, std::span<const double> model = {})
      : place_(std::move(place)), values_(values), model_(model) {}

  const nlohmann::json::json_pointer& place() const { return place_; }
  double at(std::size_t row) const { return model_.empty() ? values_[row] : values_[row] - model_[row]; }

 private:
  nlohmann::json::json_pointer place_;
  std::span<const double> values_;
  std::span<const double> model_;
};

/// Base64 (RFC 4648) of 32-bit words, little end first.
class Base64 {
 public:
  explicit Base64(std::size_t words) { text_.reserve(words * 16 / 3 + 4); }

  void add(std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
      pending_ = pending_ << 8 | (word >> shift & 0xFFU);
      if (++count_ == 3) {
        flush();
      }
    }
  }

  std::string finish() {
    if (count_ > 0) {
      const std::size_t missing = 3 - count_;
      pending_ <<= 8 * missing;
      flush();
      text_.replace(text_.size() - missing, missing, missing, '=');
    }
    return std::move(text_);
  }

 private:
  void flush() {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int shift = 18; shift >= 0; shift -= 6) {
      text_ += kDigits[pending_ >> shift & 0x3FU];
    }
    pending_ = 0;
    count_ = 0;
  }

  std::string text_;
  std::uint32_t pending_ = 0;
  std::size_t count_ = 0;
};

std::string encoded(const Trace& trace, const Rows& rows) {
  Base64 text(rows.size());
  for (const std::uint32_t row : rows) {
    const float value = static_cast<float>(trace.at(row));
    std::uint32_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    text.add(word);
  }
  return text.finish();
}

std::string encoded(const Rows& rows) {
  Base64 text(rows.size());
  for (const std::uint32_t row : rows) {
    text.add(row);
  }
  return text.finish();
}

std::size_t row_count(const ReportRecord& record) {
  return record.channels.empty() ? 0 : record.channels.front().measured.size();
}

void check_length(const ReportRecord& record, const std::string& what, const std::vector<double>& values) {
  if (values.size() != row_count(record)) {
    throw std::invalid_argument(
        fmt::format("report of record '{}': {} has {} rows, channel '{}' has {}; all must have the same", record.name, what,
                    values.size(), record.channels.front().name, row_count(record)));
  }
}

void check(const ReportRecord& record) {
  if (!(record.period > 0.0)) {
    throw std::invalid_argument(
        fmt::format("report of record '{}': period {} s, it must be positive", record.name, record.period));
  }
  if (!record.input_name.empty()) {
    check_length(record, fmt::format("input '{}'", record.input_name), record.input);
  }
  for (const ReportChannel& channel : record.channels) {
    check_length(record, fmt::format("channel '{}'", channel.name), channel.measured);
    for (const Model& model : kModels) {
      const std::vector<double>& values = channel.*model.values;
      if (!values.empty()) {
        check_length(record, fmt::format("channel '{}', {} model,", channel.name, model.key), values);
      }
    }
  }
}

std::vector<Trace> traces_of(const ReportRecord& record) {
  using Place = nlohmann::json::json_pointer;
  std::vector<Trace> traces;
  if (!record.input_name.empty()) {
    traces.emplace_back(Place("/input/values"), record.input);
  }
  for (std::size_t index = 0; index < record.channels.size(); ++index) {
    const ReportChannel& channel = record.channels[index];
    const Place place = Place("/channels") / index;
    traces.emplace_back(place / "measured", channel.measured);
    for (const Model& model : kModels) {
      const std::vector<double>& values = channel.*model.values;
      if (!values.empty()) {
        traces.emplace_back(place / "errors" / model.key, channel.measured, values);
      }
    }
  }
  return traces;
}

/// Appends the rows in [from, to) at which a trace is smallest or largest; none where it is NaN throughout.
void add_extremes(const Trace& trace, std::size_t from, std::size_t to, Rows& rows) {
  std::size_t least = to;
  std::size_t most = to;
  for (std::size_t row = from; row < to; ++row) {
    const double value = trace.at(row);
    if (std::isnan(value)) {
      continue;
    }
    if (least == to || value < trace.at(least)) {
      least = row;
    }
    if (most == to || value > trace.at(most)) {
      most = row;
    }
  }
  if (least == to) {
    return;
  }
  rows.push_back(static_cast<std::uint32_t>(least));
  rows.push_back(static_cast<std::uint32_t>(most));
}

/// At most `share` of `count` rows: the extremes of every trace in each of equal stretches. Rows are shared by all traces,
/// so that each shown point is one row of the record.
Rows kept_rows(const std::vector<Trace>& traces, std::size_t count, std::size_t share) {
  Rows rows;
  if (share >= count) {
    rows.resize(count);
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
  }
  const std::size_t stretches = std::max<std::size_t>(1, share / (2 * traces.size()));
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t from = stretch * count / stretches;
    const std::size_t to = (stretch + 1) * count / stretches;
    const auto first = static_cast<Rows::difference_type>(rows.size());
    for (const Trace& trace : traces) {
      add_extremes(trace, from, to, rows);
    }
    std::sort(rows.begin() + first, rows.end());
    rows.erase(std::unique(rows.begin() + first, rows.end()), rows.end());
  }
  return rows;
}

nlohmann::json record_data(const ReportRecord& record, const Rows& rows, const std::vector<Trace>& traces) {
  nlohmann::json data{{"name", record.name},       {"start", record.start},       {"period", record.period},
                      {"rows", row_count(record)}, {"held_out", record.held_out}, {"channels", nlohmann::json::array()}};
  if (rows.size() < row_count(record)) {
    data["kept"] = encoded(rows);
  }
  if (!record.input_name.empty()) {
    data["input"] = {{"name", record.input_name}, {"unit", record.input_unit}};
  }
  for (const ReportChannel& channel : record.channels) {
    data["channels"].push_back({{"name", channel.name}, {"unit", channel.unit}, {"errors", nlohmann::json::object()}});
  }
  for (const Trace& trace : traces) {
    data[trace.place()] = encoded(trace, rows);
  }
  return data;
}

}  // namespace

nlohmann::json series_data(const ReportSeries& series) {
  std::size_t total = 0;
  for (const ReportRecord& record : series.records) {
    check(record);
    total += row_count(record);
  }
  std::size_t kept = 0;
  nlohmann::json records = nlohmann::json::array();
  for (const ReportRecord& record : series.records) {
    const std::size_t count = row_count(record);
    if (count == 0) {
      continue;
    }
    const std::vector<Trace> traces = traces_of(record);
    const std::size_t share = total <= kFullResolutionRows ? count : count * kFullResolutionRows / total;
    const Rows rows = kept_rows(traces, count, share);
    records.push_back(record_data(record, rows, traces));
    kept += rows.size();
  }
  return {{"rows", total}, {"kept", kept}, {"records", std::move(records)}};
}

}  // namespace hotfire
