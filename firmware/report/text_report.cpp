// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "firmware/session/session.hpp"
#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

std::string quantiles(const char* title, const Histogram& histogram) {
  return text("  %-13s min %.1f   median %.1f   99 %% %.1f   max %.1f us\n", title, us(histogram.least_ns()),
              us(histogram.quantile_ns(0.5)), us(histogram.quantile_ns(0.99)), us(histogram.greatest_ns()));
}

/// Rows of equal width up to the 99.9 % point, then one for all that is longer. Bars are logarithmic: the rare late
/// wake-ups are what the picture is looked at for.
std::string picture(const Histogram& histogram) {
  constexpr std::size_t kRows = 14;
  constexpr double kMarksPerDecade = 10.0;
  const auto bin_of = [&](std::int64_t ns) {
    return static_cast<std::size_t>(std::max<std::int64_t>(ns, 0) / histogram.bin_ns());
  };
  const auto row_text = [&](std::size_t low, const std::string& high, std::uint64_t count) {
    const auto marks =
        count > 0 ? static_cast<std::size_t>(1.0 + kMarksPerDecade * std::log10(static_cast<double>(count))) : 0;
    return text("  %6.0f - %-6s %9llu %s\n", us(static_cast<std::int64_t>(low) * histogram.bin_ns()), high.c_str(),
                whole(count), std::string(marks, '#').c_str());
  };
  const std::size_t first = std::min(bin_of(histogram.least_ns()), Histogram::kBins - 1);
  const std::size_t last = std::min(std::max(bin_of(histogram.quantile_ns(0.999)), first), Histogram::kBins - 1);
  const std::size_t width = (last - first) / kRows + 1;
  std::string result = "\n  wake-up latency [us], bars logarithmic\n";
  std::uint64_t shown = 0;
  std::size_t low = first;
  for (; low <= last; low += width) {
    const std::size_t high = std::min(low + width, Histogram::kBins);
    std::uint64_t count = 0;
    for (std::size_t bin = low; bin < high; ++bin) {
      count += histogram.counts()[bin];
    }
    shown += count;
    result += row_text(low, text("%.0f", us(static_cast<std::int64_t>(high) * histogram.bin_ns())), count);
  }
  const std::uint64_t longer = histogram.count() - shown;
  return result + (longer > 0 ? row_text(low, "longer", longer) : "");
}

std::string overruns(const CycleAccount& account) {
  std::string result = text("  overruns      %llu", whole(account.overruns()));
  for (std::size_t i = 0; account.overruns() > 0 && i < kBlameNames.size(); ++i) {
    result += text("%s %s %llu", i == 0 ? ", by phase:" : ",", kBlameNames[i].data(),
                   whole(account.blamed(static_cast<Blame>(i))));
  }
  return result + "\n";
}

std::string worst_cycle(const CycleAccount& account) {
  const CycleAccount::Worst& worst = account.worst();
  const auto phases = [](const CycleAccount::Phases& ns) {
    return text("wake-up %.1f, read %.1f, step %.1f, write %.1f, account %.1f us", us(ns[0]), us(ns[1]), us(ns[2]),
                us(ns[3]), us(ns[4]));
  };
  return text("  worst cycle   %llu: %s; longest: %s\n  worst phases  %s, each in its own cycle\n", whole(worst.cycle),
              phases(worst.phases_ns).c_str(), kBlameNames[static_cast<std::size_t>(worst.blame)].data(),
              phases(account.longest()).c_str());
}

std::string scheduling(const Session& session) {
  if (!session.real_time) {
    return "  real time     NO: the system refused a part of it; the figures below do not describe a real-time machine\n";
  }
  const std::string scheduler =
      session.options.scheduler == Scheduler::deadline ? "SCHED_DEADLINE" : text("SCHED_FIFO %d", session.options.priority);
  return text("  real time     yes: %s, memory locked, %s\n", scheduler.c_str(),
              session.options.cpu ? text("CPU %d", *session.options.cpu).c_str() : "any CPU");
}

std::string last_reading(const Session& session) {
  std::string result = "  last reading  ";
  // Of the first actuator.
  for (std::size_t i = 0; i < session.channels.size(); ++i) {
    result += text("%s%s %.6g %s", i == 0 ? "" : ", ", session.channels[i].data(), session.result.last_reading.values[i],
                   session.channel_units[i].data());
  }
  return result + "\n";
}

std::string recording(const Session& session) {
  if (session.recording == nullptr) {
    return {};
  }
  const RecorderAccount& account = *session.recording;
  return text("  recording     %s: %llu of %llu cycles, %llu dropped%s%s\n", std::string(session.recording_file).c_str(),
              whole(account.stored), whole(account.offered), whole(account.dropped()),
              account.failure.empty() ? "" : "; ended early: ", account.failure.c_str());
}

std::string lab(const Session& session) {
  if (!session.lab) {
    return {};
  }
  const LabAccount& account = *session.lab;
  std::string result =
      text("  interlock     %s, armed %llu times, profile %s\n", kRigStates[static_cast<std::size_t>(account.state)].data(),
           whole(account.armings), account.completed ? "run to its end" : "NOT run to its end");
  for (const FaultText& fault : kFaults) {
    const std::uint64_t times = account.times_first[static_cast<std::size_t>(fault.fault)];
    result += times == 0 ? ""
                         : text("  fault %-8d%s: the first one %llu times\n", static_cast<int>(fault.fault),
                                fault.name.data(), whole(times));
  }
  return result;
}

}  // namespace

std::string text_report(const Session& session) {
  const LoopResult& result = session.result;
  const CycleAccount& account = result.account;
  const Verdict verdict = judge(session);
  const double period_us = us(session.options.loop.period_ns);
  const std::size_t actuators = session.options.actuators;
  std::string report = text("%s%s%s on bus %s, period %.0f us, %d %s a cycle, after an overrun: %s\n",
                            actuators == 1 || session.is_vehicle ? "" : text("%zu times ", actuators).c_str(),
                            session.topology.data(), session.is_vehicle ? text(" of %zu actuators", actuators).c_str() : "",
                            session.bus ? session.bus->interface.c_str() : "sim", period_us, session.steps_per_cycle,
                            session.steps_per_cycle == 1 ? "step" : "steps",
                            kOverrunPolicies[static_cast<std::size_t>(session.options.loop.policy)].data());
  report += scheduling(session);
  report += text("  cycles        %llu at %.4f Hz, %s; before them %llu of warm-up, %llu of these overran\n",
                 whole(account.cycles()), account.rate(), kEndings[static_cast<std::size_t>(result.ending)].data(),
                 whole(result.warm_up_cycles), whole(result.warm_up_overruns));
  report += overruns(account);
  report += text("  left out      %llu cycles skipped, %llu %s held, %llu %s lost\n", whole(result.skipped),
                 whole(result.held_commands), session.input.data(), whole(result.lost_readings), session.output.data());
  report += lab(session);
  report += session.bus ? text_of(*session.bus) : "";
  if (account.cycles() > 0) {
    report += quantiles("wake-up", account.latency()) + quantiles("step", account.step_time()) + worst_cycle(account);
  }
  report += text("  kernel        %lld minor and %lld major page faults, %lld involuntary context switches\n",
                 static_cast<long long>(session.usage.minor_faults), static_cast<long long>(session.usage.major_faults),
                 static_cast<long long>(session.usage.involuntary_switches));
  if (session.allocations) {
    report += text("  allocations   %llu\n", whole(*session.allocations));
  }
  if (session.synchronised) {
    report += text("  syncs         %llu missed\n", whole(result.missed_syncs));
  }
  report += recording(session) + last_reading(session) + text("  state hash    %016llx\n", whole(result.hash.value()));
  if (account.latency().count() > 0) {
    report += picture(account.latency());
  }
  return report + text("\nverdict: %s (%s)%s\n", verdict.good ? "good" : "BAD", verdict.reason.c_str(),
                       session.real_time ? "" : ", as an ordinary process");
}

}  // namespace hotfire::firmware
