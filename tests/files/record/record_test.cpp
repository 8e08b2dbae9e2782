// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/record.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <tuple>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;

TEST_GROUP(Record) {
  test::Scratch scratch;

  Record load(const std::string& content) const { return load_record(scratch.write("r.csv", content)); }
  std::string refused(const std::string& content) const {
    return test::refusal([&] { load(content); });
  }
  /// What this process has read from files since it began.
  static std::uintmax_t bytes_read() {
    std::ifstream counts("/proc/self/io");
    std::string name;
    std::uintmax_t count = 0;
    counts >> name >> count;
    CHECK(counts.good() && name == "rchar:");
    return count;
  }
  /// Rows of a piston record at these times.
  static std::string at_times(std::initializer_list<const char*> times) {
    std::string text = "time[s],piston[m]\n";
    for (const char* time : times) {
      text += std::string{time} + ",0\n";
    }
    return text;
  }
};

TEST(Record, has_its_channels_in_file_order_with_start_period_and_rows) {
  const Record record = load(
      "time[s],command[rad],piston[m]\n1.000,0,1e-3\n1."
      "002,-0.5,2e-3\n1.004,+0.5,3e-3\n");
  STRCMP_EQUAL("r.csv", record.name.c_str());
  LONGS_EQUAL(3, record.rows);
  DOUBLES_EQUAL(1.0, record.start, 0.0);
  DOUBLES_EQUAL(0.002, record.period, 1e-15);
  LONGS_EQUAL(2, record.channels.size());
  STRCMP_EQUAL("command", record.channels[0].name.c_str());
  DOUBLES_EQUAL(-0.5, record.channels[0].values[1], 0.0);
  DOUBLES_EQUAL(0.5, record.channels[0].values[2], 0.0);
  DOUBLES_EQUAL(3e-3, record.find("piston")->values[2], 0.0);
  POINTERS_EQUAL(nullptr, record.find("engine"));
}

TEST(Record, is_converted_to_si_by_the_units_of_its_header) {
  const Record record = load(
      "time[ms],command[deg],piston[mm],load_pressure["
      "psi]\n0,180,1,1\n2,90,2,2\n");
  DOUBLES_EQUAL(0.002, record.period, 1e-15);
  DOUBLES_EQUAL(3.14159265358979, record.find("command")->values[0], 1e-12);
  DOUBLES_EQUAL(0.002, record.find("piston")->values[1], 1e-15);
  DOUBLES_EQUAL(6894.757293168, record.find("load_pressure")->values[0], 1e-4);
  STRCMP_EQUAL("rad", record.find("command")->unit.c_str());
}

TEST(Record, force_and_position_keep_their_own_unit) {
  const Record record = load("time[s],force[V],position[mm]\n0,1,2\n0.001,3,4\n");
  STRCMP_EQUAL("V", record.find("force")->unit.c_str());
  STRCMP_EQUAL("mm", record.find("position")->unit.c_str());
  DOUBLES_EQUAL(4.0, record.find("position")->values[1], 0.0);
}

TEST(Record, may_have_comments_first_a_byte_order_mark_crlf_spaces_and_no_last_newline) {
  LONGS_EQUAL(2, load("\xEF\xBB\xBF# stand 3\r\n# run 12\r\ntime[s], "
                      "piston[m]\r\n0 , 1\r\n0.002,\t2")
                     .rows);
  LONGS_EQUAL(2, load("time[s],piston[m]\n0,1\n0.002,2\n\n\n").rows);
}

TEST(Record, written_and_read_back_has_the_same_bits) {
  Record record{scratch.path("out.csv"), "out.csv", 0.1, 0.002, 0, {{"piston", "m", {}}, {"force", "V", {}}}};
  std::uint64_t random = 88172645463325252U;
  for (record.rows = 0; record.rows < 20000; ++record.rows) {
    for (Channel& channel : record.channels) {
      random ^= random << 13;
      random ^= random >> 7;
      random ^= random << 17;
      const double value = std::bit_cast<double>(random);
      channel.values.push_back(std::isnormal(value) ? value : -0.0);
    }
  }
  write_record(record, record.path);
  const Record again = load_record(record.path);
  DOUBLES_EQUAL(record.start, again.start, 0.0);
  DOUBLES_EQUAL(record.period, again.period, 1e-15);
  for (std::size_t i = 0; i < record.channels.size(); ++i) {
    STRCMP_EQUAL(record.channels[i].unit.c_str(), again.channels[i].unit.c_str());
    MEMCMP_EQUAL(record.channels[i].values.data(), again.channels[i].values.data(), record.rows * sizeof(double));
  }
}

TEST(Record, times_of_a_whole_rate_or_a_period_in_nanoseconds_are_their_decimal_digits) {
  // Rate or period, and the start in periods: 1 kHz, 3 kHz, 610.3515625 Hz, 20 kHz.
  for (const auto& [ticks, step, first] :
       {std::tuple{1e3, 1.0, 250.0}, {3e3, 1.0, 0.0}, {1e9, 1638400.0, 0.0}, {2e4, 1.0, 7.0}}) {
    const Record record{{}, "", first / ticks, step / ticks, 5000, {}};
    const std::vector<double> times = times_of(record);
    for (std::size_t row = 0; row < record.rows; ++row) {
      DOUBLES_EQUAL((first + static_cast<double>(row) * step) / ticks, times[row], 0.0);
    }
  }
  const std::vector<double> odd = times_of({{}, "", 0.1, 1e-3 / 3.1415, 100, {}});
  DOUBLES_EQUAL(0.1 + 99 * 1e-3 / 3.1415, odd.back(), 1e-15);
}

TEST(Record, is_written_whole_or_not_at_all) {
  const Record record{{}, "", 0.0, 0.001, 1, {{"piston", "m", {0.0}}}};
  expect_message(test::refusal([&] { write_record(record, scratch.path("no/such/folder.csv")); }),
                 {"folder.csv", "No such file"});
  expect_message(test::refusal([&] { write_record(record, "/dev/null"); }), {"/dev/null", "not a regular file"});
  write_record(record, scratch.path("one.csv"));
  LONGS_EQUAL(1,
              std::distance(std::filesystem::directory_iterator(scratch.path("")), std::filesystem::directory_iterator{}));
}

TEST(Record, that_does_not_exist_or_is_a_folder_is_refused) {
  expect_message(test::refusal([&] { load_record(scratch.path("none.csv")); }), {"none.csv", "No such file"});
  expect_message(test::refusal([&] { load_record(scratch.path("")); }), {"directory"});
}

TEST(Record, that_is_empty_or_has_no_rows_is_refused) {
  expect_message(refused(""), {"r.csv:1:", "empty file", "time[s],command[rad]"});
  expect_message(refused("# only a comment\n"), {"r.csv:1:", "no header"});
  expect_message(refused("time[s],piston[m]\n"), {"r.csv:1:", "0 rows", "at least 2"});
  expect_message(refused("time[s],piston[m]\n0,0\n"), {"r.csv:2:", "1 rows", "at least 2"});
}

TEST(Record, with_an_unknown_channel_is_refused_with_the_nearest_known_one) {
  expect_message(refused("# a\ntime[s],pistn[m]\n0,0\n"),
                 {"r.csv:2:", "column 2", "pistn", "did you mean \"piston\"?", "load_pressure"});
  expect_message(refused("hello world\n"), {"r.csv:1:", "column 1", "hello world", "unknown channel"});
}

TEST(Record, of_a_vibration_has_the_unit_of_a_slip_where_it_names_an_axis) {
  STRCMP_EQUAL("m/s^2", load("time[s],vibration[m/s^2]\n0,1\n0.001,2\n0.002,3\n").channels[0].unit.c_str());
  const Channel slip = load("time[s],vibration.yaw[deg/s]\n0,180\n0.001,2\n0.002,3\n").channels[0];
  STRCMP_EQUAL("rad/s", slip.unit.c_str());
  DOUBLES_EQUAL(3.14159265358979, slip.values[0], 1e-12);
}

TEST(Record, of_an_axis_that_there_is_not_is_refused) {
  expect_message(refused("time[s],command.roll[deg]\n0,0\n"), {"r.csv:1:", "column 2", "command.roll", "no axis", ".pitch"});
  expect_message(refused("time.pitch[s],command[deg]\n0,0\n"), {"r.csv:1:", "column 1", "time.pitch"});
  expect_message(refused("time[s],string2.pitch[m]\n0,0\n"),
                 {"r.csv:1:", "column 2", "string2.pitch", "no engine", ".engine1"});
}

TEST(Record, with_a_wrong_unit_is_refused_with_the_units_allowed) {
  expect_message(refused("time[s],piston[rad]\n0,0\n"), {"r.csv:1:", "column 2", "\"rad\"", "convert to m"});
  expect_message(refused("time[s],piston[parsnip]\n0,0\n"),
                 {"r.csv:1:", "column 2", "\"parsnip\"", "not known", "convert to m"});
  expect_message(refused("time[s],force[parsnip]\n0,0\n"), {"r.csv:1:", "column 2", "\"parsnip\"", "any unit"});
  expect_message(refused("time[s],piston\n0,0\n"), {"r.csv:1:", "column 2", "unit is missing", "write piston[m]"});
}

TEST(Record, without_time_or_with_a_channel_named_twice_is_refused) {
  expect_message(refused("command[rad],piston[m]\n0,0\n"), {"r.csv:1:", "no time column"});
  expect_message(refused("time[s],piston[m],piston[mm]\n0,0,0\n"), {"r.csv:1:", "column 3", "piston", "named twice"});
  expect_message(refused("time[s]\n0\n"), {"r.csv:1:", "no channel except time"});
}

TEST(Record, with_a_ragged_row_is_refused_with_both_counts) {
  expect_message(refused("time[s],piston[m]\n0,0\n0.001\n"), {"r.csv:3:", "ragged row", "1 cells", "allowed: 2"});
  expect_message(refused("time[s],piston[m]\n0,0\n0.001,1,2\n"), {"r.csv:3:", "ragged row", "3 cells", "allowed: 2"});
  expect_message(refused("time[s],piston[m]\n0,0\n\n0.001,1\n"), {"r.csv:4:", "blank line 3"});
}

TEST(Record, with_a_cell_that_is_not_a_finite_number_is_refused_with_line_column_and_value) {
  for (const std::string bad : {"nan", "inf", "-inf", "", "abc", "1.5x", "1;2", "1 2", "0x10", "1e999", "--1", "+-1"}) {
    const std::string message = refused("time[s],piston[m]\n0,0\n0.001," + bad + "\n");
    expect_message(message, {"r.csv:3:", "column piston", "not a finite number", ("\"" + bad).c_str()});
  }
  expect_message(refused("time[s],piston[m]\nnan,0\n"), {"r.csv:2:", "column time", "\"nan\""});
}

TEST(Record, with_a_gap_a_repeated_or_a_backward_time_is_refused_with_line_and_both_times) {
  expect_message(refused(at_times({"0.000", "0.001", "0.002", "0.007", "0.008", "0.009"})),
                 {"r.csv:5:", "column time", "0.007 s after 0.002 s", "gap of 4 rows", "uniform sampling"});
  expect_message(refused(at_times({"0.000", "0.001", "0.003", "0.004"})),
                 {"r.csv:4:", "0.003 s after 0.001 s", "gap of 1 rows"});
  expect_message(refused(at_times({"0.000", "0.001", "0.001", "0.002"})),
                 {"r.csv:4:", "0.001 s after 0.001 s", "repeated time"});
  expect_message(refused(at_times({"0.000", "0.002", "0.001", "0.003"})), {"r.csv:4:", "0.001 s after 0.002 s", "backward"});
}

TEST(Record, may_lack_values_and_rows_in_a_declared_drop_out_and_there_alone) {
  const std::string text =
      "time[s],command[rad],piston[m]\n0,0,1\n0.002,nan,2\n0.004,,ERR\n0.016,4,5\n0.018,5,6\n0.020,6,7\n";
  const auto load = [&](double from, double to) { return load_record(scratch.write("r.csv", text), {DropOut{from, to}}); };
  const Record record = load(0.002, 0.016);
  LONGS_EQUAL(11, record.rows);
  DOUBLES_EQUAL(0.002, record.period, 1e-12);
  const std::vector<double>& piston = record.find("piston")->values;
  DOUBLES_EQUAL(2.0, piston[1], 0.0);
  CHECK(std::isnan(record.find("command")->values[1]));
  for (std::size_t row = 2; row < 8; ++row) {
    CHECK(std::isnan(piston[row]));
  }
  DOUBLES_EQUAL(5.0, piston[8], 0.0);

  expect_message(test::refusal([&] { load(0.002, 0.004); }), {":4:", "column command"});
  expect_message(test::refusal([&] { load(0.002, 0.012); }), {":5:", "gap of 5 rows", "--exclude"});
  expect_message(test::refusal([&] { load_record(scratch.write("r.csv", text)); }), {":3:", "column command", "nan"});
}

// Stamped to the millisecond 300 Hz is 3, 3 and 4 ms. Two stretches that touch are one.
TEST(Record, has_as_many_lost_rows_as_its_rate_asks_for_however_its_times_are_rounded) {
  std::string text = "time[s],piston[m]\n";
  for (int row = 0; row < 3000; ++row) {
    const double time = row / 300.0;
    if (time < 5.0 || time >= 6.0) {
      text += std::to_string(std::round(time * 1e3) / 1e3).substr(0, 5) + ",0\n";
    }
  }
  const Record record = load_record(scratch.write("r.csv", text), {DropOut{4.99, 5.5}, DropOut{5.5, 6.01}});
  LONGS_EQUAL(3000, record.rows);
  DOUBLES_EQUAL(1.0 / 300.0, record.period, 1e-6);
}

TEST(Record, gap_at_a_rate_that_no_record_may_have_is_not_filled) {
  // A gap of half a millisecond at nanoseconds would be half a million rows, twice.
  std::vector<std::vector<double>> columns{{0.0, 1e-9, 2e-9, 3e-9, 0.0005, 0.001}};
  RowLines lines(2);
  put_lost_rows({DropOut{0.0, 1.0}}, 0, columns, lines);
  UNSIGNED_LONGS_EQUAL(6, columns.front().size());
  columns = {{0.0, 0.001, 0.002, 0.003, 0.012, 0.013}};
  put_lost_rows({DropOut{0.0, 1.0}}, 0, columns, lines);
  UNSIGNED_LONGS_EQUAL(14, columns.front().size());
}

TEST(Record, beyond_a_drop_out_is_refused_with_the_line_that_the_file_has) {
  const std::string text = "time[s],piston[m]\n0,0\n0.002,0\n0.010,0\n0.012,0\n0.0145,0\n0.0165,0\n";
  expect_message(test::refusal([&] {
                   load_record(scratch.write("r.csv", text), {DropOut{0.003, 0.010}});
                 }),
                 {":6:", "0.0145 s after 0.012 s"});
}

TEST(Record, sampled_unevenly_is_refused_at_the_first_interval_that_is_off) {
  expect_message(refused(at_times({"0.0000", "0.0010", "0.0020", "0.0032", "0.0040", "0.0050"})),
                 {"r.csv:5:", "0.0032 s after 0.002 s", "interval 0.0012 s", "period is 0.001 s"});
}

TEST(Record, whose_times_are_rounded_in_print_is_read) {
  std::string fixed = "time[s],piston[m]\n";
  std::string general = fixed;
  for (int row = 0; row < 20000; ++row) {
    char cell[64];
    std::snprintf(cell, sizeof cell, "%.4f,0\n", row / 600.0);
    fixed += cell;
    std::snprintf(cell, sizeof cell, "%.6g,0\n", row * 0.0016384);
    general += cell;
  }
  DOUBLES_EQUAL(1.0 / 600.0, load(fixed).period, 1e-8);
  DOUBLES_EQUAL(0.0016384, load(general).period, 1e-8);
}

TEST(Record, sampled_outside_50_Hz_to_20_kHz_is_refused_with_its_rate) {
  expect_message(refused(at_times({"0", "0.025", "0.05"})), {"r.csv:2:", "40 Hz", "50 Hz to 20 kHz"});
  expect_message(refused(at_times({"0", "0.00004", "0.00008"})), {"r.csv:2:", "25000 Hz", "50 Hz to 20 kHz"});
  LONGS_EQUAL(3, load(at_times({"0", "0.02", "0.04"})).rows);
  LONGS_EQUAL(3, load(at_times({"0", "0.00005", "0.0001"})).rows);
}

TEST(Record, that_is_binary_is_refused_at_once_whatever_its_size) {
  const std::filesystem::path path = scratch.write("huge.csv", "");
  std::filesystem::resize_file(path, std::uintmax_t{2} << 30);
  const std::uintmax_t before = bytes_read();
  expect_message(test::refusal([&] { load_record(path); }), {"huge.csv:1:", "not CSV", "0x00"});
  CHECK(bytes_read() - before < std::uintmax_t{1} << 20);
  expect_message(refused("time[s],piston[m]\n0,\x01\n"), {"r.csv:2:", "not CSV", "0x01"});
}

TEST(Record, with_a_line_that_never_ends_is_refused) {
  expect_message(refused("time[s],piston[m]\n0," + std::string(1 << 20, '1') + "\n"),
                 {"r.csv:2:", "not CSV", "line of over"});
}

TEST(Record, without_a_channel_that_is_needed_is_refused_with_what_it_has) {
  const Record record = load(at_times({"0", "0.001"}));
  expect_message(test::refusal([&] { require_channel(record, "command", "a simplex model is driven by it"); }),
                 {"r.csv:1:", "no column command", "driven by it", "has piston[m]"});
  require_channel(record, "piston", "");
}

}  // namespace hotfire
