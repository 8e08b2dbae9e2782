// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/failure.hpp"

namespace hotfire::hal {

/// The set-up of a real-time process before its loop. Each function returns nothing if it succeeds, and never throws. After
/// a failure the process continues as before. Call all of them from the thread that will run the loop, after everything that
/// the loop uses has been allocated: memory first, then CPU, then priority.

/// Locks all present and future pages. Touches `stack_bytes` of stack, so that the loop causes no page fault there. Keeps
/// the heap from returning pages to the kernel and from mappings of its own, which both take unbounded time.
std::optional<Failure> lock_memory(std::size_t stack_bytes) noexcept;

/// Runs this thread on one CPU only.
std::optional<Failure> run_on_cpu(int cpu) noexcept;

/// Schedules this thread first-in first-out at a priority of 1 to 99, above every ordinary process. Its sleeps end without
/// slack even if the kernel refuses the priority.
std::optional<Failure> schedule_first(int priority) noexcept;

/// Share of its period that a thread with deadline scheduling may take. The kernel grants 95 % to all such threads together.
inline constexpr double kDeadlineShare = 0.9;

/// Schedules this thread by its deadline (SCHED_DEADLINE). In every period of `period_ns` it has `kDeadlineShare` of it,
/// before every first-in first-out thread. A thread that takes more sleeps until its next period. The kernel grants it only
/// to a thread that may run on every CPU, and up to the share of all real-time threads.
std::optional<Failure> schedule_by_deadline(std::int64_t period_ns) noexcept;

/// During its life, the CPUs do not enter sleep states that take long to leave.
class WakefulCpus {
 public:
  WakefulCpus() = default;
  ~WakefulCpus();
  WakefulCpus(const WakefulCpus&) = delete;
  WakefulCpus& operator=(const WakefulCpus&) = delete;

  std::optional<Failure> hold() noexcept;

 private:
  int file_ = -1;
};

/// Page faults and context switches of this thread since it began.
struct ResourceUsage {
  std::int64_t minor_faults = 0;          ///< pages given without reading a disk
  std::int64_t major_faults = 0;          ///< pages read from a disk
  std::int64_t involuntary_switches = 0;  ///< times another thread took the CPU

  friend ResourceUsage operator-(const ResourceUsage& after, const ResourceUsage& before) noexcept {
    return {after.minor_faults - before.minor_faults, after.major_faults - before.major_faults,
            after.involuntary_switches - before.involuntary_switches};
  }
};

/// Does not block or allocate.
ResourceUsage resource_usage() noexcept;

/// The CPU this thread runs on now, and its memory node.
struct CpuPlace {
  unsigned cpu = 0;
  unsigned node = 0;
};
CpuPlace cpu_place() noexcept;

/// The kernel and machine this runs on.
struct SystemInfo {
  std::string sysname;
  std::string nodename;
  std::string release;
  std::string version;
  std::string machine;
  bool realtime_kernel = false;  ///< PREEMPT_RT
};
SystemInfo system_info();

}  // namespace hotfire::hal
