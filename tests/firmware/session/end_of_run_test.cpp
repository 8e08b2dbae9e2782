// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "firmware/lab/lab_end.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "firmware/session/run_loop.hpp"
#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/firmware/recording/recorded_run.hpp"

namespace hotfire::firmware {

TEST_GROUP(EndOfRun) {
  const std::atomic<std::uint64_t> heartbeat{0};
  Watchdog watchdog{hal::ServiceManager(), heartbeat};
  RunOptions options;
  LoopResult result{1'000'000};
  Session session{options, result, "lab", {}, {}};
};

TEST(EndOfRun, LinesAreDroppedBeforeTheRecordingIsClosedWhichADiskMayHoldUp) {
  test_lab::LabOnWire bench(test_lab::settings());
  bench.cycles(2);
  bench.press();
  CHECK(bench.on(kSupply));
  std::vector<std::string> order;
  RunEnd end;
  end.make_safe = [&] {
    make_lab_safe(
        bench.rig,
        [&](bool) {
          CHECK(!bench.on(kSupply));
          order.emplace_back("bus");
          return true;
        },
        [&] { order.emplace_back("last cycle"); });
  };
  end.close_recording = [&] {
    // A disk that stalls would hold the program here.
    CHECK(!bench.on(kSupply));
    order.emplace_back("recording");
    return nullptr;
  };
  end.complete = [&](Session&) { order.emplace_back("complete"); };
  end_run(session, end, watchdog);
  CHECK((order == std::vector<std::string>{"bus", "last cycle", "recording", "complete"}));
}

TEST(EndOfRun, FaultLineOfAFaultedRigIsHeldUntilTheBusIsLeft) {
  test_lab::LabOnWire bench(test_lab::settings());
  bench.cycles(2);
  bench.press();
  bench.wire.hold();
  bench.cycle();
  bench.drive(kEmergencyStopReleased, false);
  bench.cycle();
  // The command of the cycle before may still be before the bus.
  bool asked = false;
  const LabEnd end = make_lab_safe(
      bench.rig,
      [&](bool may_wait) {
        asked = true;
        CHECK(!may_wait);
        CHECK(bench.on(kFault));
        CHECK(!bench.on(kSupply));
        return false;
      },
      [&] { UNSIGNED_LONGS_EQUAL(0, bench.board.outputs()); });
  CHECK(asked);
  CHECK(end.lines_dropped);
  CHECK(!end.left_the_bus);
}

TEST(EndOfRun, LinesThatCannotBeSetAreSaid) {
  test_lab::LabOnWire bench(test_lab::settings());
  bench.cycles(2);
  bench.board.set_broken(true);
  const LabEnd end = make_lab_safe(
      bench.rig,
      [](bool may_wait) {
        CHECK(may_wait);
        return true;
      },
      [] {});
  CHECK(!end.lines_dropped);
  CHECK(end.left_the_bus);
}

TEST(EndOfRun, TheLastCycleIsRecordedWithTheFaultThatEndedIt) {
  test_lab::LabOnWire bench(test_lab::settings());
  test::MemorySink disk;
  Recorder recorder(disk, 1, kLabChannels.size(), 100);
  CHECK(!recorder.start());
  LabRecorder<test_lab::LabOnWire::Rig> lab_recorder(recorder, bench.rig);
  hal::CycleHead head;
  bench.after_cycle = [&] {
    lab_recorder.record(head, {}, bench.rig.measured());
    ++head.cycle;
  };
  bench.cycles(2);
  bench.press();
  bench.drive(kEmergencyStopReleased, false);
  bench.cycle();
  lab_recorder.finish();
  lab_recorder.finish();
  UNSIGNED_LONGS_EQUAL(head.cycle, recorder.close().stored);
  hal::CycleHead last;
  const std::size_t bytes = hal::cycle_bytes(1, kLabChannels.size());
  // The end of a recording is a head without cycles.
  std::memcpy(&last, disk.bytes.data() + disk.bytes.size() - sizeof(hal::BlockHead) - bytes, sizeof last);
  UNSIGNED_LONGS_EQUAL(head.cycle - 1, last.cycle);
  UNSIGNED_LONGS_EQUAL(static_cast<std::uint64_t>(Fault::emergency_stop),
                       (last.flags >> hal::CycleHead::kFaultShift) & 0xff);
  UNSIGNED_LONGS_EQUAL(static_cast<std::uint64_t>(RigState::faulted), (last.flags >> hal::CycleHead::kStateShift) & 0xff);
}

}  // namespace hotfire::firmware
