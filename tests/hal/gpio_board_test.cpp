// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/gpio_board.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::hal {

TEST_GROUP(GpioBoard) {
  GpioSettings settings() const {
    GpioSettings made;
    made.inputs = {{"estop", true, true}, {"supply"}};
    made.outputs = {{"enable"}, {"fault", false, true}};
    return made;
  }
  sim::GpioBoard board{settings()};
  std::array<GpioEdge, 4> edges{};
};

TEST(GpioBoard, OutputsAreSafeBeforeTheFirstWrite) {
  LONGS_EQUAL(0b10, board.outputs());
  CHECK(board.try_write(0b01));
  LONGS_EQUAL(0b01, board.outputs());
}

TEST(GpioBoard, ChipThatDoesNotAnswerLeavesLevelsAlone) {
  GpioLevels levels = 7;
  board.set_broken(true);
  CHECK(!board.try_read(levels));
  CHECK(!board.try_write(0b01));
  LONGS_EQUAL(7, levels);
  LONGS_EQUAL(0b10, board.outputs());
}

TEST(GpioBoard, ChangesOfLinesWithEdgesAreReportedOnceInOrder) {
  board.drive(0, true, 5);
  board.drive(1, true, 6);
  board.drive(0, true, 7);
  board.drive(0, false, 8);
  UNSIGNED_LONGS_EQUAL(2, board.read_edges(edges));
  CHECK(edges[0].active);
  LONGS_EQUAL(8, edges[1].time_ns);
  UNSIGNED_LONGS_EQUAL(0, board.read_edges(edges));
  GpioLevels levels = 0;
  CHECK(board.try_read(levels));
  LONGS_EQUAL(0b10, levels);
}

TEST(GpioBoard, EdgesThatDoNotFitWaitAndThoseBeyondTheQueueAreCountedLost) {
  for (std::size_t i = 0; i < sim::GpioBoard::kMaxEdges + 3; ++i) {
    board.drive(0, i % 2 == 0);
  }
  UNSIGNED_LONGS_EQUAL(3, board.lost_edges());
  std::size_t seen = 0;
  for (std::size_t count = 1; count > 0; seen += count) {
    count = board.read_edges(edges);
  }
  UNSIGNED_LONGS_EQUAL(sim::GpioBoard::kMaxEdges, seen);
}

}  // namespace hotfire::hal
