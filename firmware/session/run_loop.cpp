// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/run_loop.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "firmware/session/can_session.hpp"
#include "firmware/text/text.hpp"

/// Allocations since the start of the process, where a test links the guard that counts them.
extern "C" std::uint64_t hotfire_allocation_count() noexcept __attribute__((weak));

namespace hotfire::firmware {
namespace {

constexpr std::size_t kStackBytes = 512 * 1024;

static_assert(std::atomic<bool>::is_always_lock_free);
void ask_to_stop(int) { stop_asked.store(true, std::memory_order_relaxed); }

}  // namespace

std::atomic<bool> stop_asked{false};

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    sigaction(signal, &action, nullptr);
  }
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGXFSZ}) {
    sigaction(signal, &action, nullptr);
  }
}

void stop_instead_of_suspending() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  sigaction(SIGTSTP, &action, nullptr);
}

RunEnd end_with(RecordingSession* recording, LiveSession& live, std::function<void(Session&)> complete) {
  RunEnd end;
  end.complete = [&live, complete = std::move(complete)](Session& session) {
    live.close(session.result.ending);
    complete(session);
  };
  if (recording != nullptr) {
    end.close_recording = [recording] { return &recording->close(); };
  }
  return end;
}

void end_run(Session& session, const RunEnd& end, Watchdog& watchdog) {
  end.make_safe();
  watchdog.stop();
  session.ended = std::time(nullptr);
  session.recording = end.close_recording();
  end.complete(session);
}

bool granted(const std::optional<hal::Failure>& failure, std::vector<hal::Failure>& failures) {
  if (failure) {
    failures.push_back(*failure);
    complain(*failure);
  }
  return !failure;
}

bool set_up_real_time(const RunOptions& options, hal::WakefulCpus& cpus, std::vector<hal::Failure>& failures) {
  const bool locked = granted(hal::lock_memory(kStackBytes), failures);
  const bool placed = !options.cpu || granted(hal::run_on_cpu(*options.cpu), failures);
  if (options.priority == 0) {
    return false;
  }
  granted(cpus.hold(), failures);
  const bool scheduled = options.scheduler == Scheduler::deadline
                             ? granted(hal::schedule_by_deadline(options.loop.period_ns), failures)
                             : granted(hal::schedule_first(options.priority), failures);
  return scheduled && locked && placed;
}

void announce(const RunOptions& options) {
  if (isatty(STDERR_FILENO) == 0) {
    return;
  }
  const double seconds = static_cast<double>(options.loop.cycles + options.loop.warm_up_cycles) *
                         static_cast<double>(options.loop.period_ns) * 1e-9;
  const std::string until = options.loop.cycles == 0 ? "until Ctrl-C" : text("for %.1f s, Ctrl-C ends it sooner", seconds);
  std::fprintf(stderr, "hotfire-rt: running %s\n", until.c_str());
}

Usage Usage::now() noexcept {
  Usage usage{hal::resource_usage(), std::nullopt};
  if (hotfire_allocation_count != nullptr) {
    usage.allocations = hotfire_allocation_count();
  }
  return usage;
}

int finish(const Session& session) {
  const std::string report = session.options.json ? json_report(session) : text_report(session);
  std::fputs(report.c_str(), stdout);
  if (session.result.ending == Ending::not_finite) {
    std::fputs("hotfire-rt: the plant's values are no longer finite: its parameters do not describe a stable plant\n",
               stderr);
  }
  return judge(session).status;
}

}  // namespace hotfire::firmware
