// SPDX-License-Identifier: Apache-2.0
#include "hal/realtime.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace hotfire::hal {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kStackBlock = 64 * kPage;
/// What a program may still allocate before its first cycle, with a margin.
constexpr std::size_t kStillAllocated = 1024 * kPage;

/// Touches one page after the other, a block a call. It uses its block after the call, so that the compiler cannot turn the
/// recursion into a loop over one block.
__attribute__((noinline)) char touch_stack(std::size_t bytes) noexcept {
  volatile char block[kStackBlock];
  for (std::size_t i = 0; i < kStackBlock; i += kPage) {
    block[i] = 1;
  }
  const char deeper = bytes > kStackBlock ? touch_stack(bytes - kStackBlock) : '\0';
  return static_cast<char>(deeper + block[0]);
}

/// True if that much more memory can be mapped, where all that is mapped is locked.
bool may_map(std::size_t bytes) noexcept {
  void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return mapped != MAP_FAILED && munmap(mapped, bytes) == 0;
}

}  // namespace

std::optional<Failure> lock_memory(std::size_t stack_bytes) noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  rlimit limit{};
  getrlimit(RLIMIT_STACK, &limit);
  // The stack grows before it is locked: the kernel ends a process whose locked stack grows beyond the limit of the user.
  static_cast<void>(touch_stack(std::min<std::size_t>(stack_bytes, limit.rlim_cur / 2)));
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0 || !may_map(kStillAllocated)) {
    const int error = errno;
    munlockall();
    return failed_call("memory is not locked: mlockall", error,
                       "allow it: 'ulimit -l unlimited', or '@realtime - memlock unlimited' in /etc/security/limits.d, or "
                       "'setcap cap_ipc_lock,cap_sys_nice+ep hotfire-rt', or LimitMEMLOCK=infinity in a systemd unit");
  }
  return std::nullopt;
}

std::optional<Failure> run_on_cpu(int cpu) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu >= 0 && cpu < CPU_SETSIZE) {
    CPU_SET(static_cast<std::size_t>(cpu), &set);
  }
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    return failed_call(
        "not bound to CPU " + std::to_string(cpu) + ": sched_setaffinity", errno,
        "name one of the CPUs that this process may use, see 'taskset -p $$' and /sys/devices/system/cpu/online");
  }
  return std::nullopt;
}

std::optional<Failure> schedule_first(int priority) noexcept {
  // An ordinary process, which this one stays if it is refused, is else woken up to 50 us late to save power.
  prctl(PR_SET_TIMERSLACK, 1);
  const sched_param parameter{priority};
  if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0) {
    return failed_call("no real-time scheduling at priority " + std::to_string(priority) + ": sched_setscheduler", errno,
                       "allow it: 'ulimit -r 99', or '@realtime - rtprio 99' in /etc/security/limits.d, or "
                       "'setcap cap_ipc_lock,cap_sys_nice+ep hotfire-rt', or LimitRTPRIO=99 in a systemd unit");
  }
  return std::nullopt;
}

std::optional<Failure> schedule_by_deadline(std::int64_t period_ns) noexcept {
  prctl(PR_SET_TIMERSLACK, 1);
  // As <linux/sched/types.h> has it, which the C library's <sched.h> excludes.
  struct {
    std::uint32_t size;
    std::uint32_t policy;
    std::uint64_t flags;
    std::int32_t nice;
    std::uint32_t priority;
    std::uint64_t runtime;
    std::uint64_t deadline;
    std::uint64_t period;
  } attributes{};
  attributes.size = sizeof attributes;
  attributes.policy = SCHED_DEADLINE;
  attributes.flags = 1;  // SCHED_FLAG_RESET_ON_FORK: threads that it starts are ordinary ones
  attributes.runtime = static_cast<std::uint64_t>(kDeadlineShare * static_cast<double>(period_ns));
  attributes.deadline = static_cast<std::uint64_t>(period_ns);
  attributes.period = attributes.deadline;
  if (syscall(SYS_sched_setattr, 0, &attributes, 0U) != 0) {
    return failed_call(
        "no scheduling by deadline: sched_setattr", errno,
        "run as root or with 'setcap cap_sys_nice+ep hotfire-rt', allow every CPU ('taskset -p $$'), and leave "
        "the kernel its share: 95 % of /proc/sys/kernel/sched_rt_period_us; else --scheduler fifo");
  }
  return std::nullopt;
}

WakefulCpus::~WakefulCpus() {
  if (file_ >= 0) {
    close(file_);
  }
}

std::optional<Failure> WakefulCpus::hold() noexcept {
  const std::string remedy =
      "allow writing /dev/cpu_dma_latency, or boot with processor.max_cstate=1; matters only where the "
      "wake-up latency is too long";
  file_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file_ < 0) {
    return failed_call("CPUs may fall into deep sleep: /dev/cpu_dma_latency", errno, remedy);
  }
  const std::int32_t longest_us = 0;
  if (write(file_, &longest_us, sizeof longest_us) != sizeof longest_us) {
    return failed_call("CPUs may fall into deep sleep: write to /dev/cpu_dma_latency", errno, remedy);
  }
  return std::nullopt;
}

ResourceUsage resource_usage() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {usage.ru_minflt, usage.ru_majflt, usage.ru_nivcsw};
}

CpuPlace cpu_place() noexcept {
  CpuPlace place;
  getcpu(&place.cpu, &place.node);
  return place;
}

SystemInfo system_info() {
  utsname name{};
  uname(&name);
  char flag = '0';
  std::ifstream("/sys/kernel/realtime") >> flag;
  return {name.sysname, name.nodename, name.release, name.version, name.machine, flag == '1'};
}

}  // namespace hotfire::hal
