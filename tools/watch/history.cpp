// SPDX-License-Identifier: Apache-2.0
#include "tools/watch/history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hotfire::watch {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kLoopChannels = 2;
constexpr auto kRowNs = static_cast<std::int64_t>(History::kRowSeconds * 1e9);

}  // namespace

History::History(const hal::LiveDescription& description)
    : period_ns_(description.header.period_ns), channels_of_actuator_(1 + description.header.channels.size()) {
  const auto unit_of = [](const hal::RecordedChannel& channel) { return channel.unit == "1" ? "" : channel.unit; };
  for (unsigned actuator = 1; actuator <= description.header.actuators; ++actuator) {
    const std::string group = "actuator " + std::to_string(actuator);
    channels_.push_back({group, description.header.input.name, unit_of(description.header.input)});
    for (const hal::RecordedChannel& channel : description.header.channels) {
      channels_.push_back({group, channel.name, unit_of(channel)});
    }
  }
  channels_.push_back({"loop", "wake-up latency", "us"});
  channels_.push_back({"loop", "step time", "us"});
  times_.resize(kMostRows);
  values_.resize(kMostRows * channels_.size());
  filling_.assign(channels_.size(), {kNone, kNone, kNone});
  counters_.reserve(description.counters.size());
}

void History::put(std::size_t channel, double value) {
  const auto single = static_cast<float>(value);
  Span& span = filling_[channel];
  span.least = std::fmin(span.least, single);
  span.greatest = std::fmax(span.greatest, single);
  span.last = single;
}

void History::end_row() {
  if (filling_row_ < 0) {
    return;
  }
  times_[rows_ % kMostRows] = static_cast<double>(filling_row_) * kRowSeconds;
  std::copy(filling_.begin(), filling_.end(),
            values_.begin() + static_cast<std::ptrdiff_t>(rows_ % kMostRows * channels_.size()));
  ++rows_;
  filling_.assign(channels_.size(), {kNone, kNone, kNone});
  filling_row_ = -1;
}

void History::add(const LiveCycle& cycle) {
  const hal::CycleHead& head = cycle.head;
  if (!has_cycle_) {
    has_cycle_ = true;
    start_ns_ = head.release_ns - static_cast<std::int64_t>(head.cycle) * period_ns_;
  }
  const std::int64_t row = std::max<std::int64_t>(0, (head.release_ns - start_ns_) / kRowNs);
  if (row != filling_row_) {
    end_row();
    filling_row_ = row;
  }
  for (std::size_t actuator = 0; actuator < cycle.commands.size(); ++actuator) {
    const std::size_t first = actuator * channels_of_actuator_;
    put(first, cycle.commands[actuator]);
    for (std::size_t i = 0; i + 1 < channels_of_actuator_; ++i) {
      put(first + 1 + i, cycle.readings[actuator * (channels_of_actuator_ - 1) + i]);
    }
  }
  const std::int64_t latency_ns = head.woken_ns - head.release_ns;
  const std::int64_t step_ns = head.stepped_ns - head.read_ns;
  if ((head.flags & hal::CycleHead::kSlept) != 0) {
    wake_up_.add(latency_ns);
    put(channels_.size() - kLoopChannels, static_cast<double>(latency_ns) * 1e-3);
  }
  step_.add(step_ns);
  put(channels_.size() - 1, static_cast<double>(step_ns) * 1e-3);
  last_ = head;
  counters_.assign(cycle.counters.begin(), cycle.counters.end());
}

}  // namespace hotfire::watch
