// SPDX-License-Identifier: Apache-2.0
#include "firmware/service/watchdog.hpp"

#include <CppUTest/TestHarness.h>

#include <string>
#include <thread>

#include "tests/files/scratch.hpp"
#include "tests/support/notify_socket.hpp"

namespace hotfire::firmware {

namespace {

constexpr int kPatienceMs = 30'000;  ///< for what must come, on whatever machine
constexpr std::uint64_t kIntervalUs = 8000;

/// Waits until the watchdog has looked so often again.
void wait_for_looks(const Watchdog& watchdog, std::uint64_t looks) {
  for (const std::uint64_t enough = watchdog.looks() + looks; watchdog.looks() < enough;) {
    std::this_thread::yield();
  }
}

}  // namespace

TEST_GROUP(Watchdog) {
  test::Scratch scratch;
  std::atomic<std::uint64_t> heartbeat{0};
};

TEST(Watchdog, ManagerAtAPathAndInTheAbstractSpaceIsReached) {
  for (const std::string& address : {scratch.path("notify").string(), "@hotfire-test-" + std::to_string(getpid())}) {
    const test::NotifySocket socket(address);
    CHECK(socket.bound());
    const hal::ServiceManager manager(address, 0);
    CHECK(manager.notify("READY=1"));
    STRCMP_EQUAL("READY=1", socket.next(kPatienceMs).c_str());
  }
}

TEST(Watchdog, WithoutAManagerNothingIsSentAndNothingFails) {
  for (const std::string& address : {std::string(), std::string("relative"), scratch.path("none").string()}) {
    const hal::ServiceManager manager(address, 1000);
    CHECK(!manager.listens());
    CHECK(!manager.notify("READY=1"));
  }
  Watchdog watchdog({}, heartbeat);
  CHECK(!watchdog.start());
  watchdog.stop();
  UNSIGNED_LONGS_EQUAL(0, watchdog.looks());
}

TEST(Watchdog, IntervalIsThatOfTheEnvironmentIfItIsMeantForThisProcess) {
  setenv("WATCHDOG_USEC", "2000000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  UNSIGNED_LONGS_EQUAL(2'000'000, hal::ServiceManager::from_environment().watchdog_us());
  setenv("WATCHDOG_PID", "1", 1);
  UNSIGNED_LONGS_EQUAL(0, hal::ServiceManager::from_environment().watchdog_us());
  unsetenv("WATCHDOG_USEC");
  unsetenv("WATCHDOG_PID");
}

TEST(Watchdog, NothingIsSaidBeforeTheFirstBeat) {
  const test::NotifySocket socket(scratch.path("notify"));
  Watchdog watchdog(hal::ServiceManager(socket.address(), kIntervalUs), heartbeat);
  CHECK(!watchdog.start());
  wait_for_looks(watchdog, 3);
  STRCMP_EQUAL("", socket.next(0).c_str());
}

TEST(Watchdog, HeartThatBeatsIsReadyOnceAndThenFeedsTheWatchdog) {
  const test::NotifySocket socket(scratch.path("notify"));
  Watchdog watchdog(hal::ServiceManager(socket.address(), kIntervalUs), heartbeat);
  CHECK(!watchdog.start());
  heartbeat = 1;
  STRCMP_CONTAINS("READY=1\nWATCHDOG=1\nSTATUS=running", socket.next(kPatienceMs).c_str());
  for (int beat = 0; beat < 3; ++beat) {
    ++heartbeat;
    const std::string said = socket.next(kPatienceMs);
    CHECK(said.starts_with("WATCHDOG=1\n"));
  }
  watchdog.stop();
  STRCMP_EQUAL("STOPPING=1", socket.next(kPatienceMs).c_str());
}

TEST(Watchdog, HeartThatDoesNotMoveIsSilentThoughTheThreadLives) {
  const test::NotifySocket socket(scratch.path("notify"));
  Watchdog watchdog(hal::ServiceManager(socket.address(), kIntervalUs), heartbeat);
  CHECK(!watchdog.start());
  heartbeat = 1;
  CHECK(!socket.next(kPatienceMs).empty());
  wait_for_looks(watchdog, 5);
  STRCMP_EQUAL("", socket.next(0).c_str());
  ++heartbeat;
  CHECK(socket.next(kPatienceMs).starts_with("WATCHDOG=1\n"));
}

}  // namespace hotfire::firmware
