// SPDX-License-Identifier: Apache-2.0
#include "firmware/recording/recording_ring.hpp"

#include <CppUTest/TestHarness.h>

#include <cstring>
#include <thread>

namespace hotfire::firmware {

namespace {

bool fill(RecordingRing& ring, std::uint64_t value) {
  std::byte* const slot = ring.try_claim();
  if (slot == nullptr) {
    return false;
  }
  std::memcpy(slot, &value, sizeof value);
  ring.publish();
  return true;
}

std::uint64_t value_at(std::span<const std::byte> slots, std::size_t index) {
  std::uint64_t value = 0;
  std::memcpy(&value, slots.data() + index * sizeof value, sizeof value);
  return value;
}

}  // namespace

TEST_GROUP(RecordingRing){};

TEST(RecordingRing, FullRingRefusesUntilASlotIsReleased) {
  RecordingRing ring(8, 3);
  CHECK(fill(ring, 0) && fill(ring, 1) && fill(ring, 2));
  CHECK(!fill(ring, 3));
  UNSIGNED_LONGS_EQUAL(0, value_at(ring.filled(1), 0));
  ring.release(1);
  CHECK(fill(ring, 3));
  CHECK(!fill(ring, 4));
}

TEST(RecordingRing, FilledSlotsAreGivenOldestFirstUpToTheEndOfTheMemory) {
  RecordingRing ring(8, 4);
  for (std::uint64_t i = 0; i < 3; ++i) {
    fill(ring, i);
  }
  ring.release(3);
  for (std::uint64_t i = 3; i < 7; ++i) {
    CHECK(fill(ring, i));
  }
  UNSIGNED_LONGS_EQUAL(8, ring.filled(100).size());
  UNSIGNED_LONGS_EQUAL(3, value_at(ring.filled(100), 0));
  ring.release(1);
  UNSIGNED_LONGS_EQUAL(24, ring.filled(100).size());
  UNSIGNED_LONGS_EQUAL(16, ring.filled(2).size());
  UNSIGNED_LONGS_EQUAL(6, value_at(ring.filled(100), 2));
}

TEST(RecordingRing, TwoThreadsLoseNothingAndKeepTheOrder) {
  constexpr std::uint64_t kValues = 200'000;
  RecordingRing ring(8, 64);
  std::thread filler([&ring] {
    for (std::uint64_t value = 0; value < kValues;) {
      if (fill(ring, value)) {
        ++value;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t expected = 0;
  bool in_order = true;
  while (expected < kValues) {
    const std::span<const std::byte> slots = ring.filled(7);
    for (std::size_t i = 0; i < slots.size() / 8; ++i) {
      in_order = in_order && value_at(slots, i) == expected++;
    }
    ring.release(slots.size() / 8);
    if (slots.empty()) {
      std::this_thread::yield();
    }
  }
  filler.join();
  CHECK(in_order);
}

}  // namespace hotfire::firmware
