// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/candump.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/own_map.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/can/candump_frame.hpp"

namespace hotfire {

using test::expect_message;
using test::own_map;
using test::refusal;

namespace {

/// A line of a log: a good frame of the map with these values.
std::string line(double time, const std::string& name, std::uint8_t counter,
                 std::initializer_list<std::pair<const char*, double>> values) {
  const CanMessage& message = own_map.at(name);
  CandumpFrame frame{time, "can0", message.id, true, message.fd, std::vector<std::uint8_t>(message.length)};
  for (const auto& [signal, value] : values) {
    message.at(signal).write(message.at(signal).nearest_raw(value), frame.data);
  }
  message.counter().write(counter, frame.data);
  message.seal(frame.data);
  return candump_line(frame);
}

std::string command(double time, std::uint8_t counter, double current) {
  return line(time, "SERVOVALVE_COMMAND", counter, {{"current_1", current}, {"current_2", -current}});
}

std::string reading(double time, std::uint8_t counter, double piston) {
  return line(time, "PISTON_1", counter, {{"piston_a", piston - 1e-6}, {"piston_b", piston + 1e-6}});
}

std::string pressure(double time, std::uint8_t counter, double value) {
  return line(time, "LOAD_PRESSURES", counter, {{"load_pressure_1", value}, {"load_pressure_2", -value}});
}

/// Three readings, 1 ms apart, and the commands between them.
std::string short_log() {
  return command(100.0, 254, 0.001) + reading(100.0001, 255, 0.01) + command(100.001, 255, 0.002) +
         reading(100.0012, 0, 0.02) + command(100.002, 0, 0.003) + reading(100.0021, 1, 0.03);
}

}  // namespace

TEST_GROUP(Candump) {
  test::Scratch scratch;

  Record load(const std::string& text, const CandumpOptions& options = {}) const {
    return load_candump(scratch.write("run.log", text), options);
  }
  std::string refused(const std::string& text, const CandumpOptions& options = {}) const {
    return refusal([&] { load(text, options); });
  }
  void expect_values(const Record& record, const std::string& channel, std::initializer_list<double> values,
                     double tolerance) const {
    require_channel(record, channel, "wanted");
    UNSIGNED_LONGS_EQUAL(values.size(), record.rows);
    std::size_t row = 0;
    for (const double value : values) {
      DOUBLES_EQUAL(value, record.find(channel)->values[row++], tolerance);
    }
  }
};

TEST(Candump, row_is_a_reading_with_the_command_that_holds_until_the_next_one) {
  const Record record = load(short_log(), {1, 2.0});
  DOUBLES_EQUAL(100.0001, record.start, 1e-9);
  DOUBLES_EQUAL(0.001, record.period, 0.0);
  expect_values(record, "piston", {0.01, 0.02, 0.03}, 1e-12);
  expect_values(record, "current", {0.002, 0.003, 0.003}, 1e-12);
  expect_values(record, "command", {0.004, 0.006, 0.006}, 1e-12);
}

TEST(Candump, without_the_scale_there_is_a_current_and_no_command) {
  const Record record = load(short_log());
  CHECK(record.find("command") == nullptr);
  CHECK(record.find("string1") == nullptr);
}

TEST(Candump, frames_of_others_and_error_frames_are_left_out_and_the_other_actuator_can_be_asked_for) {
  const std::string others =
      "(100.000000) can0 12345678#0011\n(100.000000) can0 123#R\n(100.0) can0 20000040#0000000000000000\n(100.0) can0 "
      "7DF#\n";
  std::string second;
  for (std::uint8_t i = 0; i < 3; ++i) {
    second += line(100.0002 + 0.001 * i, "PISTON_2", i, {{"piston_a", -0.1}, {"piston_b", -0.1}}) +
              command(100.0003 + 0.001 * i, i, 0.004);
  }
  UNSIGNED_LONGS_EQUAL(3, load(others + short_log()).rows);
  const Record record = load(others + second, {2, 0.0});
  expect_values(record, "current", {-0.004, -0.004, -0.004}, 1e-12);
  expect_values(record, "piston", {-0.1, -0.1, -0.1}, 1e-12);
}

TEST(Candump, fd_layout_gives_the_actuator_asked_for_and_its_engines_strings) {
  std::string text = line(5.0, "STRINGS_FD", 0, {{"string_9", 0.1}, {"string_12", 0.4}});
  for (std::uint8_t i = 0; i < 4; ++i) {
    text += line(5.001 + 0.0005 * i, "SERVOVALVE_COMMAND_FD", i, {{"current_6", 0.01 * i}}) +
            line(5.0011 + 0.0005 * i, "PISTONS_FD", i, {{"piston_6_a", 0.01 * i}, {"piston_6_b", 0.01 * i}});
  }
  const Record record = load(text, {6, 0.0});
  DOUBLES_EQUAL(0.0005, record.period, 0.0);
  expect_values(record, "piston", {0.0, 0.01, 0.02, 0.03}, 1e-12);
  expect_values(record, "current", {0.01, 0.02, 0.03, 0.03}, 1e-12);
  expect_values(record, "string1", {0.1, 0.1, 0.1, 0.1}, 1e-12);
  expect_values(record, "string4", {0.4, 0.4, 0.4, 0.4}, 1e-12);
}

TEST(Candump, readings_of_two_nodes_make_one_row_and_a_lost_one_is_refused) {
  for (const bool fd : {false, true}) {
    const std::string node = fd ? "PISTONS_" : "PISTON_2_";
    const std::string end = fd ? "_FD" : "";
    const char* const piston = fd ? "piston_2" : "piston";
    const auto row = [&](std::uint8_t i, const char* reading, double value) {
      return line(5.0 + 0.001 * i, node + reading + end, i, {{piston, value}});
    };
    const auto sync = [&](std::uint8_t i) {
      return line(5.0005 + 0.001 * i, fd ? "SERVOVALVE_COMMAND_FD" : "SERVOVALVE_COMMAND", i, {{"current_2", 0.01}});
    };
    const std::string two =
        sync(0) + row(0, "A", 0.01) + row(0, "B", 0.03) + sync(1) + row(1, "A", 0.02) + row(1, "B", 0.04);
    const Record record = load(two + sync(2) + row(2, "A", 0.05), {2, 0.0});
    expect_values(record, "piston", {0.02, 0.03}, 1e-12);
    expect_message(refused(two + row(2, "A", 0.0) + row(3, "A", 0.0) + row(3, "B", 0.0), {2, 0.0}),
                   {"run.log:8", "B", "lost"});
    expect_message(refused(two + row(2, "A", 0.0) + row(1, "B", 0.0), {2, 0.0}), {"run.log:8", "counter 1", "one counter"});
    expect_message(refused(two + reading(5.003, 0, 0.0), {2, 0.0}), {"run.log:7", "layout"});
  }
}

TEST(Candump, load_pressure_belongs_to_the_reading_with_its_counter) {
  const std::string before = pressure(99.9999, 253, 9e6) + reading(99.999, 254, 0.0) + command(100.0, 254, 0.001);
  const std::string two = reading(100.0, 255, 0.01) + pressure(100.0002, 255, 1e6) + command(100.0005, 255, 0.002) +
                          reading(100.001, 0, 0.02) + pressure(100.0012, 0, -2e6);
  // The last reading has none yet, and the first was sent by a plant that had not begun to.
  const Record record = load(before + two + reading(100.002, 1, 0.03));
  expect_values(record, "piston", {0.01, 0.02}, 1e-12);
  expect_values(record, "load_pressure", {1e6, -2e6}, 1e-6);
  expect_message(refused(two + reading(100.002, 1, 0.03) + reading(100.003, 2, 0.04) + pressure(100.0031, 2, 0.0)),
                 {"run.log:7: LOAD_PRESSURES: none with the counter 1 of PISTON_1: frames are lost"});
  expect_message(refused(two + pressure(100.0013, 0, 0.0)), {"run.log:6: LOAD_PRESSURES: counter 0 after PISTON_1 0"});
  expect_message(refused(two + reading(100.002, 1, 0.03) + pressure(100.0013, 0, 0.0)),
                 {"run.log:7: LOAD_PRESSURES: counter 0 after PISTON_1 1", "one after each reading"});
  std::string fd;
  for (std::uint8_t i = 0; i < 3; ++i) {
    fd += line(5.0 + 0.001 * i, "PISTONS_FD", i, {{"piston_6_a", 0.01}, {"piston_6_b", 0.01}}) +
          line(5.0001 + 0.001 * i, "LOAD_PRESSURES_FD", i, {{"load_pressure_6", 1e6 * i}}) +
          line(5.0002 + 0.001 * i, "SERVOVALVE_COMMAND_FD", i, {{"current_6", 0.01}});
  }
  expect_values(load(fd, {6, 0.0}), "load_pressure", {0.0, 1e6, 2e6}, 1e-6);
}

TEST(Candump, what_is_written_is_read_back_within_half_a_code_of_each_signal) {
  Record record{"run.csv", "run.csv", 1000.0, 0.001, 2000, {}};
  for (const char* name : {"command", "piston", "string1", "string2", "string3", "string4"}) {
    Channel channel{name, name == std::string("command") ? "rad" : "m", {}};
    for (std::size_t row = 0; row < record.rows; ++row) {
      channel.values.push_back(0.1 * std::sin(0.01 * static_cast<double>(row) + static_cast<double>(channel.name.back())));
    }
    record.channels.push_back(std::move(channel));
  }
  Channel pressure{"load_pressure", "Pa", {}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    pressure.values.push_back(1e7 * std::sin(0.02 * static_cast<double>(row)));
  }
  record.channels.push_back(std::move(pressure));
  const CandumpOptions options{2, 5.0};
  write_candump(record, scratch.path("back.log"), options);
  const Record back = load_record_or_log(scratch.path("back.log"), options);
  UNSIGNED_LONGS_EQUAL(record.rows, back.rows);
  DOUBLES_EQUAL(record.start, back.start, 1e-6);
  DOUBLES_EQUAL(record.period, back.period, 0.0);
  for (const Channel& channel : record.channels) {
    const double half_a_code = channel.name == "command"         ? 0.5 * 5.0 * 1e-6
                               : channel.name == "load_pressure" ? 0.5 * 10.0
                                                                 : 0.5 * 1e-7;
    for (std::size_t row = 0; row < record.rows; ++row) {
      DOUBLES_EQUAL(channel.values[row], back.find(channel.name)->values[row], 1.001 * half_a_code);
    }
  }
  write_candump(back, scratch.path("again.log"), options);
  const auto content = [this](const char* name) {
    std::ifstream file(scratch.path(name));
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  STRCMP_EQUAL(content("back.log").c_str(), content("again.log").c_str());
}

TEST(Candump, what_is_no_log_or_a_damaged_one_is_refused_with_its_line) {
  expect_message(refused(short_log() + "  can0  123   [2]  11 22\n"),
                 {"run.log:7", "no frame of a candump log", "candump -L"});
  expect_message(refused("(1.0) can0 123#1\n"), {"run.log:1", "no frame"});
  std::string damaged = short_log();
  char& digit = damaged[damaged.find("180#") + 8];
  digit = digit == '0' ? '1' : '0';
  expect_message(refused(damaged), {"run.log:2: PISTON_1: its check is wrong"});
  expect_message(refused(short_log() + reading(100.004, 3, 0.0)),
                 {"run.log:7: PISTON_1: counter 3 after 1: frames are lost"});
  expect_message(refused(short_log() + command(100.004, 2, 0.0)), {"run.log:7: SERVOVALVE_COMMAND: counter 2 after 0"});
  expect_message(refused(short_log() + "(100.1) can1 180#0000000000000000\n"), {"run.log:7: interface can1 after can0"});
  expect_message(refused(short_log() + "(100.1) can0 180#00\n"), {"run.log:7: PISTON_1: 1 bytes; allowed: 8"});
  expect_message(refused(short_log() + line(100.1, "PISTONS_FD", 0, {})), {"run.log:7", "FD layout after"});
  expect_message(refused(short_log() + reading(100.1, 2, 0.0)), {"reading 2 is stamped 100.001200", "half a period off"});
  expect_message(refused(command(1.0, 0, 0.0)), {"0 readings of actuator 1", "PISTON_1"});
  expect_message(refused(short_log(), {3, 0.0}), {"run.log:1", "no actuator 3; allowed: 1, 2"});
}

TEST(Candump, value_that_no_frame_can_carry_is_refused_and_leaves_no_file) {
  const Record record{"x.csv", "x.csv", 0.0, 0.001, 2, {{"piston", "m", {0.0, 0.9}}, {"current", "A", {0.0, 0.0}}}};
  expect_message(refusal([&] { write_candump(record, scratch.path("x.log")); }),
                 {"x.csv: row 2: piston_a = 0.9 m cannot be sent; allowed: -0.8 to 0.8"});
  CHECK(!std::filesystem::exists(scratch.path("x.log")));
  const Record no_current{"x.csv", "x.csv", 0.0, 0.001, 2, {{"piston", "m", {0.0, 0.0}}, {"command", "rad", {0.0, 0.0}}}};
  expect_message(refusal([&] { write_candump(no_current, scratch.path("x.log")); }), {"no column current", "rad/A"});
}

}  // namespace hotfire
