// SPDX-License-Identifier: Apache-2.0
// What can happen to a program, and a mark of it among the writes to the lines, seen from outside of the machine:
// rig_event stop|kill PID; rig_event panic; rig_event end. Port 0xe9 is where the rig's GPIO bank tells its lines
// (tests/rig/kernel); a line is a byte below 128, a mark one above.

#include <fcntl.h>
#include <sched.h>
#include <sys/io.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

constexpr unsigned short kPort = 0xe9;
enum Mark : unsigned char { kStopped = 0x81, kKilled = 0x82, kPanic = 0x83, kEnd = 0x8f };

int fail(const char* what) {
  std::perror(what);
  return 1;
}

}  // namespace

int main(int count, char** values) {
  const std::string event = count > 1 ? values[1] : "";
  const bool of_process = event == "stop" || event == "kill";
  if ((of_process ? count != 3 : count != 2) || !(of_process || event == "panic" || event == "end")) {
    std::fprintf(stderr, "usage: rig_event stop|kill PID, or rig_event panic, or rig_event end\n");
    return 2;
  }
  const sched_param first{sched_get_priority_max(SCHED_FIFO)};
  if (sched_setscheduler(0, SCHED_FIFO, &first) != 0 || ioperm(kPort, 1, 1) != 0) {
    return fail("rig_event");
  }
  if (of_process) {
    char* end = nullptr;
    const long process = std::strtol(values[2], &end, 10);
    if (*end != '\0' || process <= 1 || kill(static_cast<pid_t>(process), event == "stop" ? SIGSTOP : SIGKILL) != 0) {
      return fail("kill");
    }
    outb(event == "stop" ? kStopped : kKilled, kPort);
  } else if (event == "end") {
    outb(kEnd, kPort);
  } else {
    const int trigger = open("/proc/sysrq-trigger", O_WRONLY);
    if (trigger < 0) {
      return fail("sysrq-trigger");
    }
    outb(kPanic, kPort);
    return write(trigger, "c", 1) == 1 ? 0 : fail("sysrq");
  }
  return 0;
}
