// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/dbc.hpp"

#include <array>
#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;
using test::refusal;

namespace {

std::string refused_dbc(const std::string& text) {
  return refusal([&] { read_dbc(text, "rig.dbc"); });
}

/// A message of eight bytes with this signal.
Dbc with_signal(const std::string& signal, const std::string& after = "") {
  return read_dbc("BO_ 256 A: 8 X\n SG_ " + signal + "\n" + after, "rig.dbc");
}

double value(const Dbc& dbc, const std::array<std::uint8_t, 8>& data) {
  return dbc.messages.front().signals.front().physical(data);
}

}  // namespace

TEST_GROUP(Dbc){};

TEST(Dbc, integers_of_both_byte_orders_and_signs_are_read_where_they_lie) {
  const std::array<std::uint8_t, 8> data{0x12, 0x34, 0xF6, 0x78, 0, 0, 0, 0};
  DOUBLES_EQUAL(0x3412, value(with_signal("s : 0|16@1+ (1,0) [0|0] \"\" X"), data), 0.0);
  DOUBLES_EQUAL(0x1234, value(with_signal("s : 7|16@0+ (1,0) [0|0] \"\" X"), data), 0.0);
  DOUBLES_EQUAL(0x234F, value(with_signal("s : 3|16@0+ (1,0) [0|0] \"\" X"), data), 0.0);
  DOUBLES_EQUAL(0x4F - 0x80, value(with_signal("s : 10|7@0- (1,0) [0|0] \"\" X"), data), 0.0);
  DOUBLES_EQUAL(-10.0, value(with_signal("s : 16|8@1- (1,0) [0|0] \"\" X"), data), 0.0);
  DOUBLES_EQUAL(100.0 - 0.5 * 0xF6, value(with_signal("s : 16|8@1+ (-0.5,100) [0|0] \"\" X"), data), 0.0);
}

TEST(Dbc, signals_of_64_bits_and_of_floating_point_are_read) {
  const std::array<std::uint8_t, 8> ones{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  DOUBLES_EQUAL(-1.0, value(with_signal("s : 0|64@1- (1,0) [0|0] \"\" X"), ones), 0.0);
  DOUBLES_EQUAL(18446744073709551616.0, value(with_signal("s : 7|64@0+ (1,0) [0|0] \"\" X"), ones), 0.0);
  const std::array<std::uint8_t, 8> single{0x00, 0x00, 0x20, 0xC0, 0, 0, 0, 0};  // -2.5
  DOUBLES_EQUAL(-5.0, value(with_signal("s : 0|32@1- (2,0) [0|0] \"\" X", "SIG_VALTYPE_ 256 s : 1;\n"), single), 0.0);
  const std::array<std::uint8_t, 8> twice{0x40, 0x04, 0, 0, 0, 0, 0, 0};  // 2.5
  DOUBLES_EQUAL(2.5, value(with_signal("s : 7|64@0- (1,0) [0|0] \"\" X", "SIG_VALTYPE_ 256 s: 2;\n"), twice), 0.0);
}

TEST(Dbc, range_is_kept_to_half_a_code_and_zero_to_zero_is_none) {
  const Dbc bounded = with_signal("s : 0|16@1+ (0.1,0) [0|10] \"\" X");
  CHECK(bounded.messages[0].signals[0].allows(10.04));
  CHECK(!bounded.messages[0].signals[0].allows(10.06));
  CHECK(!bounded.messages[0].signals[0].allows(-0.06));
  CHECK(with_signal("s : 0|16@1+ (0.1,0) [0|0] \"\" X").messages[0].signals[0].allows(6553.5));
}

TEST(Dbc, messages_have_ids_of_11_or_29_bits_cycle_times_and_formats) {
  const Dbc dbc = read_dbc(
      "VERSION \"\"\r\nBO_ 256 A: 8 X\r\nBO_ 2566844926 B: 64 Y\r\nBA_ \"GenMsgCycleTime\" BO_ 256 20;\r\nBA_ "
      "\"VFrameFormat\" BO_ 2566844926 15;\r\n",
      "rig.dbc");
  UNSIGNED_LONGS_EQUAL(20, dbc.find("A")->cycle_ms);
  UNSIGNED_LONGS_EQUAL(0x18FEF1FE, dbc.find("B")->id & ~kExtendedId);
  CHECK((dbc.find("B")->id & kExtendedId) != 0);
  LONGS_EQUAL(15, dbc.find("B")->frame_format);
  STRCMP_EQUAL("Y", dbc.find("B")->sender.c_str());
}

TEST(Dbc, comment_of_several_lines_and_signals_of_no_frame_are_left_out) {
  const Dbc dbc = read_dbc(
      "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 X\n SG_ spare : 0|8@1+ (1,0) [0|0] \"\" X\nBO_ 256 A: 8 X\nCM_ BO_ 256 "
      "\"Sent by\nBO_ the \\\"new\\\" board\n SG_ nothing\";\n",
      "rig.dbc");
  UNSIGNED_LONGS_EQUAL(2, dbc.messages.size());
  UNSIGNED_LONGS_EQUAL(0, dbc.find("A")->signals.size());
}

TEST(Dbc, multiplexed_signals_know_what_selects_them) {
  const Dbc dbc = with_signal("s m3 : 8|8@1+ (1,0) [0|0] \"\" X", " SG_ which M : 0|8@1+ (1,0) [0|0] \"\" X\n");
  const DbcMessage& message = dbc.messages.front();
  UNSIGNED_LONGS_EQUAL(3, *message.find("s")->selected_by);
  STRCMP_EQUAL("which", message.multiplexer()->name.c_str());
  CHECK(!message.has_extended_multiplexing);
  CHECK(with_signal("s m3M : 8|8@1+ (1,0) [0|0] \"\" X").messages[0].has_extended_multiplexing);
  CHECK(with_signal("s m3 : 8|8@1+ (1,0) [0|0] \"\" X", "SG_MUL_VAL_ 256 s which 3-5;\n")
            .messages[0]
            .has_extended_multiplexing);
}

TEST(Dbc, what_is_wrong_is_refused_with_file_and_line) {
  const auto refused_signal = [](const std::string& signal, const std::string& after = "") {
    return refusal([&] { with_signal(signal, after); });
  };
  expect_message(refused_dbc("\x7F"
                             "ELF"),
                 {"rig.dbc: no message; a DBC file has lines like BO_"});
  expect_message(refused_dbc("BO_ 256 A 8\n"), {"rig.dbc:1: not a message; allowed: BO_ id name: length sender"});
  expect_message(refused_dbc("BO_ 3000 A: 8 X\n"), {"rig.dbc:1: A: id 3000; allowed: 0 to 2047"});
  expect_message(refused_dbc("BO_ 1 A: 8 X\nBO_ 1 B: 8 X\n"), {"rig.dbc:2: B: its name or its id 1 is used before"});
  expect_message(refused_signal("s : 60|8@1+ (1,0) [0|0] \"\" X"), {"rig.dbc:2: s: bits 60 to 67 of a frame of 64"});
  expect_message(refused_signal("s : 56|16@0+ (1,0) [0|0] \"\" X"), {"rig.dbc:2: s: bits 63 to 78 of a frame of 64"});
  expect_message(refused_signal("s : 0|8@1+ (0,0) [0|0] \"\" X"), {"rig.dbc:2: s: factor 0"});
  expect_message(refused_signal("s : 0|8@1+ (1,0) [5|0] \"\" X"), {"rig.dbc:2: s: range 5 to 0"});
  expect_message(refused_signal("s : 0|8@1+ (one,0) [0|0] \"\" X"), {"rig.dbc:2: \"one\" is not a number"});
  expect_message(refused_signal("s"), {"rig.dbc:2: not a signal"});
  expect_message(refused_signal("s : 0|8@1+ (1,0) [0|0] \"\" X", "SIG_VALTYPE_ 256 s : 1;\n"),
                 {"rig.dbc:3: s: 8 bits; allowed: 32 for single"});
  expect_message(refused_signal("s : 0|8@1+ (1,0) [0|0] \"\" X", "SIG_VALTYPE_ 257 s : 1;\n"),
                 {"rig.dbc:3: of message 257, which is none"});
  expect_message(refused_dbc("BO_ 1 A: 8 X\nCM_ \"begun\n\n"), {"rig.dbc:2: a text begins here that never ends"});
  expect_message(refused_signal("s : 0|8@1+ (1,0) [0|0 \"\" X"), {"rig.dbc:2: not a signal"});
  expect_message(refused_signal("s : 0|8@1+ (1,0) [0|0] \"\" X", "SG_MUL_VAL_ 256 s which ;\n"),
                 {"rig.dbc:3: not multiplexing"});
  expect_message(refusal([] { load_dbc("/nowhere/rig.dbc"); }), {"/nowhere/rig.dbc: cannot be opened"});
}

TEST(Dbc, line_of_100_kB_is_refused_with_its_line_and_the_limit) {
  const std::string unit(100'000, 'x');
  expect_message(refused_dbc("BO_ 256 A: 8 X\n SG_ s : 0|8@1+ (1,0) [0|0] \"" + unit + "\" X\n"),
                 {"rig.dbc:2: a line of 1000", "allowed: up to 65536"});
  expect_message(refused_dbc("BO_ 256 A: 8 X\nCM_ \"" + unit + "\";\n"),
                 {"rig.dbc:2: a line of 100007", "allowed: up to 65536"});
}

TEST(Dbc, line_up_to_its_limit_is_read) {
  const std::string before = "s : 0|8@1+ (1,0) [0|0] \"";
  const std::string after = "\" X";
  const std::string unit(65536 - 5 - before.size() - after.size(), 'x');
  STRCMP_EQUAL(unit.c_str(), with_signal(before + unit + after).messages.front().signals.front().unit.c_str());
  expect_message(refused_dbc("BO_ 256 A: 8 X\n SG_ " + before + unit + "x" + after), {"rig.dbc:2: a line of 65537"});
}

TEST(Dbc, more_messages_or_signals_than_any_file_has_are_refused_where_they_begin) {
  std::string messages;
  for (int id = 0; id <= 10'000; ++id) {
    messages += "BO_ " + std::to_string(0x80000000U + static_cast<unsigned>(id)) + " M" + std::to_string(id) + ": 8 X\n";
  }
  expect_message(refused_dbc(messages), {"rig.dbc:10001: more than 10000 messages"});
  std::string signals = "BO_ 256 A: 8 X\n";
  for (int i = 0; i <= 1024; ++i) {
    signals += " SG_ s" + std::to_string(i) + " : 0|8@1+ (1,0) [0|0] \"\" X\n";
  }
  expect_message(refused_dbc(signals), {"rig.dbc:1026: A: more than 1024 signals"});
  expect_message(refused_dbc(std::string((16U << 20U) + 1, '\n')), {"rig.dbc:1: over 16777216 bytes"});
}

}  // namespace hotfire
