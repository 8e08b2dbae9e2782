// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/frame_budget.hpp"

#include <CppUTest/TestHarness.h>

#include <random>

namespace hotfire::firmware::can {
namespace {

constexpr std::int64_t kDueNs = 1'000'000;
constexpr std::int64_t kHeldUpNs = 5 * kDueNs;

/// A node that sends by its own clock, `rate` times as fast as the lab's, each frame up to `kJitter` of a period late, and a
/// lab whose cycles begin up to nearly a period late.
struct FreeNode {
  static constexpr double kJitter = 0.3;
  static constexpr double kLateness = 0.9;

  explicit FreeNode(double rate) : every(static_cast<double>(kDueNs) / rate) {}

  /// Frames that the node has sent until the lab looks in a cycle, and when it looks.
  std::pair<std::uint64_t, std::int64_t> until_cycle(std::uint64_t cycle) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double now = (static_cast<double>(cycle) + kLateness * share(random)) * static_cast<double>(kDueNs);
    std::uint64_t frames = 0;
    for (; next <= now; ++sent, ++frames) {
      next = phase + (static_cast<double>(sent + 1) + kJitter * share(random)) * every;
    }
    return {frames, static_cast<std::int64_t>(now)};
  }

  double every;
  double phase = 0.0;  ///< of the node against the lab [ns]
  double next = 0.0;   ///< when its next frame comes [ns]
  std::uint64_t sent = 0;
  std::mt19937_64 random{1};
};

/// Frames too many in so many cycles, in each of which `frames` come.
std::uint64_t excess_of(FrameBudget& budget, std::uint64_t frames, int cycles, std::int64_t& now) {
  std::uint64_t excess = 0;
  for (int i = 0; i < cycles; ++i) {
    now += kDueNs;
    excess += budget.excess(frames, now);
  }
  return excess;
}

}  // namespace

TEST_GROUP(FrameBudget) {
  FrameBudget budget{kDueNs, kHeldUpNs};
  std::int64_t now = 0;
  void setup() override { budget.excess(3, now); }
};

TEST(FrameBudget, NodeWithAClockOfItsOwnThatIsFastOrSlowAndJittersIsOneSender) {
  for (const double rate : {0.99, 0.9999, 1.0, 1.0001, 1.009}) {
    for (int phase = 0; phase < 8; ++phase) {
      FreeNode node(rate);
      node.phase = node.next = phase * 0.125 * static_cast<double>(kDueNs);
      FrameBudget own(kDueNs, kHeldUpNs);
      for (std::uint64_t cycle = 0; cycle < 20'000; ++cycle) {
        const auto [frames, seen_ns] = node.until_cycle(cycle);
        UNSIGNED_LONGS_EQUAL(0, own.excess(frames, seen_ns));
      }
    }
  }
}

TEST(FrameBudget, SecondSenderIsFoundOutInTheSecondCycleInWhichBothHaveSent) {
  UNSIGNED_LONGS_EQUAL(0, excess_of(budget, 1, 10'000, now));
  UNSIGNED_LONGS_EQUAL(0, excess_of(budget, 2, 1, now));
  UNSIGNED_LONGS_EQUAL(1, excess_of(budget, 2, 1, now));
  CHECK(excess_of(budget, 2, 100, now) >= 99);
}

TEST(FrameBudget, SecondSenderWithHalfTheRateIsFoundOutAtItsSecondFrame) {
  excess_of(budget, 1, 100, now);
  UNSIGNED_LONGS_EQUAL(0, excess_of(budget, 2, 1, now) + excess_of(budget, 1, 1, now));
  UNSIGNED_LONGS_EQUAL(1, excess_of(budget, 2, 1, now));
}

TEST(FrameBudget, FramesThatAReadingMayBeOldMayBeHeldUpAndComeAtOnceAgainAndAgainButNoMore) {
  for (int again = 0; again < 1000; ++again) {
    UNSIGNED_LONGS_EQUAL(0, excess_of(budget, 0, 5, now) + excess_of(budget, 6, 1, now) + excess_of(budget, 1, 1, now));
  }
  excess_of(budget, 0, 5, now);
  UNSIGNED_LONGS_EQUAL(1, excess_of(budget, 8, 1, now));
  // Silence for any time saves no more than that.
  excess_of(budget, 0, 1'000'000, now);
  UNSIGNED_LONGS_EQUAL(1, excess_of(budget, 8, 1, now));
}

TEST(FrameBudget, NodeThatSendsOftenerOrMoreSeldomThanTheLabLooksIsHeldToItsOwnPeriod) {
  FrameBudget slow(4 * kDueNs, kHeldUpNs);
  for (int i = 0; i < 1000; ++i) {
    UNSIGNED_LONGS_EQUAL(0, slow.excess(i % 4 == 0 ? 1 : 0, now += kDueNs));
  }
  std::uint64_t excess = 0;
  for (int i = 0; i < 12; ++i) {
    excess += slow.excess(i % 2 == 0 ? 1 : 0, now += kDueNs);
  }
  CHECK(excess > 0);
  FrameBudget fast(kDueNs / 10, kHeldUpNs);
  for (int i = 0; i < 1000; ++i) {
    UNSIGNED_LONGS_EQUAL(0, fast.excess(10, now += kDueNs));
  }
  CHECK(fast.excess(20, now += kDueNs) > 0);
}

TEST(FrameBudget, WhatHadGatheredWhileTheLabDidNotLookIsNotCounted) {
  now += 1'000 * kDueNs;
  UNSIGNED_LONGS_EQUAL(0, budget.excess(1'000, now));
  budget.forget();
  UNSIGNED_LONGS_EQUAL(0, budget.excess(1'000, now += kDueNs));
  UNSIGNED_LONGS_EQUAL(0, excess_of(budget, 1, 100, now));
}

}  // namespace hotfire::firmware::can
