// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/codec.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "firmware/can/can_map.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tools/files/can/can_crc.hpp"
#include "tools/files/can/can_map.hpp"

namespace hotfire::firmware::can {
namespace {

/// Read before the first test, so that CppUTest does not take what it keeps for a leak.
const CanMap& declared_map = own_can_map();

const CanMessage& in_map(const Message& message) { return declared_map.at(message.name); }

/// A value of every signal, anywhere in its range.
std::vector<double> any_values(const Message& message, std::mt19937_64& random) {
  std::vector<double> values;
  for (const Signal& signal : message.signals) {
    std::uniform_int_distribution<std::int64_t> raw(signal.lowest_raw, signal.highest_raw);
    values.push_back(signal.offset + signal.factor * static_cast<double>(raw(random)));
  }
  return values;
}

hal::CanFrame framed(const Message& message, std::span<const double> values, std::uint8_t counter = 7) {
  hal::CanFrame frame;
  CHECK(encode(message, values, counter, frame));
  return frame;
}

}  // namespace

TEST_GROUP(Codec) {
  std::mt19937_64 random{1};
  std::array<double, 32> values{};
  std::uint8_t counter = 0;
};

TEST(Codec, ChecksGiveTheValuesOfTheirStandards) {
  const auto check = [](const CanCrc& crc) {
    std::uint16_t value = crc.start;
    for (const char letter : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
      value = crc.add(value, static_cast<std::uint8_t>(letter));
    }
    return value ^ crc.final_xor;
  };
  LONGS_EQUAL(0x4B, check(kCanCrc8));
  LONGS_EQUAL(0x29B1, check(kCanCrc16));
}

TEST(Codec, WhatIsEncodedIsDecodedToTheSameValuesAndCounter) {
  for (const Message* message : kMessages) {
    for (int i = 0; i < 200; ++i) {
      const std::vector<double> sent = any_values(*message, random);
      const hal::CanFrame frame = framed(*message, sent, static_cast<std::uint8_t>(i));
      CHECK(decode(*message, frame, values, counter) == Decoding::good);
      BYTES_EQUAL(i, counter);
      for (std::size_t s = 0; s < sent.size(); ++s) {
        DOUBLES_EQUAL(sent[s], values[s], 0.0);
      }
    }
  }
}

TEST(Codec, FramesSayWhatTheDbcFileSaysTheySay) {
  for (const Message* message : kMessages) {
    const CanMessage& declared = in_map(*message);
    UNSIGNED_LONGS_EQUAL(declared.signals.size(), message->signals.size() + (message->can_be_authenticated ? 5 : 2));
    for (int i = 0; i < 200; ++i) {
      const std::vector<double> sent = any_values(*message, random);
      const hal::CanFrame frame = framed(*message, sent, static_cast<std::uint8_t>(i));
      UNSIGNED_LONGS_EQUAL(declared.length, frame.length);
      CHECK(declared.is_intact(frame.bytes()));
      LONGS_EQUAL(i, declared.counter().read(frame.bytes()));
      for (std::size_t s = 0; s < sent.size(); ++s) {
        const CanSignal& signal = declared.signals[s + 2];
        STRCMP_EQUAL(signal.name.c_str(), std::string(message->signals[s].name).c_str());
        DOUBLES_EQUAL(sent[s], signal.physical(signal.read(frame.bytes())), 0.0);
      }
    }
  }
}

TEST(Codec, AnyFlippedBitIsNoticed) {
  for (const Message* message : kMessages) {
    const hal::CanFrame frame = framed(*message, any_values(*message, random));
    for (unsigned bit = 0; bit < 8U * frame.length; ++bit) {
      hal::CanFrame broken = frame;
      broken.data[bit / 8] = static_cast<std::uint8_t>(broken.data[bit / 8] ^ (1U << (bit % 8)));
      CHECK(decode(*message, broken, values, counter) == Decoding::wrong_crc);
    }
  }
}

TEST(Codec, FrameOfAnotherActuatorOrDirectionIsRefusedUnderWhateverId) {
  std::size_t of_one_shape = 0;
  for (const Message* sent : kMessages) {
    for (const Message* wanted : kMessages) {
      if (sent == wanted) {
        continue;
      }
      hal::CanFrame frame = framed(*sent, any_values(*sent, random));
      CHECK(decode(*wanted, frame, values, counter) == Decoding::wrong_id);
      // A node that has the id of another one, or a gateway that changes it.
      frame.id.value = wanted->id;
      const bool one_shape = sent->fd == wanted->fd && sent->length == wanted->length;
      of_one_shape += one_shape ? 1 : 0;
      CHECK(decode(*wanted, frame, values, counter) != Decoding::good);
      CHECK(!one_shape || decode(*wanted, frame, values, counter) == Decoding::wrong_crc);
    }
  }
  // Both pistons, both strings, load pressures and STATUS; the command and the split readings; the FD frames of 64 bytes,
  // and of 48.
  CHECK(of_one_shape >= 6 * 5 + 5 * 4 + 2 * 1 + 3 * 2);
}

TEST(Codec, NodeThatIsConfiguredWithTheIdOfAnotherOneIsRefusedThoughItChecksItsOwnFrames) {
  for (const Message* wanted : kMessages) {
    for (const Message* misplaced : kMessages) {
      if (misplaced != wanted) {
        Message node = *wanted;
        node.data_id = misplaced->data_id;
        const hal::CanFrame frame = framed(node, any_values(*wanted, random));
        CHECK(decode(node, frame, values, counter) == Decoding::good);
        CHECK(decode(*wanted, frame, values, counter) == Decoding::wrong_crc);
      }
    }
  }
}

TEST(Codec, OtherFormatAndLengthAreRefused) {
  const hal::CanFrame frame = framed(servovalve_command::kMessage, any_values(servovalve_command::kMessage, random));
  hal::CanFrame other = frame;
  other.id.extended = true;
  CHECK(decode(servovalve_command::kMessage, other, values, counter) == Decoding::wrong_id);
  other = frame;
  other.fd = true;
  CHECK(decode(servovalve_command::kMessage, other, values, counter) == Decoding::wrong_format);
  other = frame;
  other.length = 5;
  CHECK(decode(servovalve_command::kMessage, other, values, counter) == Decoding::wrong_length);
}

TEST(Codec, CodeOutsideItsRangeIsRefusedThoughItsCheckIsRight) {
  const CanMessage& declared = in_map(servovalve_command::kMessage);
  hal::CanFrame frame = framed(servovalve_command::kMessage, std::array{0.0, 0.0});
  declared.at("current_2").write(32'001, frame.data);
  declared.seal({frame.data.data(), frame.length});
  values.fill(5.0);
  CHECK(decode(servovalve_command::kMessage, frame, values, counter) == Decoding::out_of_range);
  DOUBLES_EQUAL(5.0, values[0], 0.0);
}

TEST(Codec, ValueThatCannotBeSaidIsNotEncoded) {
  hal::CanFrame frame;
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {0.0321, -0.0321, infinite, -infinite, std::nan(""), 1e300}) {
    CHECK(!encode(servovalve_command::kMessage, std::array{0.0, value}, 0, frame));
  }
  UNSIGNED_LONGS_EQUAL(0, frame.length);
  CHECK(encode(servovalve_command::kMessage, std::array{0.0, 0.032}, 0, frame));
}

TEST(Codec, ResolutionIsHalfACode) {
  const double between = 0.0123456;
  CHECK(decode(servovalve_command::kMessage, framed(servovalve_command::kMessage, std::array{between, 0.0}), values,
               counter) == Decoding::good);
  DOUBLES_EQUAL(between, values[servovalve_command::current_1], 0.5e-6);
}

TEST(Codec, CounterSaysNextRepeatedOrHowManyAreLost) {
  Sequence sequence;
  CHECK(sequence.see(254) == Sequence::Step::first);
  CHECK(sequence.see(255) == Sequence::Step::next);
  CHECK(sequence.see(0) == Sequence::Step::next);
  CHECK(sequence.see(0) == Sequence::Step::repeated);
  CHECK(sequence.see(4) == Sequence::Step::skipped);
  UNSIGNED_LONGS_EQUAL(3, sequence.lost());
}

TEST(Codec, NothingIsAllocated) {
  const std::vector<double> sent = any_values(pistons_fd::kMessage, random);
  hal::CanFrame frame;
  const test::AllocationGuard guard;
  CHECK(encode(pistons_fd::kMessage, sent, 1, frame));
  CHECK(decode(pistons_fd::kMessage, frame, values, counter) == Decoding::good);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
}

}  // namespace hotfire::firmware::can
