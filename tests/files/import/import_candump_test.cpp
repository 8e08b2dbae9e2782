// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/can/candump.hpp"
#include "tools/files/import/import.hpp"

namespace hotfire {

using test::expect_message;
using test::refusal;

namespace {

constexpr const char* kDbc = R"(VERSION "4"
BO_ 256 COMMAND: 4 Controller
 SG_ BETA_CMD : 0|16@1- (0.001,0) [-10|10] "deg" Drive
BO_ 2566844926 FEEDBACK: 8 Drive
 SG_ POSITION : 7|16@0- (0.01,0) [-200|200] "mm" Controller
 SG_ KIND M : 16|8@1+ (1,0) [0|0] "" Controller
 SG_ PRESSURE m1 : 24|32@1- (1,0) [0|0] "bar" Controller
 SG_ TEMPERATURE m2 : 24|32@1- (1,0) [0|0] "Schritte" Controller
BO_ 258 STATUS: 2 Drive
 SG_ POSITION : 0|8@1+ (1,0) [0|0] "mm" Controller
 SG_ UNUSED : 8|8@1+ (1,0) [0|0] "" Controller
BO_ 259 SPARE: 1 Drive
 SG_ NEVER : 0|8@1+ (1,0) [0|0] "mm" Controller
SIG_VALTYPE_ 2566844926 PRESSURE : 1;
BA_ "GenMsgCycleTime" BO_ 256 2;
)";

constexpr const char* kMap = R"(schema = 1
[can]
rows = "FEEDBACK"
[channels.command]
column = "BETA_CMD"
[channels.piston]
column = "FEEDBACK.POSITION"
unit = "mm"
factor = -1
)";

std::string little_endian(std::uint32_t bits, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    text += fmt::format("{:02X}", (bits >> (8 * i)) & 0xFFU);
  }
  return text;
}

std::string command(double time, double degrees) {
  const auto code = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(degrees / 0.001)));
  return fmt::format("({:.6f}) can0 100#{}0000\n", time, little_endian(code, 2));
}

std::string feedback(double time, double millimetres, int kind = 0, float more = 0.0F) {
  const auto code = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(millimetres / 0.01)));
  return fmt::format("({:.6f}) can0 18FEF1FE#{:04X}{:02X}{}00\n", time, code, kind,
                     little_endian(std::bit_cast<std::uint32_t>(more), 4));
}

/// Rows of 2 ms: the position is i mm, and the command after it i/10 degrees.
std::string log(int rows = 4) {
  std::string text = "(50.000000) can0 7FF#11\n(50.000000) can0 20000004#0000000000000000\n" + command(50.0, 0.9);
  for (int i = 0; i < rows; ++i) {
    text += feedback(50.001 + 0.002 * i, i) + command(50.0015 + 0.002 * i, 0.1 * i);
  }
  return text;
}

std::string with(std::string text, const std::string& old, const std::string& corrected) {
  return text.replace(text.find(old), old.size(), corrected);
}

}  // namespace

TEST_GROUP(ImportCandump) {
  test::Scratch scratch;

  Record imported(const std::string& map, const std::string& text, const std::string& dbc = kDbc) const {
    return import_record(scratch.write("rig.log", text),
                         load_import_map(scratch.write("map.toml", map), ImportSource::candump_log), scratch.path("rig.csv"),
                         scratch.write("rig.dbc", dbc));
  }
  std::string refused(const std::string& map, const std::string& text, const std::string& dbc = kDbc) const {
    return refusal([&] { imported(map, text, dbc); });
  }
  static void expect_values(const Record& record, const std::string& channel, std::initializer_list<double> values) {
    require_channel(record, channel, "wanted");
    UNSIGNED_LONGS_EQUAL(values.size(), record.rows);
    std::size_t row = 0;
    for (const double value : values) {
      DOUBLES_EQUAL(value, record.find(channel)->values[row++], 1e-9);
    }
  }
};

TEST(ImportCandump, row_is_a_frame_of_rows_with_the_command_that_holds_until_the_next) {
  const Record record = imported(kMap, log());
  DOUBLES_EQUAL(50.001, record.start, 1e-9);
  DOUBLES_EQUAL(0.002, record.period, 1e-9);
  constexpr double kDegree = std::numbers::pi / 180.0;
  expect_values(record, "command", {0.0, 0.1 * kDegree, 0.2 * kDegree, 0.3 * kDegree});
  expect_values(record, "piston", {0.0, -1e-3, -2e-3, -3e-3});
}

TEST(ImportCandump, measured_signal_of_another_message_is_the_newest_before_the_row) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("({:.6f}) can0 102#{:02X}00\n", 10.0 + 0.002 * i, 10 * i) + feedback(10.001 + 0.002 * i, i) +
            fmt::format("({:.6f}) can0 102#{:02X}00\n", 10.0015 + 0.002 * i, 10 * i + 5);
  }
  expect_values(
      imported("schema = 1\n[can]\nrows = \"FEEDBACK\"\n[channels]\npiston = {column = \"STATUS.POSITION\"}\n", text),
      "piston", {0.0, 0.010, 0.020});
}

TEST(ImportCandump, signals_of_one_message_need_no_rows_and_a_multiplexed_one_is_held_between_its_frames) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    text += feedback(1.0 + 0.001 * i, i, 1 + i % 2, static_cast<float>(i));
  }
  const Record record = imported(
      "schema = 1\n[channels]\npiston = {column = \"FEEDBACK.POSITION\"}\nload_pressure = {column = \"PRESSURE\"}\n", text);
  expect_values(record, "piston", {0.0, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3});
  expect_values(record, "load_pressure", {0.0, 0.0, 2e5, 2e5, 4e5, 4e5});
}

TEST(ImportCandump, log_of_our_own_frames_gives_what_convert_reads_of_it) {
  Record record{"run.csv", "run.csv", 1000.0, 0.001, 50, {{"piston", "m", {}}, {"current", "A", {}}}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[0].values.push_back(1e-3 * static_cast<double>(row));
    record.channels[1].values.push_back(1e-4 * static_cast<double>(row));
  }
  write_candump(record, scratch.path("own.log"), {});
  const Record own = load_candump(scratch.path("own.log"), {});
  const auto map = load_import_map(
      scratch.write(
          "map.toml",
          "schema = 1\n[can]\nrows = \"PISTON_1\"\n[channels]\ncurrent = {column = \"SERVOVALVE_COMMAND.current_1\"}\n"
          "piston = {column = \"PISTON_1.piston_a\"}\n"),
      ImportSource::candump_log);
  const Record read = import_record(scratch.path("own.log"), map, scratch.path("own.csv"), HOTFIRE_CAN_MAP);
  UNSIGNED_LONGS_EQUAL(own.rows, read.rows);
  DOUBLES_EQUAL(own.start, read.start, 1e-9);
  DOUBLES_EQUAL(own.period, read.period, 1e-9);
  for (const Channel& channel : own.channels) {
    for (std::size_t row = 0; row < own.rows; ++row) {
      DOUBLES_EQUAL(channel.values[row], read.find(channel.name)->values[row], 1e-12);
    }
  }
}

TEST(ImportCandump, log_without_a_dbc_file_is_refused_with_the_remedy) {
  const auto source = scratch.write("rig.log", log());
  expect_message(test::refusal<UsageError>([&] { import_source(source, ""); }),
                 {"rig.log: is a candump log", "--dbc rig.dbc", "hotfire convert"});
  CHECK(ImportSource::table == import_source(scratch.write("table.log", "(a) b,c#d\n1,2\n"), ""));
}

TEST(ImportCandump, signal_that_is_not_in_the_dbc_file_is_refused_with_the_nearest) {
  expect_message(refused(with(kMap, "BETA_CMD", "beta_cnd"), log()),
                 {"map.toml:4: channels.command: no signal \"beta_cnd\" in", "rig.dbc; nearest: BETA_CMD, "});
  expect_message(refused(with(kMap, "FEEDBACK.POSITION", "FEEDBACK.POSITIONS"), log()),
                 {"no signal \"FEEDBACK.POSITIONS\"", "nearest: FEEDBACK.POSITION, "});
  expect_message(refused(with(kMap, "FEEDBACK.POSITION", "POSITION"), log()),
                 {"channels.piston: several messages", "FEEDBACK.POSITION, STATUS.POSITION"});
  expect_message(refused(with(kMap, "\"FEEDBACK\"", "\"FEDBACK\""), log()),
                 {"map.toml: can.rows = \"FEDBACK\"", "nearest: FEEDBACK"});
  expect_message(refused(with(kMap, "rows = \"FEEDBACK\"\n", ""), log()),
                 {"map.toml: can.rows: missing", "COMMAND, FEEDBACK", "[can] rows ="});
}

TEST(ImportCandump, signal_that_never_occurs_is_refused_with_the_messages_that_do) {
  expect_message(refused(with(kMap, "FEEDBACK.POSITION", "NEVER"), log()),
                 {"rig.log: SPARE.NEVER of channel piston never occurs (id 103)", "there are: COMMAND, FEEDBACK"});
  expect_message(refused(with(kMap, "\"FEEDBACK\"", "\"SPARE\""), log()),
                 {"SPARE, whose frames make the rows, never occurs"});
  expect_message(refused("schema = 1\n[channels]\nload_pressure = {column = \"PRESSURE\"}\n", log()),
                 {"FEEDBACK.PRESSURE of channel load_pressure never occurs"});
}

TEST(ImportCandump, unit_is_that_of_the_dbc_file_or_agrees_with_it) {
  expect_message(refused(with(kMap, "unit = \"mm\"", "unit = \"m\""), log()),
                 {"map.toml:6: channels.piston: unit = \"m\"", "rig.dbc:5", "\"mm\"", "leave unit out"});
  const Record scaled = imported(with(with(kMap, "unit = \"mm\"", "unit = \"m\""), "factor = -1", "factor = 0.001"), log());
  DOUBLES_EQUAL(3e-3, scaled.find("piston")->values[3], 1e-12);
  expect_message(refused(with(with(kMap, "FEEDBACK.POSITION", "TEMPERATURE"), "unit = \"mm\"\n", ""), log()),
                 {"map.toml:6: channels.piston: unit: missing", "\"Schritte\", which is not a known unit"});
}

TEST(ImportCandump, what_is_no_line_of_a_log_or_no_frame_of_its_message_is_refused_with_its_line) {
  expect_message(refused(kMap, log() + "  can0  100   [2]  11 22\n"), {"rig.log:12", "no frame of a candump log"});
  expect_message(refused(kMap, log() + "(50.009) can0 100#0000\n"), {"rig.log:12: COMMAND: 2 bytes", "rig.dbc:2 has 4"});
  expect_message(refused(kMap, log() + "(50.009) can1 100#00000000\n"), {"rig.log:12: COMMAND: interface can1 after can0"});
  expect_message(refused(kMap, log() + command(50.009, 10.1)),
                 {"rig.log:12: COMMAND.BETA_CMD = 10.1 deg", "rig.dbc:3 allows -10 to 10"});
  const std::string pressure = "schema = 1\n[channels]\nload_pressure = {column = \"PRESSURE\"}\n";
  expect_message(refused(pressure, feedback(1.0, 0.0, 1, std::nanf(""))), {"rig.log:1: FEEDBACK.PRESSURE = nan bar"});
}

TEST(ImportCandump, lost_frames_are_refused_with_their_line_and_late_ones_are_not) {
  const std::string lost = with(log(8), feedback(50.003, 1), "");
  expect_message(refused(kMap, lost), {"rig.log:7: FEEDBACK: 0.004 s after the one before: frames are lost"});
  UNSIGNED_LONGS_EQUAL(8, imported(kMap, with(log(8), feedback(50.003, 1), feedback(50.0034, 1))).rows);
  std::string silent = log();
  for (int i = 4; i < 8; ++i) {
    silent += feedback(50.001 + 0.002 * i, i);
  }
  expect_message(refused(kMap, silent), {"rig.log:14: COMMAND: silent for 0.0055 s", "rig.dbc:2 has it every 0.002 s"});
  UNSIGNED_LONGS_EQUAL(8, imported(kMap, silent, with(kDbc, "BA_ \"GenMsgCycleTime\" BO_ 256 2;\n", "")).rows);
}

TEST(ImportCandump, frame_lost_at_even_distances_is_found_however_even_the_rest_is) {
  std::string text;
  for (int i = 0; i < 100; ++i) {
    text += i % 10 == 5 ? "" : feedback(1.0 + 0.001 * i, 0.0);
  }
  expect_message(refused("schema = 1\n[channels]\npiston = {column = \"FEEDBACK.POSITION\"}\n", text),
                 {"rig.log:6: FEEDBACK: 0.002 s after"});
}

TEST(ImportCandump, map_of_a_log_has_no_times_and_one_of_a_table_no_rows) {
  const std::string channel = "[channels.piston]\ncolumn = \"FEEDBACK.POSITION\"\nunit = \"mm\"\n";
  expect_message(refused("schema = 1\nperiod = \"2 ms\"\n" + channel, log()), {"map.toml:2", "period", "leave it out"});
  expect_message(refused("schema = 1\n[csv]\nskip_lines = 1\n" + channel, log()), {"map.toml:2", "csv", "leave it out"});
  expect_message(refused("schema = 1\n[can]\nrow = \"A\"\n" + channel, log()), {"map.toml:3", "can.row", "rows"});
  expect_message(refused("schema = 1\n[channels]\n", log()), {"map.toml", "channels", "missing"});
  expect_message(
      refusal([&] {
        load_import_map(scratch.write("map.toml", "schema = 1\nperiod = \"2 ms\"\n[can]\nrows = \"A\"\n" + channel));
      }),
      {"map.toml:3", "can", "--dbc"});
}

}  // namespace hotfire
