#include "firmware/session.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>

#include "firmware/plant.hpp"
#include "firmware/plant_image.hpp"
#include "firmware/recording_session.hpp"
#include "firmware/reference_plant.hpp"
#include "firmware/status.hpp"
#include "firmware/text.hpp"
#include "firmware/watchdog.hpp"
#include "hal/denormals.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/sim/plant_bus.hpp"
#include "hal/sim/sync_source.hpp"

/// Allocations since the start of the process, where a test links the guard that counts them.
extern "C" std::uint64_t hotfire_allocation_count() noexcept __attribute__((weak));

namespace hotfire::firmware {
namespace {

constexpr std::size_t kStackBytes = 512 * 1024;

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void ask_to_stop(int) { stop_asked.store(true, std::memory_order_relaxed); }

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Keeps what was refused, and says whether the call was granted.
bool granted(const std::optional<hal::Failure>& failure, std::vector<hal::Failure>& failures) {
  if (failure) {
    failures.push_back(*failure);
    std::fprintf(stderr, "hotfire-rt: %s\n  mend: %s\n", failure->what.c_str(), failure->mend.c_str());
  }
  return !failure;
}

bool set_up_real_time(const Options& options, hal::WakefulCpus& cpus, std::vector<hal::Failure>& failures) {
  const bool locked = granted(hal::lock_memory(kStackBytes), failures);
  const bool placed = !options.cpu || granted(hal::run_on_cpu(*options.cpu), failures);
  if (options.priority == 0) {
    return false;
  }
  granted(cpus.hold(), failures);
  return granted(hal::schedule_first(options.priority), failures) && locked && placed;
}

/// What the thread has used, with the allocations that a linked guard counts.
struct Usage {
  hal::ResourceUsage resources;
  std::uint64_t allocations = 0;

  static Usage now() noexcept {
    return {hal::resource_usage(), hotfire_allocation_count != nullptr ? hotfire_allocation_count() : 0};
  }
};

hal::ResourceUsage difference(const hal::ResourceUsage& after, const hal::ResourceUsage& before) {
  return {after.minor_faults - before.minor_faults, after.major_faults - before.major_faults,
          after.involuntary_switches - before.involuntary_switches};
}

/// Says what is going on to a person who looks on.
void announce(const Options& options) {
  if (isatty(STDERR_FILENO) == 0) {
    return;
  }
  const double seconds = static_cast<double>(options.loop.cycles + options.loop.warm_up_cycles) *
                         static_cast<double>(options.loop.period_ns) * 1e-9;
  const std::string until = options.loop.cycles == 0 ? "until Ctrl-C" : text("for %.1f s, Ctrl-C ends it sooner", seconds);
  std::fprintf(stderr, "hotfire-rt: running %s\n", until.c_str());
}

int finish(const Session& session) {
  const std::string report = session.options.json ? json_report(session) : text_report(session);
  std::fputs(report.c_str(), stdout);
  if (session.result.ending == Ending::not_finite) {
    std::fputs("hotfire-rt: the plant's values are no longer finite: its parameters do not describe a stable plant\n",
               stderr);
    return kBadData;
  }
  return judge(session).good ? kGood : kTiming;
}

/// Runs a loop that is set up but for real time, and reports.
template <class Loop>
int run_loop(Loop& loop, Session& session, RecordingSession* recording) {
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
  loop.run(stop_asked, [&]() noexcept { warm = Usage::now(); });
  const Usage end = Usage::now();
  watchdog.stop();
  session.ended = std::time(nullptr);
  session.place = hal::cpu_place();
  session.usage = difference(end.resources, warm.resources);
  if (hotfire_allocation_count != nullptr) {
    session.allocations = end.allocations - warm.allocations;
  }
  if (recording != nullptr) {
    session.recording = &recording->close();
  }
  return finish(session);
}

template <class Model>
int run_plant(const Options& options, const typename Model::Parameters& parameters, const PlantImage& image) {
  using Bus = PlayedBus<hal::sim::SimulatedPlantBus>;
  using Clock = hal::PosixClock;
  using Syncs = hal::sim::SimulatedSyncSource<Clock>;
  const double period = static_cast<double>(options.loop.period_ns) * 1e-9;
  const int steps = model::steps_per_period(period);
  const hal::FlushDenormals flush;
  const auto plant = std::make_unique<Plant<Model>>(parameters, period, options.actuators, image.faults);
  hal::sim::SimulatedPlantBus wire(options.source, period);
  Bus bus(wire, image.faults, period);
  Clock clock;

  std::unique_ptr<RecordingSession> recording;
  if (!options.recording.empty()) {
    recording = std::make_unique<RecordingSession>(options, RecordedPlant::of<Model>(*plant, steps, image.text));
    if (const auto failure = recording->start()) {
      std::fprintf(stderr, "hotfire-rt: %s\n  mend: %s\n", failure->what.c_str(), failure->mend.c_str());
      return kWrongUse;
    }
  }
  const auto run = [&]<class Pace>(Pace pace) {
    const auto loop = std::make_unique<Loop<Plant<Model>, Bus, Clock, Pace, Recorder>>(
        *plant, bus, clock, options.loop, pace, recording ? &recording->recorder() : nullptr);
    Session session{options, loop->result(), Model::topology, Model::channels, Model::channel_units, steps};
    return run_loop(*loop, session, recording.get());
  };
  if (options.pace == PaceKind::sim) {
    Syncs syncs(clock, options.loop.period_ns);
    return run(SyncPace<Clock, Syncs>(clock, syncs, options.loop.period_ns, options.most_missed_syncs));
  }
  return run(OwnPace<Clock>(clock, options.loop.period_ns));
}

}  // namespace

Verdict judge(const Session& session) {
  const Options& options = session.options;
  const LoopResult& result = session.result;
  if (result.ending != Ending::completed && result.ending != Ending::asked) {
    return {false, std::string(kEndings[static_cast<std::size_t>(result.ending)])};
  }
  Verdict verdict;
  const auto add = [&](bool met, const std::string& reason) {
    verdict.good = verdict.good && met;
    verdict.reason += (verdict.reason.empty() ? "" : ", ") + reason;
  };
  if (options.max_overruns) {
    const auto overruns = static_cast<unsigned long long>(result.account.overruns());
    add(overruns <= *options.max_overruns,
        text("%llu overruns, allowed %llu", overruns, static_cast<unsigned long long>(*options.max_overruns)));
  }
  if (options.max_latency_us) {
    const double latest = static_cast<double>(result.account.latency().greatest_ns()) * 1e-3;
    add(latest <= *options.max_latency_us, text("latest wake-up %.1f us, allowed %g us", latest, *options.max_latency_us));
  }
  if (options.max_step_us) {
    const double longest = static_cast<double>(result.account.step_time().greatest_ns()) * 1e-3;
    add(longest <= *options.max_step_us, text("longest step %.1f us, allowed %g us", longest, *options.max_step_us));
  }
  if (session.recording != nullptr) {
    const std::uint64_t dropped = session.recording->dropped();
    add(dropped <= options.max_dropped,
        text("%llu cycles missing in the recording, allowed %llu", static_cast<unsigned long long>(dropped),
             static_cast<unsigned long long>(options.max_dropped)));
  }
  if (verdict.reason.empty()) {
    verdict.reason = "no limit asked for";
  }
  return verdict;
}

int run_session(const Options& options) {
  if (options.image.empty()) {
    return run_plant<model::Simplex<double>>(options, reference_plant_with_every_effect(), {});
  }
  const PlantImage image = read_plant_image(options.image);
  if (!image.parameters) {
    std::fprintf(stderr, "hotfire-rt: %s\n", image.error.c_str());
    return kBadData;
  }
  if (const auto* simplex = std::get_if<model::Simplex<double>::Parameters>(&*image.parameters)) {
    return run_plant<model::Simplex<double>>(options, *simplex, image);
  }
  return run_plant<model::Direct<double>>(options, std::get<model::Direct<double>::Parameters>(*image.parameters), image);
}

}  // namespace hotfire::firmware
