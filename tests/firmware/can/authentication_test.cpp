// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/authentication.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "firmware/can/controller_bus.hpp"
#include "firmware/can/plant_bus.hpp"
#include "hal/sim/can_wire.hpp"
#include "hal/sim/manual_clock.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware::can {
namespace {

using Wire = hal::sim::CanWire;
using Clock = hal::sim::ManualClock;

constexpr std::int64_t kMicrosecond = 1'000;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kTolerance = kSecond;
/// The key of RFC 4493.
constexpr AuthenticationKey kKey{0x2b, 0x7e, 0x15, 0x16, 0x28, 0xae, 0xd2, 0xa6,
                                 0xab, 0xf7, 0x15, 0x88, 0x09, 0xcf, 0x4f, 0x3c};

/// The times of day of two machines.
std::int64_t sender_ns = 0;
std::int64_t receiver_ns = 0;
std::int64_t time_of_sender() noexcept { return sender_ns; }
std::int64_t time_of_receiver() noexcept { return receiver_ns; }

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return text;
}

}  // namespace

TEST_GROUP(Authentication) {
  Authentication sender{kKey, kTolerance, &time_of_sender};
  Authentication receiver{kKey, kTolerance, &time_of_receiver};
  const Message& message = servovalve_command_fd::kMessage;
  std::uint64_t newest = 0;

  void setup() override { sender_ns = receiver_ns = 1'700'000'000 * kSecond + 123'456 * kMicrosecond; }

  hal::CanFrame sealed(const Message& of, std::uint8_t counter = 7) {
    std::array<double, 32> values{};
    for (std::size_t i = 0; i < 8; ++i) {
      values[i] = 0.001 * static_cast<double>(i + 1);
    }
    hal::CanFrame frame;
    CHECK(encode(of, std::span(values).first(of.signals.size()), counter, frame));
    sender.seal(of, frame);
    return frame;
  }
  hal::CanFrame sealed() { return sealed(message); }
  bool accepted(const hal::CanFrame& frame) { return receiver.accepts(message, frame, newest); }
};

TEST(Authentication, CodeIsThatOfTheStandard) {
  // RFC 4493, section 4, examples 1 and 2.
  cmac_aes128_ctx context{};
  std::array<std::uint8_t, 16> code{};
  cmac_aes128_set_key(&context, kKey.data());
  cmac_aes128_digest(&context, code.size(), code.data());
  STRCMP_EQUAL("bb1d6929e95937287fa37d129b756746", hex(code).c_str());
  constexpr std::array<std::uint8_t, 16> kBlock{0x6b, 0xc1, 0xbe, 0xe2, 0x2e, 0x40, 0x9f, 0x96,
                                                0xe9, 0x3d, 0x7e, 0x11, 0x73, 0x93, 0x17, 0x2a};
  cmac_aes128_update(&context, kBlock.size(), kBlock.data());
  cmac_aes128_digest(&context, code.size(), code.data());
  STRCMP_EQUAL("070a16b46b4d4144f79bdd9dd04a287c", hex(code).c_str());
}

TEST(Authentication, EndOfAFrameIsItsFreshnessAndTheFirstHalfOfTheCode) {
  // openssl mac -cipher AES-128-CBC -macopt hexkey:... CMAC over data id, freshness and the bytes behind the check.
  const hal::CanFrame frame = sealed();
  STRCMP_EQUAL("40222018d38738bc063557fe", hex(frame.bytes().subspan(20)).c_str());
  std::array<double, 32> values{};
  std::uint8_t counter = 0;
  CHECK(decode(message, frame, values, counter) == Decoding::good);
}

TEST(Authentication, FrameOfWhoHasTheKeyIsTakenOnceOnly) {
  const hal::CanFrame first = sealed();
  const hal::CanFrame second = sealed();
  CHECK(accepted(first));
  CHECK(!accepted(first));
  CHECK(accepted(second));
  CHECK(!accepted(first));
}

TEST(Authentication, AnyChangedBitBehindTheCheckIsFoundOutThoughTheCheckIsMadeRight) {
  for (const Message* one : kMessages) {
    if (!one->can_be_authenticated) {
      continue;
    }
    const hal::CanFrame frame = sealed(*one);
    for (unsigned bit = one->crc_bits; bit < 8U * frame.length; ++bit) {
      hal::CanFrame forged = frame;
      forged.data[bit / 8] = static_cast<std::uint8_t>(forged.data[bit / 8] ^ (1U << (bit % 8)));
      put_check(*one, forged);
      std::uint64_t none = 0;
      CHECK(!receiver.accepts(*one, forged, none));
    }
    std::uint64_t none = 0;
    CHECK(receiver.accepts(*one, frame, none));
  }
}

TEST(Authentication, AnotherKeyAndAnotherMessageOfTheSameShapeAreRefused) {
  AuthenticationKey other = kKey;
  other[15] ^= 1;
  Authentication stranger(other, kTolerance, &time_of_sender);
  hal::CanFrame frame = sealed();
  stranger.seal(message, frame);
  CHECK(!accepted(frame));
  // The same bytes as another direction's message would be: only the data id differs.
  Message reflected = message;
  reflected.data_id = pistons_a_fd::kMessage.data_id;
  sender.seal(reflected, frame);
  CHECK(!accepted(frame));
  sender.seal(message, frame);
  CHECK(accepted(frame));
}

TEST(Authentication, ReplayedFrameIsRefusedByAReceiverThatWasStartedAnewOnceItIsOlderThanTheTolerance) {
  const hal::CanFrame recorded = sealed();
  const auto taken_after = [&](std::int64_t time_ns) {
    receiver_ns = sender_ns + time_ns;
    std::uint64_t none = 0;
    return receiver.accepts(message, recorded, none);
  };
  CHECK(taken_after(kTolerance));
  CHECK(!taken_after(kTolerance + kMicrosecond));
  CHECK(!taken_after(3600 * kSecond));
  // The half of its freshness that it carries comes round every 2^32 us.
  for (const int rounds : {1, 2, 3}) {
    CHECK(!taken_after(rounds * (kMicrosecond << 32)));
  }
}

TEST(Authentication, ClockOfTheSenderMayBeWrongByTheToleranceEitherWayAndSetBack) {
  sender_ns = receiver_ns + kTolerance;
  CHECK(accepted(sealed()));
  // Of a clock that is set back the freshness goes on from the last one, which the receiver's clock has yet to reach.
  sender_ns = receiver_ns - kTolerance;
  CHECK(!accepted(sealed()));
  receiver_ns += 2 * kMicrosecond;
  CHECK(accepted(sealed()));
  const auto taken_from_a_new_sender = [&](std::int64_t behind_ns) {
    sender_ns = receiver_ns - behind_ns;
    Authentication started_anew(kKey, kTolerance, &time_of_sender);
    hal::CanFrame frame = sealed();
    started_anew.seal(message, frame);
    std::uint64_t none = 0;
    return receiver.accepts(message, frame, none);
  };
  CHECK(taken_from_a_new_sender(kTolerance));
  CHECK(!taken_from_a_new_sender(kTolerance + kMicrosecond));
}

TEST(Authentication, SealingAndAcceptingTakeNothingFromTheHeap) {
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    CHECK(accepted(sealed()));
  }
  UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
}

TEST(Authentication, PlantAndControllerOfOneKeyUnderstandEachOtherAndAStrangerMovesNothing) {
  for (const Layout layout : {Layout::fd, Layout::fd_split}) {
    constexpr std::size_t kActuators = 8;
    constexpr std::int64_t kMillisecond = 1'000'000;
    Wire wire;
    Clock clock;
    const NodeIds own = controller_ids(layout, kActuators);
    const NodeIds of_plant = plant_ids(layout, kActuators);
    Wire::Node node(wire, own.subscriptions, own.senders);
    Wire::Node plant_node(wire, of_plant.subscriptions, of_plant.senders);
    constexpr std::int64_t kAge = 100 * kMillisecond;
    ControllerBus controller(node, clock, {layout, kActuators, 5.0, kMillisecond, &sender});
    PlantBus plant(plant_node, clock, {layout, kActuators, 1, 5.0, kMillisecond, kAge, kAge, &receiver});
    hal::Reading commands;
    hal::Reading reading;
    hal::Command received;
    hal::Command pistons;
    for (std::uint64_t cycle = 0; cycle < 600; ++cycle) {
      commands.values[3] = 1e-4 * static_cast<double>(cycle % 100 + 1);
      reading.values[3] = -1e-3;
      commands.sequence = reading.sequence = cycle;
      CHECK(controller.try_send_reading(commands));
      CHECK(plant.try_receive_command(received));
      DOUBLES_EQUAL(commands.values[3], received.values[3], 5e-6);
      CHECK(plant.try_send_reading(reading));
      CHECK(controller.try_receive_command(pistons));
      clock.advance_ns(kMillisecond);
      sender_ns += kMillisecond;
      receiver_ns += kMillisecond;
    }
    UNSIGNED_LONGS_EQUAL(600, plant.commands().taken);
    UNSIGNED_LONGS_EQUAL(0, controller.readings(0).unauthentic);

    // Right id, check, counter and data id; no key.
    ControllerBus stranger(node, clock, {layout, kActuators, 5.0, kMillisecond});
    CHECK(stranger.try_send_reading(commands));
    plant.try_receive_command(received);
    DOUBLES_EQUAL(0.0, received.values[3], 0.0);
    UNSIGNED_LONGS_EQUAL(1, plant.commands().unauthentic);
  }
}

}  // namespace hotfire::firmware::can
