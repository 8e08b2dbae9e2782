// SPDX-License-Identifier: Apache-2.0
#include "hal/realtime.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::hal {

TEST_GROUP(Realtime){};

TEST(Realtime, PriorityThatNoMachineHasIsRefusedWithTheRemedy) {
  const auto failure = schedule_first(1000);
  CHECK(failure.has_value());
  STRCMP_CONTAINS("priority 1000", failure->what.c_str());
  STRCMP_CONTAINS("ulimit -r", failure->remedy.c_str());
}

TEST(Realtime, CpuThatDoesNotExistIsRefusedWithTheRemedy) {
  const auto failure = run_on_cpu(1023);
  CHECK(failure.has_value());
  STRCMP_CONTAINS("CPU 1023", failure->what.c_str());
  STRCMP_CONTAINS("taskset", failure->remedy.c_str());
  CHECK(run_on_cpu(-1).has_value());
}

TEST(Realtime, PeriodThatTheKernelDoesNotScheduleIsRefusedWithTheRemedy) {
  const auto failure = schedule_by_deadline(1);
  CHECK(failure.has_value());
  STRCMP_CONTAINS("sched_setattr", failure->what.c_str());
  STRCMP_CONTAINS("--scheduler fifo", failure->remedy.c_str());
}

TEST(Realtime, TouchingNewMemoryIsCountedAsPageFaults) {
  const ResourceUsage before = resource_usage();
  std::string memory(std::size_t{64} << 20, 'x');
  const ResourceUsage after = resource_usage();
  CHECK(after.minor_faults > before.minor_faults);
  BYTES_EQUAL('x', memory[memory.size() / 2]);
}

TEST(Realtime, SystemInfoNamesTheKernel) {
  const SystemInfo system = system_info();
  STRCMP_EQUAL("Linux", system.sysname.c_str());
  CHECK(!system.release.empty());
  CHECK(!system.machine.empty());
}

}  // namespace hotfire::hal
