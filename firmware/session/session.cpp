// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/session.hpp"

#include "firmware/text/text.hpp"

namespace hotfire::firmware {

Verdict judge(const Session& session) {
  const RunOptions& options = session.options;
  const LoopResult& result = session.result;
  if (result.ending != Ending::completed && result.ending != Ending::asked) {
    return {false, std::string(kEndings[static_cast<std::size_t>(result.ending)]),
            result.ending == Ending::not_finite ? kBadData : kTiming};
  }
  if (session.lab && session.lab->first != Fault{}) {
    const FaultText& fault = text_of(session.lab->first);
    return {false,
            text("interlock: fault %d, %s: %s; see docs/faults.md", static_cast<int>(fault.fault), fault.name.data(),
                 fault.meaning.data()),
            kInterlock};
  }
  if (session.lab && !session.lab->left_the_bus) {
    return {false, "a command is still before the bus: take the interface down", kHardware};
  }
  if (session.lab && !session.lab->completed) {
    return {false, "asked to stop before the profile had ended", kBadVerdict};
  }
  if (session.bus && session.bus->state >= hal::CanState::bus_off) {
    const char* const state = hal::kCanStates[static_cast<std::size_t>(session.bus->state)];
    return {false, session.bus->interface + " is " + state + ": correct the fault of the bus and start again", kHardware};
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
  if (session.recording != nullptr && session.recording->is_error) {
    add(false, "the recording failed: " + session.recording->failure);
    verdict.status = kHardware;
  }
  if (verdict.reason.empty()) {
    verdict.reason = "no limit asked for";
  }
  return verdict;
}

}  // namespace hotfire::firmware
