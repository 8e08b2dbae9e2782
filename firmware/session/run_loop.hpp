#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "firmware/service/watchdog.hpp"
#include "firmware/session/recording_session.hpp"
#include "firmware/session/session.hpp"
#include "hal/realtime.hpp"
#include "hal/service_manager.hpp"

namespace hotfire::firmware {

/// Set by SIGINT and SIGTERM once `stop_on_signals` was called.
extern std::atomic<bool> stop_asked;
void stop_on_signals();

/// Keeps what was refused, prints it to standard error, and says whether the call was granted.
bool granted(const std::optional<hal::Failure>& failure, std::vector<hal::Failure>& failures);

/// Locks memory, binds and schedules this thread. True if all of it was granted and asked for.
bool set_up_real_time(const Options& options, hal::WakefulCpus& cpus, std::vector<hal::Failure>& failures);

/// Says what is going on to a person who looks on.
void announce(const Options& options);

/// What the thread has used, with the allocations that a linked guard counts.
struct Usage {
  hal::ResourceUsage resources;
  std::optional<std::uint64_t> allocations;

  static Usage now() noexcept;
};

/// Prints the report; returns the exit status.
int finish(const Session& session);

/// Runs a loop that is set up but for real time, and reports. `complete` is called when it has ended, for what only the
/// caller knows. `ended`: becomes true when the loop is to end, else when a signal has asked for it.
template <class Loop>
int run_loop(Loop& loop, Session& session, RecordingSession* recording, const std::function<void(Session&)>& complete,
             const std::atomic<bool>& ended = stop_asked) {
  const Options& options = session.options;
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
  const Usage end = Usage::now();
  watchdog.stop();
  session.ended = std::time(nullptr);
  session.place = hal::cpu_place();
  session.usage = end.resources - warm.resources;
  if (end.allocations) {
    session.allocations = *end.allocations - *warm.allocations;
  }
  if (recording != nullptr) {
    session.recording = &recording->close();
  }
  complete(session);
  return finish(session);
}

}  // namespace hotfire::firmware
