// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/can_schedule.hpp"

#include <random>
#include <string>

#include "hal/schedule/frame_time.hpp"
#include "tests/files/expect.hpp"
#include "tests/files/own_map.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;
using test::own_map;
using test::refusal;

namespace {

/// Stuff bits of a string of bits: one of the other kind after five alike, which counts for the next five.
unsigned stuff_bits(const std::vector<bool>& bits) {
  unsigned stuffed = 0;
  unsigned alike = 0;
  bool last = !bits.front();
  for (const bool bit : bits) {
    alike = bit == last ? alike + 1 : 1;
    last = bit;
    if (alike == 5) {
      ++stuffed;
      last = !bit;
      alike = 1;
    }
  }
  return stuffed;
}

}  // namespace

TEST_GROUP(CanSchedule) {
  test::Scratch scratch;

  std::string refused(const std::string& text) const {
    return refusal([&] { load_can_schedule(scratch.write("bus.toml", text)); });
  }
  CanSchedule load(const std::string& text) const { return load_can_schedule(scratch.write("bus.toml", text)); }
};

TEST(CanSchedule, longest_classic_frame_is_the_published_one) {
  // Davis et al. 2007, equation (3): 135 bits for 8 bytes and 65 for 1, 55 for none.
  DOUBLES_EQUAL(135e-6, hal::longest_classic_frame(8, 1e6), 1e-12);
  DOUBLES_EQUAL(270e-6, hal::longest_classic_frame(8, 500e3), 1e-12);
  DOUBLES_EQUAL(65e-6, hal::longest_classic_frame(1, 1e6), 1e-12);
  DOUBLES_EQUAL(55e-6, hal::longest_classic_frame(0, 1e6), 1e-12);
}

TEST(CanSchedule, no_content_needs_more_stuff_bits_than_are_counted_and_the_worst_needs_as_many) {
  for (const unsigned bytes : {0U, 1U, 4U, 8U}) {
    // What is stuffed of a classic frame: 34 bits around the data, all else is fixed.
    const std::size_t stuffable = 34 + 8 * bytes;
    const auto allowed = static_cast<unsigned>(std::lround(hal::longest_classic_frame(bytes, 1.0))) - 47 - 8 * bytes;
    std::mt19937 random(bytes);
    for (int i = 0; i < 2000; ++i) {
      std::vector<bool> bits(stuffable);
      for (std::size_t bit = 0; bit < stuffable; ++bit) {
        bits[bit] = i % 2 == 0 ? (random() & 7U) == 0 : (random() & 1U) != 0;
      }
      CHECK(stuff_bits(bits) <= allowed);
    }
    std::vector<bool> worst(stuffable);
    for (std::size_t bit = 0; bit < stuffable; ++bit) {
      worst[bit] = bit >= 5 && (bit - 5) / 4 % 2 == 0;
    }
    UNSIGNED_LONGS_EQUAL(allowed, stuff_bits(worst));
  }
}

TEST(CanSchedule, fd_frame_at_one_rate_is_longer_than_a_classic_one_of_as_many_bytes_and_faster_data_shorten_it) {
  CHECK(hal::longest_fd_frame(8, 1e6, 1e6) > hal::longest_classic_frame(8, 1e6));
  CHECK(hal::longest_fd_frame(64, 1e6, 5e6) < hal::longest_fd_frame(64, 1e6, 2e6));
  // 34 bits at the arbitration rate; 5 + 512 + 129 stuff + 4 + 21 + 7 at the data rate.
  DOUBLES_EQUAL(34e-6 + 678 / 5e6, hal::longest_fd_frame(64, 1e6, 5e6), 1e-12);
  DOUBLES_EQUAL(34e-6 + (5 + 128 + 33 + 4 + 17 + 6) / 5e6, hal::longest_fd_frame(16, 1e6, 5e6), 1e-12);
}

TEST(CanSchedule, classic_layout_of_one_engine_at_1_khz_fits_1_Mbit_and_not_500_kbit) {
  const std::string frames =
      "[frames]\nSYNC = \"1 ms\"\nSERVOVALVE_COMMAND = \"1 ms\"\nPISTON_1 = \"1 ms\"\nPISTON_2 = \"1 ms\"\n"
      "STRINGS_12 = \"4 ms\"\nSTRINGS_34 = \"4 ms\"\nSTATUS = \"100 ms\"\nHEARTBEAT = \"10 ms\"\n";
  const CanSchedule schedule = load("schema = 1\n[bus]\nbit_rate = 1e6\n" + frames);
  const double expected = (75 + 115 + 2 * 135) / 1000.0 + 2 * 135 / 4000.0 + 135 / 100e3 + 95 / 10e3;
  DOUBLES_EQUAL(expected, schedule.load(), 1e-9);
  expect_message(refused("schema = 1\n[bus]\nbit_rate = 500e3\n" + frames),
                 {"bus.toml: worst-case bus load 107.7 %; allowed: 70 %", "PISTON_1 27.0 % (270 us every 1 ms)"});
}

TEST(CanSchedule, fd_layout_of_eight_actuators_at_1_khz_fits_1_and_5_Mbit) {
  const CanSchedule schedule = load(
      "schema = 1\n[bus]\nbit_rate = 1e6\ndata_bit_rate = 5e6\n[frames]\nSYNC = 0.001\nSERVOVALVE_COMMAND_FD = 0.001\n"
      "PISTONS_FD = 0.001\nSTRINGS_FD = \"4 ms\"\nSTATUS = \"0.1 s\"\nHEARTBEAT = \"10 ms\"\n");
  CHECK(schedule.load() > 0.35);
  CHECK(schedule.load() < hal::kLargestBusLoad);
}

TEST(CanSchedule, what_is_wrong_is_refused_with_line_key_and_remedy) {
  const std::string bus = "schema = 1\n[bus]\nbit_rate = 1e6\n[frames]\n";
  expect_message(refused(bus + "PISTON_3 = 0.001\n"), {"bus.toml:5", "frames.PISTON_3", "did you mean \"PISTON_1\""});
  expect_message(refused(bus + "SYNC = 1e-6\n"), {"bus.toml:5", "frames.SYNC", "allowed: 0.00025 to 10 s"});
  expect_message(refused(bus + "PISTONS_FD = 0.001\n"), {"bus.toml:5", "an FD frame", "bus.data_bit_rate"});
  expect_message(refused(bus), {"frames: no frame"});
  expect_message(refused("schema = 1\n[bus]\nbit_rate = 2e6\n[frames]\nSYNC = 1\n"), {"bus.toml:3", "10000 to 1000000"});
  expect_message(refused("schema = 1\n[bus]\nbit_rate = 1e6\nbaud = 1\n[frames]\nSYNC = 1\n"), {"bus.toml:4", "bus.baud"});
  expect_message(refused("[bus]\nbit_rate = 1e6\n[frames]\nSYNC = 1\n"), {"schema: missing"});
}

}  // namespace hotfire
