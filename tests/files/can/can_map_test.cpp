// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/can_map.hpp"

#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/own_map.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;
using test::own_map;
using test::refusal;

namespace {

const std::string kProtection =
    " SG_ crc8 : 0|8@1+ (1,0) [0|255] \"\" Plant\n SG_ counter : 8|8@1+ (1,0) [0|255] \"\" Plant\n";

std::string refused(const std::string& text) {
  return refusal([&] { read_can_map(text, "rig.dbc"); });
}

std::string refused_signal(const std::string& signal) {
  return refused("BO_ 256 COMMAND: 6 Controller\n" + kProtection + " SG_ " + signal + "\n");
}

}  // namespace

TEST_GROUP(CanMap){};

TEST(CanMap, own_map_has_a_classic_and_an_fd_command_and_every_message_is_protected) {
  const CanMessage& fd = own_map.at("SERVOVALVE_COMMAND_FD");
  CHECK(!own_map.at("SERVOVALVE_COMMAND").fd);
  CHECK(fd.fd);
  UNSIGNED_LONGS_EQUAL(13, fd.signals.size());
  CHECK(fd.has_authentication());
  CHECK(!own_map.at("SERVOVALVE_COMMAND").has_authentication());
  UNSIGNED_LONGS_EQUAL(16, fd.crc_bits());
  UNSIGNED_LONGS_EQUAL(1, fd.cycle_ms);
  CHECK(own_map.find(0x110, true) == &fd);
  CHECK(own_map.find(0x110, false) == nullptr);
}

TEST(CanMap, commands_come_before_readings_and_readings_before_reports_in_arbitration) {
  const auto id = [](const char* name) { return own_map.at(name).id; };
  CHECK(id("SYNC") < id("SERVOVALVE_COMMAND"));
  CHECK(id("SERVOVALVE_COMMAND_FD") < id("PISTON_1"));
  CHECK(id("STRINGS_FD") < id("STATUS"));
  CHECK(id("STATUS") < id("HEARTBEAT"));
}

TEST(CanMap, signal_is_read_as_it_was_written_wherever_it_lies_and_touches_no_other_bit) {
  for (unsigned start = 0; start < 40; ++start) {
    CanSignal signal;
    signal.start = start;
    signal.length = 24;
    signal.is_signed = true;
    for (const std::int64_t raw : {-8'388'608, -1, 0, 1, 8'388'607}) {
      std::array<std::uint8_t, 8> data{};
      std::array<std::uint8_t, 8> full{};
      full.fill(0xFF);
      signal.write(raw, data);
      signal.write(raw, full);
      LONGS_EQUAL(raw, signal.read(data));
      LONGS_EQUAL(raw, signal.read(full));
      for (unsigned bit = 0; bit < 64; ++bit) {
        if (bit < start || bit >= start + 24) {
          UNSIGNED_LONGS_EQUAL(0, (data[bit / 8] >> (bit % 8)) & 1U);
          UNSIGNED_LONGS_EQUAL(1, (full[bit / 8] >> (bit % 8)) & 1U);
        }
      }
    }
  }
}

TEST(CanMap, message_or_signal_that_is_not_there_is_named) {
  expect_message(refusal([] { own_map.at("PISTON_3"); }), {"no message PISTON_3", "PISTON_1"});
  expect_message(refusal([] { own_map.at("SYNC").at("x"); }), {"message SYNC of the CAN map has no signal x"});
}

TEST(CanMap, what_is_wrong_is_refused_with_file_and_line) {
  expect_message(refused_signal("x : 40|16@1- (1,0) [0|1] \"\" Plant"), {"rig.dbc:4: x: bits 40 to 55 of a frame of 48"});
  expect_message(refused_signal("x : 12|8@1- (1,0) [0|1] \"\" Plant"), {"rig.dbc:4: x: has a bit of counter"});
  expect_message(refused_signal("x : 16|8@0- (1,0) [0|1] \"\" Plant"), {"rig.dbc:4: x: big-endian; allowed: @1"});
  expect_message(refused_signal("x m1 : 16|8@1- (1,0) [0|1] \"\" Plant"), {"rig.dbc:4: x: multiplexed"});
  expect_message(refused_signal("x : 16|8@1- (-1,0) [0|1] \"\" Plant"), {"rig.dbc:4: x: factor -1; allowed: above 0"});
  expect_message(refused_signal("x : 16|8@1- (0.5,0) [-70|1] \"\" Plant"), {"rig.dbc:4: x: range -70 to 1", "-64 to 63.5"});
  expect_message(refused_signal("x : 16|32@1- (1,0) [0|1] \"\" Plant\nSIG_VALTYPE_ 256 x : 1;"),
                 {"rig.dbc:4: x: floating-point"});
  expect_message(refused("BO_ 256 A: 8 X\n" + kProtection + " SG_ x : 16|33@1- (1,0) [0|1] \"\" Plant\n"),
                 {"rig.dbc:4: x: 33 bits; allowed: up to 32"});
  expect_message(refused_signal("x : 16|8@1- (1,y) [0|1] \"\" Plant"), {"rig.dbc:4: \"y\" is not a number"});
  expect_message(refused("BO_ 2147484000 A: 8 X\n"), {"rig.dbc:1: A: id 352 of 29 bits; allowed: 0 to 2047"});
  expect_message(refused("BO_ 256 COMMAND: 6 Controller\n SG_ x : 0|8@1+ (1,0) [0|255] \"\" Plant\n"),
                 {"COMMAND: not protected", "crc8 : 0|8@1+ and counter"});
  expect_message(refused("BO_ 1 A: 2 X\n" + kProtection + "BO_ 1 B: 2 X\n" + kProtection), {"rig.dbc:4: B:", "used before"});
  expect_message(refused("BO_ 1 A: 10 X\n" + kProtection), {"A: 10 bytes; allowed: 0 to 8, and for FD 12, 16"});
  expect_message(refused("BO_ 1 A: 2 X\n" + kProtection + "BA_ \"VFrameFormat\" BO_ 1 15;\n"), {"A: VFrameFormat 15"});
}

TEST(CanMap, message_without_a_data_id_or_with_one_that_its_check_does_not_tell_from_another_is_refused) {
  const std::string two = "BO_ 1 A: 2 X\n" + kProtection + "BO_ 2 B: 2 X\n" + kProtection;
  const auto with_ids = [&](unsigned first, unsigned second) {
    return two + "BA_ \"E2EDataId\" BO_ 1 " + std::to_string(first) + ";\nBA_ \"E2EDataId\" BO_ 2 " +
           std::to_string(second) + ";\n";
  };
  expect_message(refused(two), {"rig.dbc:1: A: data id 0; allowed: BA_ \"E2EDataId\" BO_ 1 of 1 to 65535"});
  expect_message(refused(with_ids(1, 65536)), {"rig.dbc:4: B: data id 65536"});
  expect_message(refused(with_ids(7, 7)), {"rig.dbc:4: B: data id 7", "from 7, that of A"});
  // 0x4301 and 0x5041 differ by a multiple of the check's polynomial.
  expect_message(refused(with_ids(0x4301, 0x5041)),
                 {"rig.dbc:4: B: data id 20545", "8 bits does not distinguish from 17153"});
  UNSIGNED_LONGS_EQUAL(2, read_can_map(with_ids(0x4301, 0x5071), "rig.dbc").messages.size());
}

TEST(CanMap, authentication_that_is_not_the_end_of_its_frame_is_refused) {
  const auto message = [](unsigned freshness, unsigned low, unsigned high, const std::string& behind = "") {
    const auto signal = [](const char* name, unsigned start) {
      return " SG_ " + std::string(name) + " : " + std::to_string(start) + "|32@1+ (1,0) [0|4294967295] \"\" Plant\n";
    };
    return "BO_ 1 A: 16 X\n SG_ crc16 : 0|16@1+ (1,0) [0|65535] \"\" Plant\n SG_ counter : 16|8@1+ (1,0) [0|255] \"\" "
           "Plant\n" +
           signal("freshness", freshness) + signal("mac_low", low) + signal("mac_high", high) + behind +
           "BA_ \"VFrameFormat\" BO_ 1 14;\nBA_ \"E2EDataId\" BO_ 1 7;\n";
  };
  CHECK(read_can_map(message(32, 64, 96), "rig.dbc").messages[0].has_authentication());
  expect_message(refused(message(32, 96, 64)), {"rig.dbc:1: A: its authentication is not in its place", "freshness"});
  expect_message(refused(message(32, 64, 96, " SG_ x : 24|8@1+ (1,0) [0|255] \"\" Plant\n")), {"not in its place"});
}

}  // namespace hotfire
