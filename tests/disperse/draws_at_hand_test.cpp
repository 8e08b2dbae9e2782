// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/mpi/draws_at_hand.hpp"

#include <numeric>

#include <CppUTest/TestHarness.h>

namespace hotfire {

TEST_GROUP(DrawsAtHand){};

TEST(DrawsAtHand, EveryDrawIsHandedOutOnceInBlocksThatBecomeSmaller) {
  DrawsAtHand draws(1000, 2);
  draws.has(0, {});
  draws.has(1, {});
  std::vector<int> all;
  std::size_t before = 1001;
  int blocks = 0;
  for (;;) {
    const std::vector<int> block = draws.take(blocks % 2);
    if (block.empty()) {
      break;
    }
    CHECK_TRUE(block.size() <= before);
    before = block.size();
    all.insert(all.end(), block.begin(), block.end());
    ++blocks;
  }
  std::vector<int> expected(1001);
  std::iota(expected.begin(), expected.end(), 0);
  CHECK_TRUE(all == expected);
  LONGS_EQUAL(1, before);
  CHECK_TRUE(blocks < 60);  // each costs a message
  // The first is a fourth of an even share.
  LONGS_EQUAL(126, DrawsAtHand(1000, 2).take(1).size());
}

TEST(DrawsAtHand, WhatIsStoredIsNotRunAgainAndComesFromTheRankThatHasIt) {
  DrawsAtHand draws(9, 3);
  draws.has(0, {0, 1, 2});
  draws.has(1, {2, 3, 4});
  draws.has(2, {4, 5});
  CHECK_TRUE(draws.take(1) == std::vector<int>({3, 4}));
  CHECK_TRUE(draws.take(2) == std::vector<int>({5}));
  CHECK_TRUE(draws.take(1) == std::vector<int>({6}));
  CHECK_TRUE(draws.take(0) == std::vector<int>({7}));
  CHECK_TRUE(draws.take(2) == std::vector<int>({8}));
  CHECK_TRUE(draws.take(2) == std::vector<int>({9}));
  CHECK_TRUE(draws.take(0).empty());
}

}  // namespace hotfire
