// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/session.hpp"
#include "firmware/text/json.hpp"
#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

std::string rfc_2822(std::time_t time) {
  char buffer[64];
  std::tm local{};
  std::strftime(buffer, sizeof buffer, "%a, %d %b %Y %H:%M:%S %z", localtime_r(&time, &local));
  return buffer;
}

void add_system(Json& json) {
  const hal::SystemInfo system = hal::system_info();
  json.open("sysinfo");
  json.add("sysname", system.sysname);
  json.add("nodename", system.nodename);
  json.add("release", system.release);
  json.add("version", system.version);
  json.add("machine", system.machine);
  json.add("realtime", system.realtime_kernel ? 1 : 0);
  json.close();
}

/// Wake-up latencies as cyclictest gives them: whole microseconds.
void add_thread(Json& json, const Session& session) {
  const Histogram& latency = session.result.account.latency();
  json.open("thread");
  json.open("0");
  json.open("histogram");
  for (std::size_t bin = 0; bin < Histogram::kBins; ++bin) {
    if (latency.counts()[bin] > 0) {
      json.add(std::to_string(bin), latency.counts()[bin]);
    }
  }
  json.close();
  json.add("cycles", session.result.account.cycles());
  json.add("min", latency.least_ns() / 1000);
  json.add("max", latency.greatest_ns() / 1000);
  json.add("avg", latency.mean_ns() * 1e-3);
  json.add("cpu", session.place.cpu);
  json.add("node", session.place.node);
  json.close();
  json.close();
}

void add_durations(Json& json, const char* key, const Histogram& histogram) {
  json.open(key);
  json.add("min", us(histogram.least_ns()));
  json.add("median", us(histogram.quantile_ns(0.5)));
  json.add("p99", us(histogram.quantile_ns(0.99)));
  json.add("max", us(histogram.greatest_ns()));
  json.add("mean", histogram.mean_ns() * 1e-3);
  json.add("overflow", histogram.overflow());
  json.close();
}

void add_overruns(Json& json, const Session& session) {
  const CycleAccount& account = session.result.account;
  json.add("overruns", account.overruns());
  json.open("blame");
  for (std::size_t i = 0; i < kBlameNames.size(); ++i) {
    json.add(kBlameNames[i], account.blamed(static_cast<Blame>(i)));
  }
  json.close();
  const CycleAccount::Worst& worst = account.worst();
  json.open("worst_cycle_us");
  json.add("cycle", worst.cycle);
  for (std::size_t i = 0; i < worst.phases_ns.size(); ++i) {
    json.add(kPhaseNames[i], us(worst.phases_ns[i]));
  }
  json.add("longest", kBlameNames[static_cast<std::size_t>(worst.blame)]);
  json.close();
  json.open("worst_phases_us");
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) {
    json.add(kPhaseNames[i], us(account.longest()[i]));
  }
  json.close();
}

void add_real_time(Json& json, const Session& session) {
  json.add("real_time", session.real_time);
  json.add("scheduler", kSchedulers[static_cast<std::size_t>(session.options.scheduler)]);
  json.open_list("refused");
  for (const hal::Failure& failure : session.failures) {
    json.open();
    json.add("what", failure.what);
    json.add("remedy", failure.remedy);
    json.close();
  }
  json.close_list();
  json.add("minor_page_faults", session.usage.minor_faults);
  json.add("major_page_faults", session.usage.major_faults);
  json.add("involuntary_context_switches", session.usage.involuntary_switches);
  if (session.allocations) {
    json.add("allocations", *session.allocations);
  }
}

void add_recording(Json& json, const Session& session) {
  if (session.recording == nullptr) {
    return;
  }
  json.open("recording");
  json.add("file", session.recording_file);
  json.add("offered", session.recording->offered);
  json.add("stored", session.recording->stored);
  json.add("dropped", session.recording->dropped());
  json.add("failure", session.recording->failure);
  json.close();
}

void add_lab(Json& json, const LabAccount& lab) {
  json.open("interlock");
  json.add("state", kRigStates[static_cast<std::size_t>(lab.state)]);
  json.add("armings", lab.armings);
  json.add("completed", lab.completed);
  json.add("came_to_rest", lab.came_to_rest);
  json.add("lines_dropped", lab.lines_dropped);
  json.add("first_fault", static_cast<int>(lab.first));
  json.open("ended_driving");
  for (const FaultText& fault : kFaults) {
    const std::uint64_t times = lab.times_first[static_cast<std::size_t>(fault.fault)];
    if (times > 0) {
      json.add(fault.name, times);
    }
  }
  json.close();
  json.close();
}

void add_own(Json& json, const Session& session) {
  const LoopResult& result = session.result;
  const Verdict verdict = judge(session);
  json.open("hotfire");
  json.add("verdict", verdict.good ? "good" : "bad");
  json.add("reason", verdict.reason);
  json.add("ending", kEndings[static_cast<std::size_t>(result.ending)]);
  json.add("topology", session.topology);
  json.add("period_us", us(session.options.loop.period_ns));
  json.add("steps_per_cycle", session.steps_per_cycle);
  json.add("policy", kOverrunPolicies[static_cast<std::size_t>(session.options.loop.policy)]);
  json.add("rate_hz", result.account.rate());
  json.add("warm_up_cycles", result.warm_up_cycles);
  json.add("warm_up_overruns", result.warm_up_overruns);
  add_overruns(json, session);
  json.add("skipped_cycles", result.skipped);
  json.add("held_commands", result.held_commands);
  json.add("lost_readings", result.lost_readings);
  json.add("missed_syncs", result.missed_syncs);
  json.add("actuators", static_cast<std::uint64_t>(session.options.actuators));
  if (session.lab) {
    add_lab(json, *session.lab);
  }
  if (session.bus) {
    add_to(json, *session.bus);
  }
  add_recording(json, session);
  add_durations(json, "wake_up_us", result.account.latency());
  add_durations(json, "step_us", result.account.step_time());
  add_real_time(json, session);
  json.open("last_reading");
  for (std::size_t i = 0; i < session.channels.size(); ++i) {
    json.add(session.channels[i], result.last_reading.values[i]);
  }
  json.close();
  json.add("state_hash", text("%016llx", static_cast<unsigned long long>(result.hash.value())));
  json.close();
}

}  // namespace

std::string json_report(const Session& session) {
  Json json;
  json.open();
  json.add("file_version", 1);
  // The colons inside these two keys are cyclictest's own.
  json.add("cmdline:", session.options.command_line);
  json.add("rt_test_version:", "hotfire " HOTFIRE_VERSION);
  json.add("start_time", rfc_2822(session.started));
  json.add("end_time", rfc_2822(session.ended));
  json.add("return_code", static_cast<int>(judge(session).status));
  add_system(json);
  json.add("num_threads", 1);
  json.add("resolution_in_ns", 0);
  add_thread(json, session);
  add_own(json, session);
  json.close();
  return json.text() + "\n";
}

}  // namespace hotfire::firmware
