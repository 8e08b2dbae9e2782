// SPDX-License-Identifier: Apache-2.0
#include "tests/doctor/patient.hpp"
#include "tools/doctor/files.hpp"

namespace hotfire::doctor {

using test::expect_good;
using test::expect_remedy;

TEST_GROUP(DoctorMachine) {
  test::PatientFiles files;
  Patient patient = files.patient();

  void setup() override {
    files.put("proc/sys/kernel/osrelease", "6.1.0-rt-amd64");
    files.put("sys/kernel/realtime", "1");
    files.put("proc/version", "Linux version 6.1.0 #1 SMP PREEMPT_RT Debian");
    files.put("proc/cmdline", "root=/dev/sda1 quiet");
    files.put("sys/devices/system/cpu/isolated", "1-2");
    files.put("sys/devices/system/cpu/nohz_full", "1-2");
    files.put("sys/devices/system/cpu/smt/active", "0");
    files.put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
    files.put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
    files.put("sys/devices/system/cpu/cpu0/cpuidle/state0/name", "C1");
    files.put("proc/self/limits",
              "Max locked memory         unlimited            unlimited            bytes\n"
              "Max realtime priority     99                   99");
    files.put("proc/self/status", "Name:\thotfire\nCapEff:\t0000000000000000");
    files.put("proc/sys/kernel/sched_rt_runtime_us", "950000");
    files.put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    files.put("sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet acpi_pm");
    files.put("dev/cpu_dma_latency", "");
  }

  Finding found(const char* check) const { return test::finding_of(look_at_machine(patient), check); }
};

TEST(DoctorMachine, MachineThatIsSetUpWellHasNothingButGoodFindings) {
  patient.cpu = 1;
  for (const Finding& finding : look_at_machine(patient)) {
    expect_good(finding);
  }
}

TEST(DoctorMachine, MachineThatReportsNothingIsNotCalledGood) {
  test::PatientFiles nothing;
  Patient silent = nothing.patient();
  silent.root /= "nowhere";
  const std::vector<Finding> findings = look_at_machine(silent);
  for (const char* check : {"kernel", "preemption", "isolation", "memory lock", "priority", "clock source"}) {
    CHECK(test::finding_of(findings, check).level != Level::good);
  }
}

TEST(DoctorMachine, KernelWithoutPreemptRtIsNamedWithThePackage) {
  files.put("sys/kernel/realtime", "0");
  expect_remedy(found("kernel"), Level::bad, "6.1.0-rt-amd64 is not a PREEMPT_RT", "apt install linux-image-rt-amd64");
}

TEST(DoctorMachine, PreemptionIsFullChosenAtBootOrNone) {
  files.put("proc/version", "Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC Debian");
  expect_remedy(found("preemption"), Level::advice, "not booted with preempt=full", "boot with preempt=full");
  files.put("proc/cmdline", "quiet preempt=full");
  expect_good(found("preemption"));
  files.put("proc/version", "Linux version 6.1.0 #1 SMP Debian");
  expect_remedy(found("preemption"), Level::bad, "not preempted", "linux-image-rt");
}

TEST(DoctorMachine, CpuOfTheLoopHasToBeAmongTheIsolatedOnesAndWithoutTick) {
  patient.cpu = 3;
  expect_remedy(found("isolation"), Level::advice, "CPU 3 is not isolated (isolated: 1-2)", "isolcpus=3");
  files.put("sys/devices/system/cpu/isolated", "");
  expect_remedy(found("isolation"), Level::advice, "no CPU is", "isolcpus=3");
  files.put("sys/devices/system/cpu/isolated", "3");
  expect_remedy(found("isolation"), Level::advice, "has a timer tick", "nohz_full=3");
  patient.cpu.reset();
  files.put("sys/devices/system/cpu/isolated", "");
  expect_remedy(found("isolation"), Level::advice, "no CPU is isolated", "isolcpus=1");
}

TEST(DoctorMachine, CpuThatSharesItsCoreIsNamedWithItsSiblings) {
  files.put("sys/devices/system/cpu/smt/active", "1");
  files.put("sys/devices/system/cpu/cpu1/topology/thread_siblings_list", "1,5");
  expect_remedy(found("hyper-threads"), Level::advice, "CPU 1 shares its core (CPUs 1,5)", "smt/control");
}

TEST(DoctorMachine, GovernorThatFollowsTheLoadIsBadOnTheCpusThatMatter) {
  files.put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  expect_remedy(found("governor"), Level::bad, "cpu0 powersave", "cpupower frequency-set -g performance");
  patient.cpu = 1;
  expect_good(found("governor"));
}

TEST(DoctorMachine, LimitsOfMemoryAndPriorityAreMendedForAGroupOrMadeUpForByCapabilities) {
  files.put("proc/self/limits",
            "Max locked memory         8388608              8388608              bytes\n"
            "Max realtime priority     0                    0");
  expect_remedy(found("memory lock"), Level::bad, "8388608 bytes", "@realtime - memlock unlimited");
  expect_remedy(found("priority"), Level::bad, "up to 0 are allowed", "@realtime - rtprio 99");
  // CAP_IPC_LOCK is 14, CAP_SYS_NICE 23.
  files.put("proc/self/status", "CapEff:\t0000000000804000");
  expect_good(found("memory lock"));
  expect_good(found("priority"));
  files.put("proc/self/status", "CapEff:\t0000000000004000");
  CHECK(found("priority").level == Level::bad);
}

TEST(DoctorMachine, ThrottleThatLeavesNothingIsBadAndNoneAtAllIsToBeConsidered) {
  files.put("proc/sys/kernel/sched_rt_runtime_us", "0");
  expect_remedy(found("throttle"), Level::bad, "no time is left", "sched_rt_runtime_us=950000");
  files.put("proc/sys/kernel/sched_rt_runtime_us", "-1");
  expect_remedy(found("throttle"), Level::advice, "off", "sched_rt_runtime_us=950000");
}

TEST(DoctorMachine, SlowClockSourceIsMendedByTheFastOneIfThereIsOne) {
  const std::string folder = "sys/devices/system/clocksource/clocksource0/";
  files.put(folder + "current_clocksource", "hpet");
  expect_remedy(found("clock source"), Level::bad, "hpet: reading the time", "echo tsc >");
  files.put(folder + "available_clocksource", "hpet acpi_pm");
  expect_remedy(found("clock source"), Level::bad, "hpet", "tsc=reliable");
}

TEST(DoctorMachine, SleepStatesThatCannotBeHeldOffAreToBeConsidered) {
  std::filesystem::remove(patient.root / "dev/cpu_dma_latency");
  expect_remedy(found("sleep states"), Level::advice, "/dev/cpu_dma_latency cannot be written", "udev/rules.d");
  std::filesystem::remove_all(patient.root / "sys/devices/system/cpu/cpu0/cpuidle");
  expect_good(found("sleep states"));
}

TEST(DoctorMachine, ListsOfSysAreReadWithTheirRanges) {
  CHECK(list_has("1-3,7", 2) && list_has("1-3,7", 7) && list_has("0", 0));
  CHECK(!list_has("1-3,7", 4) && !list_has("", 0) && !list_has("(null)", 0));
}

}  // namespace hotfire::doctor
