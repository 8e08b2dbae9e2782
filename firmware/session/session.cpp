// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/session.hpp"

#include <optional>

#include "firmware/text/text.hpp"

namespace hotfire::firmware {

namespace {

/// What made a run bad or unsafe, whatever the limits; nothing if it was neither.
std::optional<Verdict> failed_run(const Session& session) {
  const LoopResult& result = session.result;
  if (result.ending != Ending::completed && result.ending != Ending::asked) {
    return Verdict{false, std::string(kEndings[static_cast<std::size_t>(result.ending)]),
                   result.ending == Ending::not_finite ? kBadData : kTiming};
  }
  if (session.lab && session.lab->first != Fault{}) {
    const FaultText& fault = text_of(session.lab->first);
    return Verdict{false,
                   text("interlock: fault %d, %s: %s; see docs/faults.md", static_cast<int>(fault.fault), fault.name.data(),
                        fault.meaning.data()),
                   kInterlock};
  }
  if (session.lab && !session.lab->lines_dropped) {
    return Verdict{false, "the lines cannot be set to off: take the supply away by hand", kHardware};
  }
  if (session.lab && !session.lab->left_the_bus) {
    return Verdict{false, "a command is still before the bus: take the interface down", kHardware};
  }
  return std::nullopt;
}

/// What a run that did not fail has not reached, whatever the limits; nothing if it has.
std::optional<Verdict> unfinished_run(const Session& session) {
  if (session.lab && !session.lab->came_to_rest) {
    return Verdict{false, "a piston still moved when the stopping time was over", kBadVerdict};
  }
  if (session.lab && !session.lab->completed) {
    return Verdict{false, "a stop was requested before the profile had ended", kBadVerdict};
  }
  if (session.bus && session.bus->state >= hal::CanState::bus_off) {
    const char* const state = hal::kCanStates[static_cast<std::size_t>(session.bus->state)];
    return Verdict{false, session.bus->interface + " is " + state + ": correct the fault of the bus and start again",
                   kHardware};
  }
  return std::nullopt;
}

}  // namespace

Verdict judge(const Session& session) {
  const RunOptions& options = session.options;
  const LoopResult& result = session.result;
  std::optional<Verdict> bad = failed_run(session);
  if (session.recording != nullptr && session.recording->is_error) {
    const std::string& why = session.recording->failure;
    if (bad) {
      bad->reason += "; the recording failed too: " + why;
    } else {
      bad = Verdict{false, "the recording failed: " + why, kHardware};
    }
  }
  bad = bad ? bad : unfinished_run(session);
  if (bad) {
    return *bad;
  }
  Verdict verdict;
  const auto add = [&](bool met, const std::string& reason) {
    verdict.good = verdict.good && met;
    verdict.status = verdict.good ? kGood : kTiming;
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
  if (session.max_lost && session.bus) {
    add(session.bus->lost() <= *session.max_lost,
        text("%llu frames lost or out of order, allowed %llu", static_cast<unsigned long long>(session.bus->lost()),
             static_cast<unsigned long long>(*session.max_lost)));
  }
  if (session.recording != nullptr) {
    const std::uint64_t dropped = session.recording->dropped();
    add(dropped <= session.max_dropped,
        text("%llu cycles missing in the recording, allowed %llu", static_cast<unsigned long long>(dropped),
             static_cast<unsigned long long>(session.max_dropped)));
  }
  if (verdict.reason.empty()) {
    verdict.reason = "no limit was set";
  }
  return verdict;
}

}  // namespace hotfire::firmware
