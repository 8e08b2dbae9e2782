// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "tools/doctor/doctor.hpp"
#include "tools/doctor/files.hpp"

namespace hotfire::doctor {

namespace {

constexpr const char* kBootOptions =
    "put it into GRUB_CMDLINE_LINUX_DEFAULT of /etc/default/grub, then: update-grub && reboot";

Finding kernel(const Patient& patient) {
  const std::string release = text_of(patient.root / "proc/sys/kernel/osrelease").value_or("unknown");
  if (text_of(patient.root / "sys/kernel/realtime") == "1") {
    return {"kernel", Level::good, "PREEMPT_RT, " + release, ""};
  }
  return {"kernel", Level::bad, release + " is not a PREEMPT_RT kernel: a driver can hold the CPU for milliseconds",
          "apt install linux-image-rt-amd64 && reboot"};
}

Finding preemption(const Patient& patient) {
  const std::string version = text_of(patient.root / "proc/version").value_or("");
  const std::string command_line = text_of(patient.root / "proc/cmdline").value_or("");
  const bool is_full =
      version.find("PREEMPT_RT") != std::string::npos ||
      (version.find("PREEMPT_DYNAMIC") != std::string::npos && command_line.find("preempt=full") != std::string::npos) ||
      version.find(" PREEMPT ") != std::string::npos;
  if (is_full) {
    return {"preemption", Level::good, "the kernel can be preempted", ""};
  }
  if (version.find("PREEMPT_DYNAMIC") != std::string::npos) {
    return {"preemption", Level::advice,
            "the kernel can be preempted at certain points only, because it was not booted with preempt=full",
            std::string("boot with preempt=full: ") + kBootOptions};
  }
  return {"preemption", Level::bad, "the kernel is not preempted while it works for another process",
          "apt install linux-image-rt-amd64 && reboot"};
}

Finding isolation(const Patient& patient) {
  const std::string isolated = text_of(patient.root / "sys/devices/system/cpu/isolated").value_or("");
  const std::string nohz = text_of(patient.root / "sys/devices/system/cpu/nohz_full").value_or("");
  const std::string wanted = patient.cpu ? std::to_string(*patient.cpu) : "1";
  const std::string remedy = fmt::format(
      "boot with isolcpus={0} nohz_full={0} rcu_nocbs={0} irqaffinity=0 and run with --cpu {0}: {1}", wanted, kBootOptions);
  if (patient.cpu && !list_has(isolated, *patient.cpu)) {
    return {"isolation", Level::advice,
            fmt::format("CPU {} is not isolated ({}): other processes run on it", *patient.cpu,
                        isolated.empty() ? "no CPU is" : "isolated: " + isolated),
            remedy};
  }
  if (isolated.empty()) {
    return {"isolation", Level::advice, "no CPU is isolated: the loop shares its CPU with other processes", remedy};
  }
  if (patient.cpu && !list_has(nohz, *patient.cpu)) {
    return {"isolation", Level::advice, fmt::format("CPU {} is isolated but has a timer tick", *patient.cpu), remedy};
  }
  return {"isolation", Level::good, "isolated CPUs: " + isolated, ""};
}

Finding hyper_threads(const Patient& patient) {
  if (text_of(patient.root / "sys/devices/system/cpu/smt/active").value_or("0") != "1") {
    return {"hyper-threads", Level::good, "no CPU shares its core", ""};
  }
  const std::string cpu = std::to_string(patient.cpu.value_or(1));
  const std::string siblings =
      text_of(patient.root / ("sys/devices/system/cpu/cpu" + cpu + "/topology/thread_siblings_list")).value_or("unknown");
  return {"hyper-threads", Level::advice,
          fmt::format("CPU {} shares its core (CPUs {}): work on one slows the other", cpu, siblings),
          "echo off > /sys/devices/system/cpu/smt/control"};
}

Finding governor(const Patient& patient) {
  const std::filesystem::path cpus = patient.root / "sys/devices/system/cpu";
  std::string slow;
  bool any = false;
  for (const std::string& name : names_in(cpus)) {
    const auto governor = text_of(cpus / name / "cpufreq/scaling_governor");
    any = any || governor.has_value();
    if (governor && *governor != "performance" && (!patient.cpu || name == "cpu" + std::to_string(*patient.cpu))) {
      slow += fmt::format("{}{} {}", slow.empty() ? "" : ", ", name, *governor);
    }
  }
  if (!slow.empty()) {
    return {"governor", Level::bad, "the clock rate follows the load, and the loop is little of it: " + slow,
            "cpupower frequency-set -g performance"};
  }
  return {"governor", Level::good, any ? "performance" : "the clock rate is not scaled by this kernel", ""};
}

/// The soft limit of this process; "unlimited", a number, or empty if it is not there.
std::string limit_of(const Patient& patient, const std::string& name) {
  std::istringstream lines(text_of(patient.root / "proc/self/limits").value_or(""));
  std::string line;
  while (std::getline(lines, line)) {
    if (line.starts_with(name)) {
      std::istringstream words(line.substr(name.size()));
      std::string soft;
      words >> soft;
      return soft;
    }
  }
  return "";
}

/// Whether this process has a capability, by its number in linux/capability.h.
bool has_capability(const Patient& patient, int number) {
  const std::string status = text_of(patient.root / "proc/self/status").value_or("");
  const std::size_t at = status.find("CapEff:");
  if (at == std::string::npos) {
    return false;
  }
  return ((std::strtoull(status.c_str() + at + 7, nullptr, 16) >> number) & 1) != 0;
}

constexpr const char* kGroupMend =
    "printf '@realtime - rtprio 99\\n@realtime - memlock unlimited\\n' > /etc/security/limits.d/realtime.conf; groupadd -f "
    "realtime; usermod -aG realtime $USER; log in again";

Finding memory_lock(const Patient& patient) {
  constexpr int kCapIpcLock = 14;
  const std::string limit = limit_of(patient, "Max locked memory");
  if (limit == "unlimited" || has_capability(patient, kCapIpcLock)) {
    return {"memory lock", Level::good, "all memory may be locked", ""};
  }
  return {"memory lock", Level::bad,
          fmt::format("{} bytes may be locked, the loop needs all of its memory", limit.empty() ? "0" : limit), kGroupMend};
}

Finding priority(const Patient& patient) {
  constexpr int kCapSysNice = 23;
  constexpr long kWanted = 80;
  const std::string limit = limit_of(patient, "Max realtime priority");
  if (has_capability(patient, kCapSysNice) || limit == "unlimited" || std::strtol(limit.c_str(), nullptr, 10) >= kWanted) {
    return {"priority", Level::good, "real-time priorities are allowed", ""};
  }
  return {"priority", Level::bad,
          fmt::format("real-time priorities up to {} are allowed, the loop needs {}", limit.empty() ? "0" : limit, kWanted),
          kGroupMend};
}

Finding throttle(const Patient& patient) {
  const std::string runtime = text_of(patient.root / "proc/sys/kernel/sched_rt_runtime_us").value_or("");
  const long share = std::strtol(runtime.c_str(), nullptr, 10);
  if (runtime.empty() || share > 0) {
    return {"throttle", Level::good,
            runtime.empty() ? "this kernel has none" : runtime + " us of a period are for real-time processes", ""};
  }
  return {"throttle", share == 0 ? Level::bad : Level::advice,
          share == 0 ? "no time is left for real-time processes" : "off: an overloaded loop locks everyone out",
          "sysctl kernel.sched_rt_runtime_us=950000"};
}

Finding clock_source(const Patient& patient) {
  const std::filesystem::path folder = patient.root / "sys/devices/system/clocksource/clocksource0";
  const std::string current = text_of(folder / "current_clocksource").value_or("unknown");
  const std::string available = text_of(folder / "available_clocksource").value_or("");
  for (const char* slow : {"hpet", "acpi_pm", "jiffies", "refined-jiffies", "unknown"}) {
    if (current == slow) {
      const bool has_tsc = (" " + available + " ").find(" tsc ") != std::string::npos;
      return {"clock source", Level::bad, current + ": reading the time is a system call of a microsecond or more",
              has_tsc ? "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource"
                      : std::string("boot with tsc=reliable, if the processor's counter is steady: ") + kBootOptions};
    }
  }
  return {"clock source", Level::good, current + ", read without a system call", ""};
}

Finding sleep_states(const Patient& patient) {
  const std::filesystem::path device = patient.root / "dev/cpu_dma_latency";
  if (names_in(patient.root / "sys/devices/system/cpu/cpu0/cpuidle").empty()) {
    return {"sleep states", Level::good, "the processor has none that this kernel uses", ""};
  }
  if (access(device.c_str(), W_OK) == 0) {
    return {"sleep states", Level::good, "can be held off", ""};
  }
  return {"sleep states", Level::advice, "/dev/cpu_dma_latency cannot be written: the CPU may sleep deeply between cycles",
          "echo 'KERNEL==\"cpu_dma_latency\", GROUP=\"realtime\", MODE=\"0660\"' > "
          "/etc/udev/rules.d/99-realtime.rules && udevadm trigger"};
}

}  // namespace

std::vector<Finding> look_at_machine(const Patient& patient) {
  return {kernel(patient),      preemption(patient), isolation(patient), hyper_threads(patient), governor(patient),
          memory_lock(patient), priority(patient),   throttle(patient),  clock_source(patient),  sleep_states(patient)};
}

std::vector<Finding> look(const Patient& patient) {
  std::vector<Finding> findings = look_at_machine(patient);
  for (const auto& more : {look_at_can(patient), look_at_gpio(patient)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

}  // namespace hotfire::doctor
