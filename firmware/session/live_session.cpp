// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/live_session.hpp"

#include "firmware/interlock/interlock.hpp"
#include "firmware/lab/lab_image.hpp"

namespace hotfire::firmware {
namespace {

/// How long a cycle stays for those who look: the program that serves a page is an ordinary one and may be late.
constexpr std::int64_t kKeptNs = 1'000'000'000;

std::function<std::uint64_t()> reading(const std::uint64_t& count) {
  return [&count] { return count; };
}

/// The numbers of endings begin with 1: 0 is a program that runs.
std::uint64_t number_of(Ending ending) noexcept { return static_cast<std::uint64_t>(ending) + 1; }

hal::LiveDescription describe(const RunOptions& options, const RecordedPlant& plant,
                              const std::vector<LiveCounter>& counters) {
  hal::LiveDescription description;
  description.header = recording_header(options, plant);
  description.header.model.clear();
  for (std::size_t i = 0; plant.topology == kLabTopology && i < kRigStates.size(); ++i) {
    description.states.push_back({i, std::string(kRigStates[i])});
  }
  for (const FaultText& text : kFaults) {
    description.faults.push_back(
        {static_cast<std::uint64_t>(text.fault), std::string(text.name), std::string(text.meaning)});
  }
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    description.endings.push_back({number_of(static_cast<Ending>(i)), std::string(kEndings[i])});
  }
  for (const LiveCounter& counter : counters) {
    description.counters.push_back({counter.group, counter.name});
  }
  return description;
}

}  // namespace

LiveCounters& LiveCounters::add(const std::string& group, const std::string& name, std::function<std::uint64_t()> value) {
  counters_.push_back({group, name, std::move(value)});
  return *this;
}

LiveCounters& LiveCounters::loop(const LoopResult& result) {
  return add("loop", "overruns", [&result] { return result.account.overruns(); })
      .add("loop", "cycles left out", reading(result.skipped))
      .add("loop", "cycles with the last command", reading(result.held_commands))
      .add("loop", "readings not sent", reading(result.lost_readings))
      .add("loop", "missed syncs", reading(result.missed_syncs));
}

LiveCounters& LiveCounters::recorder(const Recorder& recorder) {
  return add("recording", "cycles", [&recorder] { return recorder.offered(); })
      .add("recording", "dropped", [&recorder] { return recorder.dropped(); })
      .add("recording", "waiting for the disk", [&recorder] { return std::uint64_t{recorder.waiting()}; })
      .add("recording", "room", [&recorder] { return std::uint64_t{recorder.room()}; });
}

LiveCounters& LiveCounters::can_state(std::function<std::uint64_t()> value) {
  std::string name = "state";
  for (std::size_t i = 0; i < hal::kCanStates.size(); ++i) {
    name.append(i == 0 ? ": " : ", ").append(std::to_string(i)).append(" ").append(hal::kCanStates[i]);
  }
  return add("bus", name, std::move(value));
}

LiveCounters& LiveCounters::can_frames(const hal::CanCounters& counters) {
  return add("bus", "received", reading(counters.received))
      .add("bus", "superseded", reading(counters.superseded))
      .add("bus", "foreign", reading(counters.foreign))
      .add("bus", "of another sender", reading(counters.impostors))
      .add("bus", "dropped", reading(counters.dropped))
      .add("bus", "error frames", reading(counters.error_frames))
      .add("bus", "sent", reading(counters.sent))
      .add("bus", "confirmed", reading(counters.confirmed))
      .add("bus", "not sent, last one pending", reading(counters.pending))
      .add("bus", "not sent, queue full", reading(counters.queue_full))
      .add("bus", "not sent, bus unusable", reading(counters.unusable));
}

LiveCounters& LiveCounters::message(const std::string& name, const can::MessageCounters& counters) {
  return add(name, "taken", reading(counters.taken))
      .add(name, "damaged or lost", [&counters] { return counters.damaged(); })
      .add(name, "of two senders", [&counters] { return counters.of_two_senders(); })
      .add(name, "not authentic", reading(counters.unauthentic));
}

std::optional<hal::Failure> LiveSession::start(const RecordedPlant& plant, LiveCounters counters, const LoopResult& result,
                                               CycleOutputs& outputs) {
  if (options_.live_view.empty()) {
    return std::nullopt;
  }
  counters.loop(result);
  if (outputs.recorder != nullptr) {
    counters.recorder(*outputs.recorder);
  }
  const hal::LiveDescription description = describe(options_, plant, counters.all());
  auto failure = file_.create(hal::description_text(description), description.slot_words(),
                              static_cast<std::size_t>(kKeptNs / options_.loop.period_ns));
  if (!failure) {
    outputs.view = &view_.emplace(file_.writer(), counters.all());
  }
  return failure;
}

void LiveSession::close(Ending ending) noexcept {
  if (view_) {
    view_->end(number_of(ending));
  }
}

}  // namespace hotfire::firmware
