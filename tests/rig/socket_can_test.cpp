// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/socket_can.hpp"

#include <CppUTest/TestHarness.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "hal/linux/posix_clock.hpp"
#include "tests/rig/can_peer.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::hal {
namespace {

constexpr CanId kCommand{0x100, false};
constexpr CanId kOtherCommand{0x101, false};
constexpr CanId kReading{0x200, false};
constexpr CanId kLong{0x300, false};
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kQueued = 2000 * kMillisecond;
constexpr std::int64_t kPatience = 30'000 * kMillisecond;

using test::CanPeer;
using test::shell;

CanFrame frame(const CanId& id, std::uint8_t first, bool fd = false) {
  CanFrame made;
  made.id = id;
  made.fd = fd;
  made.length = fd ? 64 : 8;
  made.data[0] = first;
  return made;
}

}  // namespace

TEST_GROUP(SocketCan) {
  PosixClock clock;
  std::unique_ptr<CanPeer> peer;
  std::unique_ptr<SocketCan> bus;

  void setup() override {
    shell("ip link add dev can0 type vcan; ip link set can0 mtu 72 up");
    peer = std::make_unique<CanPeer>();
    bus = std::make_unique<SocketCan>(SocketCan::Settings{
        "can0", {{kReading, false, 10 * kMillisecond}, {kLong, true}}, {kCommand, kOtherCommand, kLong}, true});
    const auto refused = bus->open();
    STRCMP_EQUAL("", refused ? refused->what.c_str() : "");
  }
  void teardown() override {
    bus.reset();
    peer.reset();
    shell("ip link del can0");
  }

  /// Receives once what the peer sent, and `own` frames of the bus, are delivered: a kernel in real time leaves the delivery
  /// to a thread of its own, and a busy host lets that wait. The same thread serves the peer's socket and then the bus's.
  void receive(std::size_t own = 0) {
    for (std::int64_t waited = 0; waited < kPatience && !(peer->is_delivered() && peer->arrived() >= own);
         waited += kMillisecond) {
      sleep(kMillisecond);
    }
    sleep(20 * kMillisecond);
    bus->receive(clock.now_ns());
  }

  /// Until the kernel stamps frames as they arrive: it begins some time after a socket has asked for it, and stamps earlier
  /// frames as they are read.
  void wait_for_stamps() {
    for (std::int64_t waited = 0; waited < kPatience; waited += kMillisecond) {
      peer->send(0x200, 0);
      receive();
      if (clock.now_ns() - bus->arrivals().back().arrived_ns > 10 * kMillisecond) {
        return;
      }
    }
    FAIL("the kernel does not stamp frames as they arrive");
  }

  /// Frames stay `kQueued` before the bus, which is longer than a busy host lets this machine stand.
  void queue_frames(const std::string& options = "") {
    shell("tc qdisc add dev can0 root netem delay " + std::to_string(kQueued / kMillisecond) + "ms " + options);
  }

  void sleep(std::int64_t duration_ns) { clock.sleep_until_ns(clock.now_ns() + duration_ns); }

  /// Waits until the peer has seen these frames, and no others.
  void wait_for(const std::vector<int>& wanted) {
    std::vector<int> seen;
    for (std::int64_t waited = 0; seen.size() < wanted.size() && waited < kPatience; waited += kMillisecond) {
      sleep(kMillisecond);
      const std::vector<int> more = peer->seen();
      seen.insert(seen.end(), more.begin(), more.end());
    }
    CHECK(seen == wanted);
  }
};

TEST(SocketCan, OnlyTheExactIdGetsThrough) {
  peer->send(0x200, 1);
  peer->send(0x201, 2);
  peer->send(0x200 | CAN_EFF_FLAG, 3);
  peer->send(0x200 | CAN_RTR_FLAG, 4);
  receive();
  UNSIGNED_LONGS_EQUAL(1, bus->counters().received);
  UNSIGNED_LONGS_EQUAL(0, bus->counters().foreign);
  BYTES_EQUAL(1, bus->mailbox(0).frame.data[0]);
}

TEST(SocketCan, NewestFrameIsKeptAndOlderOnesAreCounted) {
  for (std::uint8_t i = 1; i <= 5; ++i) {
    peer->send(0x200, i);
  }
  receive();
  BYTES_EQUAL(5, bus->mailbox(0).frame.data[0]);
  UNSIGNED_LONGS_EQUAL(4, bus->mailbox(0).superseded);
  receive();
  CHECK(!bus->mailbox(0).fresh);
}

TEST(SocketCan, EveryFrameOfACycleIsHandedOnInItsOrderWithItsStamp) {
  wait_for_stamps();
  for (std::uint8_t i = 1; i <= 5; ++i) {
    peer->send(0x200, i);
  }
  peer->send(0x300, 6, CANFD_MTU);
  receive();
  const auto arrivals = bus->arrivals();
  UNSIGNED_LONGS_EQUAL(6, arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    BYTES_EQUAL(i + 1, arrivals[i].frame.data[0]);
    UNSIGNED_LONGS_EQUAL(i < 5 ? 0 : 1, arrivals[i].subscription);
    CHECK(i == 0 || arrivals[i].arrived_ns >= arrivals[i - 1].arrived_ns);
  }
  receive();
  CHECK(bus->arrivals().empty());
}

TEST(SocketCan, FrameUnderAnIdOfItsOwnThatAnotherNodeSendsIsAnImpostors) {
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  receive(1);
  UNSIGNED_LONGS_EQUAL(0, bus->counters().impostors);
  peer->send(0x100, 2);
  receive();
  UNSIGNED_LONGS_EQUAL(1, bus->counters().impostors);
  UNSIGNED_LONGS_EQUAL(1, bus->counters().confirmed);
}

TEST(SocketCan, FdFramesGoBothWaysAndTheWrongFormatIsForeign) {
  peer->send(0x300, 7, CANFD_MTU);
  peer->send(0x200, 8, CANFD_MTU);
  peer->send(0x300, 9);
  receive();
  CHECK(bus->mailbox(1).frame.fd);
  BYTES_EQUAL(64, bus->mailbox(1).frame.length);
  BYTES_EQUAL(7, bus->mailbox(1).frame.data[0]);
  UNSIGNED_LONGS_EQUAL(0, bus->mailbox(0).received);
  UNSIGNED_LONGS_EQUAL(2, bus->counters().foreign);
  CHECK(bus->try_send(frame(kLong, 6, true)) == CanSend::taken);
  wait_for({6});
}

TEST(SocketCan, WhatALateReceiveLosesIsCountedAndOneReceiveEmptiesTheSocket) {
  constexpr unsigned kSent = 1000;
  for (unsigned i = 0; i < kSent; ++i) {
    peer->send(0x200, 1);
  }
  receive();
  const std::uint64_t received = bus->counters().received;
  CHECK(received >= 100);
  CHECK(received < kSent);
  receive();
  UNSIGNED_LONGS_EQUAL(received, bus->counters().received);
  // The kernel tells the count with the next frame that it takes in.
  peer->send(0x200, 2);
  receive();
  UNSIGNED_LONGS_EQUAL(kSent + 1, bus->counters().received + bus->counters().dropped);
}

TEST(SocketCan, ArrivalIsTheKernelsStampAndAStaleFrameIsNotInTime) {
  constexpr std::int64_t kStale = 20 * kMillisecond;
  std::int64_t now = 0;
  bool is_stamp = false;
  // The kernel begins to stamp some time after the first socket asks for it; until then it stamps on reading. A send or a
  // reading of the clocks that the host has interrupted says nothing.
  for (std::int64_t waited = 0; waited < kPatience && !is_stamp; waited += kStale) {
    const std::int64_t before = clock.now_ns();
    peer->send(0x200, 1);
    const std::int64_t after = clock.now_ns();
    sleep(kStale);
    now = clock.now_ns();
    bus->receive(now);
    const std::int64_t arrived = bus->mailbox(0).arrived_ns;
    is_stamp = after - before < kMillisecond && arrived >= before - kMillisecond && arrived <= after + kMillisecond;
  }
  CHECK(is_stamp);
  CHECK(!bus->in_time(0, now));
  CHECK(bus->in_time(0, bus->mailbox(0).arrived_ns + 10 * kMillisecond));
  CHECK(bus->realtime_offset_ns() != 0);
}

TEST(SocketCan, SentFrameIsConfirmedAndNotReceivedBack) {
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  receive(1);
  UNSIGNED_LONGS_EQUAL(1, bus->counters().confirmed);
  UNSIGNED_LONGS_EQUAL(0, bus->counters().received);
  CHECK(bus->try_send(frame(kCommand, 2)) == CanSend::taken);
  wait_for({1, 2});
}

TEST(SocketCan, FrameBehindOneThatIsNotOutIsNotQueued) {
  queue_frames();
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  for (std::uint8_t i = 2; i < 10; ++i) {
    bus->receive(clock.now_ns());
    CHECK(bus->try_send(frame(kCommand, i)) == CanSend::pending);
  }
  wait_for({1});
  receive();
  CHECK(bus->try_send(frame(kCommand, 10)) == CanSend::taken);
  wait_for({10});
}

TEST(SocketCan, StopLosesWhatIsQueuedForGood) {
  queue_frames();
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  CHECK(bus->stop());
  shell("ip link set can0 up");
  sleep(kQueued + 200 * kMillisecond);
  CHECK(peer->seen().empty());
  CHECK(bus->try_send(frame(kCommand, 2)) == CanSend::unusable);
  CHECK(bus->rearm());
  CHECK(bus->try_send(frame(kCommand, 3)) == CanSend::taken);
  wait_for({3});
}

TEST(SocketCan, StopWithNothingQueuedLeavesTheInterfaceUp) {
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  CHECK(bus->stop());
  CHECK(bus->rearm());
}

TEST(SocketCan, FullQueueIsCountedAndNotRetried) {
  queue_frames("limit 1");
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::taken);
  CHECK(bus->try_send(frame(kOtherCommand, 2)) == CanSend::queue_full);
  UNSIGNED_LONGS_EQUAL(1, bus->counters().queue_full);
  wait_for({1});
}

TEST(SocketCan, BusOffStaysUntilRearmedThoughTheControllerRestarts) {
  peer->report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
  receive();
  CHECK(bus->state() == CanState::passive);
  peer->report(CAN_ERR_BUSOFF, 0);
  peer->report(CAN_ERR_RESTARTED, 0);
  peer->report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  receive();
  CHECK(bus->state() == CanState::bus_off);
  UNSIGNED_LONGS_EQUAL(4, bus->counters().error_frames);
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::unusable);
  CHECK(bus->rearm());
  CHECK(bus->state() == CanState::good);
  CHECK(bus->try_send(frame(kCommand, 2)) == CanSend::taken);
  wait_for({2});
}

TEST(SocketCan, PassiveControllerThatRecoversIsGoodAgain) {
  peer->report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING);
  receive();
  CHECK(bus->state() == CanState::warning);
  peer->report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  receive();
  CHECK(bus->state() == CanState::good);
}

TEST(SocketCan, NothingOfferedWhileTheBusIsDownLeavesWhenItIsBack) {
  shell("ip link set can0 down");
  receive();
  CHECK(bus->state() == CanState::down);
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::unusable);
  CHECK(!bus->rearm());
  shell("ip link set can0 up");
  receive();
  CHECK(bus->try_send(frame(kCommand, 2)) == CanSend::unusable);
  CHECK(peer->seen().empty());
  CHECK(bus->rearm());
  CHECK(bus->try_send(frame(kCommand, 3)) == CanSend::taken);
  wait_for({3});
}

TEST(SocketCan, InterfaceThatIsPulledOutAndPluggedInIsUsableAfterRearm) {
  shell("ip link del can0");
  receive();
  CHECK(bus->state() == CanState::down);
  CHECK(!bus->rearm());
  shell("ip link add dev can0 type vcan; ip link set can0 mtu 72 up");
  peer = std::make_unique<CanPeer>();
  CHECK(bus->try_send(frame(kCommand, 1)) == CanSend::unusable);
  CHECK(bus->rearm());
  CHECK(bus->try_send(frame(kCommand, 2)) == CanSend::taken);
  wait_for({2});
  peer->send(0x201, 1);
  peer->send(0x200, 2);
  receive();
  UNSIGNED_LONGS_EQUAL(1, bus->counters().received);
}

TEST(SocketCan, CycleAllocatesNothing) {
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    peer->send(0x200, 1);
    bus->receive(clock.now_ns());
    CHECK(bus->try_send(frame(kCommand, 1)) != CanSend::unusable);
  }
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
}

TEST(SocketCan, WhatCannotWorkIsRefusedWithTheRemedy) {
  const auto refusal = [](const std::string& interface, bool fd) {
    SocketCan other({interface, {}, {}, fd});
    const auto failure = other.open();
    return failure ? failure->what + "; " + failure->remedy : std::string();
  };
  STRCMP_CONTAINS("no interface can7; see 'ip -brief link'", refusal("can7", false).c_str());
  STRCMP_CONTAINS("no interface a-name-that-is-too-long", refusal("a-name-that-is-too-long", false).c_str());
  STRCMP_CONTAINS("lo is not a CAN interface", refusal("lo", false).c_str());
  shell("ip link set can0 down");
  STRCMP_CONTAINS("can0 is down; 'ip link set can0 up'", refusal("can0", false).c_str());
  shell("ip link set can0 mtu 16 up");
  STRCMP_CONTAINS("not set up for CAN FD (MTU 16); 'ip link set can0 down", refusal("can0", true).c_str());
  STRCMP_EQUAL("", refusal("can0", false).c_str());
}

}  // namespace hotfire::hal
