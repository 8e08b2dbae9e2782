// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "tools/files/record/record.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

void append_number(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

/// Equal but for the rounding of a mean period.
bool is_close(double one, double other) {
  constexpr double kRounding = 1e-12;
  return std::abs(one - other) <= kRounding * std::abs(other);
}

}  // namespace

std::vector<double> times_of(const Record& record) {
  // Of a rate in whole hertz, or a period in whole nanoseconds, a time is the quotient of two whole numbers: the double that
  // its decimal digits read as. A product of doubles is off by a rounding.
  constexpr double kNanoseconds = 1e9;
  std::vector<double> times(record.rows);
  for (const double ticks : {std::round(1.0 / record.period), kNanoseconds}) {
    const double step = std::round(record.period * ticks);
    const double first = std::round(record.start * ticks);
    if (is_close(step / ticks, record.period) && is_close(first / ticks, record.start)) {
      for (std::size_t row = 0; row < record.rows; ++row) {
        times[row] = (first + static_cast<double>(row) * step) / ticks;
      }
      return times;
    }
  }
  for (std::size_t row = 0; row < record.rows; ++row) {
    times[row] = record.start + static_cast<double>(row) * record.period;
  }
  return times;
}

void write_record(const Record& record, const std::filesystem::path& path) {
  WholeFile file(path);
  std::string text = "time[s]";
  for (const Channel& channel : record.channels) {
    text += fmt::format(",{}[{}]", channel.name, channel.unit);
  }
  text += '\n';
  const std::vector<double> times = times_of(record);
  for (std::size_t row = 0; row < record.rows; ++row) {
    append_number(text, times[row]);
    for (const Channel& channel : record.channels) {
      text += ',';
      append_number(text, channel.values[row]);
    }
    text += '\n';
    file.write_block(text);
  }
  file.write(text);
  file.commit();
}

}  // namespace hotfire
