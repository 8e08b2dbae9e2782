// SPDX-License-Identifier: Apache-2.0
#include "tools/watch/watcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace hotfire::watch {
namespace {

using Json = nlohmann::ordered_json;
using State = LiveSource::State;

constexpr std::chrono::milliseconds kLookEvery{20};
/// A program that runs and shows no cycle for so long is silent.
constexpr std::chrono::milliseconds kSilent{500};

Json json_of(const DurationHistogram& histogram) {
  return {{"count", histogram.count()},
          {"median", histogram.quantile_ns(0.5) * 1e-3},
          {"p99", histogram.quantile_ns(0.99) * 1e-3},
          {"greatest", static_cast<double>(histogram.greatest_ns()) * 1e-3},
          {"counts", histogram.counts()}};
}

const hal::LiveWordMeaning* find(const std::vector<hal::LiveWordMeaning>& words, std::uint64_t number) {
  const auto found =
      std::find_if(words.begin(), words.end(), [number](const hal::LiveWordMeaning& word) { return word.number == number; });
  return found == words.end() ? nullptr : &*found;
}

/// What of the program never changes.
Json describe(const hal::LiveDescription& description, const std::vector<Channel>& channels) {
  const hal::RecordingHeader& header = description.header;
  Json result{{"topology", header.topology}, {"started", header.started},           {"host", header.host},
              {"version", header.version},   {"command_line", header.command_line}, {"period_us", header.period_ns / 1000}};
  for (const Channel& channel : channels) {
    result["channels"].push_back({{"group", channel.group}, {"name", channel.name}, {"unit", channel.unit}});
  }
  for (const hal::LiveWordMeaning& fault : description.faults) {
    result["faults"].push_back({{"number", fault.number}, {"name", fault.name}, {"meaning", fault.meaning}});
  }
  for (const hal::LiveCounterName& counter : description.counters) {
    result["counters"].push_back({{"group", counter.group}, {"name", counter.name}});
  }
  result["histogram"] = {{"least_us", DurationHistogram::kLeastNs * 1e-3},
                         {"bins_of_decade", DurationHistogram::kBinsOfDecade}};
  return result;
}

/// State of the interlock and the first fault since it was armed; null if the program has none.
Json interlock_of(const hal::LiveDescription& description, const hal::CycleHead& head) {
  const auto* const state = find(description.states, head.flags >> hal::CycleHead::kStateShift & 0xff);
  if (state == nullptr) {
    return nullptr;
  }
  const std::uint64_t fault = head.flags >> hal::CycleHead::kFaultShift & 0xff;
  return {{"state", state->name}, {"fault", fault == 0 ? Json(nullptr) : Json(fault)}};
}

void append(std::string& text, float value) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(text), ",{:.7g}", value);
  } else {
    text += ",null";
  }
}

/// [time, least, greatest, last, least, ...] for every row; three values for each channel that is asked for.
std::string rows_of(const History& history, std::uint64_t first, const std::vector<std::size_t>& channels) {
  std::string text;
  for (std::uint64_t row = first; row < history.rows(); ++row) {
    fmt::format_to(std::back_inserter(text), "{}[{:.2f}", text.empty() ? "" : ",", history.time(row));
    const std::span<const Span> values = history.values(row);
    for (const std::size_t channel : channels) {
      append(text, values[channel].least);
      append(text, values[channel].greatest);
      append(text, values[channel].last);
    }
    text += "]";
  }
  return text;
}

}  // namespace

Watcher::Watcher(const std::string& path)
    : path_(path),
      source_(path),
      started_(std::to_string(std::chrono::system_clock::now().time_since_epoch().count())),
      last_cycle_at_(Clock::now()) {
  take_cycles();
  thread_ = std::thread([this] { follow(); });
}

Watcher::~Watcher() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  stop_asked_.notify_one();
  thread_.join();
}

void Watcher::follow() {
  std::unique_lock lock(mutex_);
  while (!stop_asked_.wait_for(lock, kLookEvery, [this] { return stopping_; })) {
    take_cycles();
  }
}

void Watcher::take_cycles() {
  if (source_.refresh()) {
    history_ = History(source_.description());
    ++program_;
    last_cycle_at_ = Clock::now();
  }
  for (LiveCycle cycle; source_.next(cycle);) {
    history_.add(cycle);
    last_cycle_at_ = Clock::now();
  }
  if (source_.state() != State::running) {
    history_.end_row();
  }
}

std::string Watcher::answer(const Request& request) const {
  const std::lock_guard guard(mutex_);
  const std::string epoch = started_ + "-" + std::to_string(program_);
  const bool is_silent = source_.state() == State::running && Clock::now() - last_cycle_at_ > kSilent;
  constexpr std::array<const char*, 5> kStates{"absent", "refused", "running", "died", "ended"};
  Json result{{"epoch", epoch},
              {"file", path_},
              {"state", is_silent ? "silent" : kStates[static_cast<std::size_t>(source_.state())]},
              {"why", source_.why()}};
  if (program_ == 0) {
    return result.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  const bool is_known = request.epoch == epoch;
  if (!is_known) {
    result["program"] = describe(source_.description(), history_.channels());
  }
  if (history_.has_cycle()) {
    result["interlock"] = interlock_of(source_.description(), history_.last_head());
    result["cycle"] = history_.last_head().cycle;
    result["held"] = (history_.last_head().flags & hal::CycleHead::kHeld) != 0;
    result["counters"] = history_.counters();
    result["wake_up"] = json_of(history_.wake_up());
    result["step"] = json_of(history_.step());
    result["missed"] = source_.missed();
  }
  std::vector<std::size_t> channels;
  std::copy_if(request.channels.begin(), request.channels.end(), std::back_inserter(channels),
               [this](std::size_t channel) { return channel < history_.channels().size(); });
  result["sent"] = channels;
  result["next"] = history_.rows();
  const std::uint64_t first = std::max(is_known ? request.row : 0, history_.oldest_row());
  std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();
  return text + ",\"rows\":[" + rows_of(history_, first, channels) + "]}";
}

}  // namespace hotfire::watch
