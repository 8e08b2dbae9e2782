// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "firmware/service/watchdog.hpp"
#include "firmware/session/live_session.hpp"
#include "firmware/session/recording_session.hpp"
#include "firmware/session/session.hpp"
#include "hal/realtime.hpp"
#include "hal/service_manager.hpp"

namespace hotfire::firmware {

/// Set by SIGINT, SIGTERM, SIGHUP (the terminal is gone) and SIGQUIT after a call of `stop_on_signals`. After that call, a
/// closed output pipe and the limit of a file's size do not end the process either.
extern std::atomic<bool> stop_asked;
void stop_on_signals();

/// SIGTSTP (Ctrl-Z) requests a stop too, because a suspended loop would leave its outputs unchanged.
void stop_instead_of_suspending();

/// Stores a refusal, prints it to standard error, and returns whether the call succeeded.
bool granted(const std::optional<hal::Failure>& failure, std::vector<hal::Failure>& failures);

/// Locks memory, binds and schedules this thread. True if everything was requested and granted.
bool set_up_real_time(const RunOptions& options, hal::WakefulCpus& cpus, std::vector<hal::Failure>& failures);

/// Prints the progress for a person at the terminal.
void announce(const RunOptions& options);

/// Resources that the thread has used, with the allocations that a linked guard counts.
struct Usage {
  hal::ResourceUsage resources;
  std::optional<std::uint64_t> allocations;

  static Usage now() noexcept;
};

/// Prints the report; returns the exit status.
int finish(const Session& session);

/// How a run ends, in this order.
struct RunEnd {
  /// Makes the rig safe. Called before any call that may wait, for a disk for example.
  std::function<void()> make_safe = [] {};
  /// Closes the recording; null if there is none.
  std::function<const RecorderAccount*()> close_recording = [] { return nullptr; };
  /// What only the caller knows.
  std::function<void(Session&)> complete = [](Session&) {};
};

/// The end of a run with a live view, and with a recording if it has one.
RunEnd end_with(RecordingSession* recording, LiveSession& live, std::function<void(Session&)> complete);

/// Goes through the end of a run whose loop has ended.
void end_run(Session& session, const RunEnd& end, Watchdog& watchdog);

/// Runs a loop that is completely set up except for real time, and reports. `ended` becomes true when the loop is to end;
/// without it, a signal ends the loop.
template <class Loop>
int run_loop(Loop& loop, Session& session, const RunEnd& end, const std::atomic<bool>& ended = stop_asked) {
  const RunOptions& options = session.options;
  Watchdog watchdog(hal::ServiceManager::from_environment(), loop.heartbeat());
  granted(watchdog.start(), session.failures);
  hal::WakefulCpus cpus;
  session.real_time = set_up_real_time(options, cpus, session.failures);
  if (options.require_realtime && !session.real_time) {
    std::fputs("hotfire-rt: --require-realtime is not met, nothing was run\n", stderr);
    return kTiming;
  }
  stop_on_signals();
  announce(options);
  session.started = std::time(nullptr);
  Usage warm = Usage::now();
  loop.run(ended, [&]() noexcept { warm = Usage::now(); });
  const Usage used = Usage::now();
  session.place = hal::cpu_place();
  session.usage = used.resources - warm.resources;
  if (used.allocations) {
    session.allocations = *used.allocations - *warm.allocations;
  }
  end_run(session, end, watchdog);
  return finish(session);
}

}  // namespace hotfire::firmware
