// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/can/layout.hpp"
#include "hal/schedule/frame_time.hpp"

namespace hotfire::firmware::can {

/// Share of a bus that plant and controller take in the worst case. Command, readings and SYNC come once a period, and so do
/// load pressures if the plant sends them. Status, heartbeat and string potentiometers come as often as the map says. Rates
/// in bit/s.
inline double bus_load(Layout layout, std::size_t actuators, std::int64_t period_ns, double bit_rate, double data_bit_rate,
                       MoreReadings more = {}) noexcept {
  const double period = 1e-9 * static_cast<double>(period_ns);
  const auto longest = [&](const Message& message) {
    return message.fd ? hal::longest_fd_frame(message.length, bit_rate, data_bit_rate)
                      : hal::longest_classic_frame(message.length, bit_rate);
  };
  double load = (longest(sync::kMessage) + longest(command_message(layout))) / period;
  for (std::size_t i = 0; i < reading_messages(layout, actuators); ++i) {
    load += longest(reading_message(layout, i)) / period;
  }
  load += more.load_pressure ? longest(load_pressure_message(layout)) / period : 0.0;
  const auto add_report = [&](const Message& report) { load += longest(report) / (1e-3 * report.cycle_ms); };
  add_report(status::kMessage);
  add_report(heartbeat::kMessage);
  for (std::size_t i = 0; more.strings && i < string_messages(layout); ++i) {
    add_report(string_message(layout, i));
  }
  return load;
}

}  // namespace hotfire::firmware::can
