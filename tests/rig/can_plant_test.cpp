// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "firmware/can/plant_bus.hpp"
#include "firmware/loop/loop.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/plant/reference_plant.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/linux/socket_can.hpp"
#include "tests/rig/raw_can.hpp"

namespace hotfire::firmware {
namespace {

using CanBus = can::PlantBus<hal::SocketCan, hal::PosixClock>;
using PlantLoop = Loop<Plant<model::Simplex<double>>, CanBus, hal::PosixClock>;

constexpr can::PlantBusSettings kSettings{can::Layout::classic, 1, model::Simplex<double>::channels.size(), 5.0};
constexpr std::int64_t kPeriodNs = 1'000'000;

using test::shell;

/// The plant, answering can0 in a thread of its own.
class Answering {
 public:
  explicit Answering(std::uint64_t cycles)
      : socket_({"can0", can::plant_ids(can::Layout::classic, 1).subscriptions,
                 can::plant_ids(can::Layout::classic, 1).senders}),
        bus_(socket_, clock_, kSettings),
        plant_(reference_plant_with_every_effect(), 1e-9 * static_cast<double>(kPeriodNs)) {
    const auto refused = socket_.open();
    STRCMP_EQUAL("", refused ? refused->what.c_str() : "");
    LoopSettings settings;
    settings.period_ns = kPeriodNs;
    settings.cycles = cycles;
    settings.warm_up_cycles = 0;
    loop_ = std::make_unique<PlantLoop>(plant_, bus_, clock_, settings);
    thread_ = std::thread([this] { loop_->run(stop_, []() noexcept {}); });
  }
  ~Answering() { finish(); }
  Answering(const Answering&) = delete;
  Answering& operator=(const Answering&) = delete;

  /// Waits for the last cycle.
  void finish() {
    if (thread_.joinable()) {
      thread_.join();
    }
  }
  void ask_to_stop() { stop_ = true; }

  const LoopResult& result() const { return loop_->result(); }
  /// How many commands are in its socket that came after its last cycle. To be called once, after `finish`.
  std::uint64_t take_what_nobody_took() {
    const std::uint64_t before = socket_.mailbox(0).received;
    socket_.receive(clock_.now_ns());
    return socket_.mailbox(0).received - before;
  }

  const can::MessageCounters& bus() const { return bus_.commands(); }
  const hal::CanCounters& socket() const { return socket_.counters(); }

 private:
  hal::PosixClock clock_;
  hal::SocketCan socket_;
  CanBus bus_;
  Plant<model::Simplex<double>> plant_;
  std::unique_ptr<PlantLoop> loop_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The controller's side: a plain socket that takes every frame in its order.
class Controller {
 public:
  void command(double current) {
    hal::CanFrame frame;
    CHECK(can::encode(can::servovalve_command::kMessage, std::array{current, 0.0}, counter_++, frame));
    can_frame sent{};
    sent.can_id = frame.id.value;
    sent.len = frame.length;
    std::copy_n(frame.data.begin(), frame.length, sent.data);
    CHECK_EQUAL(static_cast<ssize_t>(sizeof sent), write(socket_.file, &sent, sizeof sent));
    ++commands;
  }

  /// Takes in all readings that are there, waiting for the first up to this long. False if none came.
  bool take_readings(int wait_ms) {
    pollfd ready{socket_.file, POLLIN, 0};
    if (poll(&ready, 1, wait_ms) <= 0) {
      return false;
    }
    can_frame seen{};
    while (recv(socket_.file, &seen, sizeof seen, MSG_DONTWAIT) == static_cast<ssize_t>(sizeof seen)) {
      hal::CanFrame frame;
      frame.id = {seen.can_id, false};
      frame.length = seen.len;
      std::copy_n(seen.data, seen.len, frame.data.begin());
      std::uint8_t counter = 0;
      if (can::decode(can::piston_1::kMessage, frame, pistons, counter) == can::Decoding::good) {
        out_of_order += sequence_.see(counter) == can::Sequence::Step::repeated ? 1 : 0;
        ++readings;
      } else if (frame.id.value != can::status::kMessage.id) {
        ++strangers;
      }
    }
    return true;
  }

  /// Waits until the plant has begun and ended a cycle after this call: of two readings that come after all that are there
  /// now, the second belongs to such a cycle. False if the plant is silent.
  bool take_cycle() {
    take_readings(0);
    const std::uint64_t before = readings;
    while (readings < before + 2) {
      if (!take_readings(2000)) {
        return false;
      }
    }
    return true;
  }

  std::uint64_t lost() const { return sequence_.lost(); }

  std::array<double, 2> pistons{};
  std::uint64_t commands = 0;
  std::uint64_t readings = 0;
  std::uint64_t strangers = 0;
  std::uint64_t out_of_order = 0;

 private:
  test::RawCan socket_;
  std::uint8_t counter_ = 0;
  can::Sequence sequence_;
};

}  // namespace

TEST_GROUP(CanPlant){void setup() override{shell("ip link add dev can0 type vcan; ip link set can0 up");
}  // namespace hotfire::firmware
void teardown() override { shell("ip link del can0"); }
}
;

TEST(CanPlant, AnswersAControllerAndNoFrameIsLostOrOutOfOrder) {
  const std::uint64_t cycles = std::strtoull(std::getenv("HOTFIRE_CYCLES"), nullptr, 10);
  Controller controller;
  Answering plant(cycles);
  // One command for the newest reading, so that no command overtakes another however late this machine is.
  while (controller.readings < cycles && controller.take_readings(2000)) {
    const double error = 0.02 - controller.pistons[0];
    controller.command(std::clamp(0.1 * error, -0.002, 0.002));
  }
  plant.finish();
  std::printf("\n%llu cycles: %llu commands, %llu readings, %llu cycles held the last command\n",
              static_cast<unsigned long long>(cycles), static_cast<unsigned long long>(controller.commands),
              static_cast<unsigned long long>(controller.readings),
              static_cast<unsigned long long>(plant.result().held_commands));
  UNSIGNED_LONGS_EQUAL(cycles, controller.readings);
  UNSIGNED_LONGS_EQUAL(0, controller.lost());
  UNSIGNED_LONGS_EQUAL(0, controller.out_of_order);
  UNSIGNED_LONGS_EQUAL(0, controller.strangers);
  UNSIGNED_LONGS_EQUAL(0, plant.result().lost_readings);
  UNSIGNED_LONGS_EQUAL(0, plant.socket().dropped);
  UNSIGNED_LONGS_EQUAL(0, plant.bus().refused);
  UNSIGNED_LONGS_EQUAL(0, plant.bus().repeated);
  UNSIGNED_LONGS_EQUAL(0, plant.bus().backward);
  UNSIGNED_LONGS_EQUAL(0, plant.bus().skipped);
  // Every command was taken, overtaken, or came after the last cycle, when nobody takes one: to the frame.
  const std::uint64_t accounted = plant.bus().taken + plant.bus().superseded;
  UNSIGNED_LONGS_EQUAL(controller.commands, accounted + plant.take_what_nobody_took());
  // The piston went where the controller wanted it: what it sent arrived, and what it read was the plant.
  CHECK(controller.pistons[0] > 0.005);
}

TEST(CanPlant, AnswersWhatCanplayerReplays) {
  constexpr unsigned kCommands = 300;
  std::FILE* log = std::fopen("/tmp/replay.log", "w");
  for (unsigned i = 0; i < kCommands; ++i) {
    hal::CanFrame frame;
    CHECK(can::encode(can::servovalve_command::kMessage, std::array{0.001, 0.0}, static_cast<std::uint8_t>(i), frame));
    std::fprintf(log, "(%.6f) can0 100#", 100.0 + 5e-3 * i);
    for (const std::uint8_t byte : frame.bytes()) {
      std::fprintf(log, "%02X", byte);
    }
    std::fprintf(log, "\n");
  }
  std::fclose(log);
  Controller listener;
  Answering plant(1'000'000);
  CHECK(listener.take_cycle());
  shell("canplayer -I /tmp/replay.log");
  CHECK(listener.take_cycle());
  plant.ask_to_stop();
  plant.finish();
  UNSIGNED_LONGS_EQUAL(kCommands, plant.bus().taken + plant.bus().superseded);
  UNSIGNED_LONGS_EQUAL(0, plant.bus().damaged() + plant.bus().of_two_senders());
  CHECK(listener.pistons[0] > 0.0);
}

}  // namespace hotfire::firmware
