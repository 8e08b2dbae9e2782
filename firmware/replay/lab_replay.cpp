// SPDX-License-Identifier: Apache-2.0
#include "firmware/replay/lab_replay.hpp"

#include <algorithm>
#include <memory>

#include "firmware/lab/lab_recorder.hpp"
#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

using Head = hal::CycleHead;

/// A lab that is given what a recorded one was given.
class ReplayedLab {
 public:
  ReplayedLab(LabSettings settings, const hal::RecordingHeader& header, double period)
      : header_(header), lab_(std::move(settings), period) {}

  /// What of a cycle is not as recorded; empty if all is.
  std::string step(const hal::RecordedCycle& cycle) {
    const LabOutputs& outputs = lab_.step(recorded_inputs(cycle));
    lab_.add_to(hash_);
    const std::size_t channels = header_.channels.size();
    std::string what = differing_state(cycle.head, outputs.interlock);
    for (std::size_t i = 0; i < lab_.actuators() && what.empty(); ++i) {
      const std::span<const double> own = cycle.readings.subspan(i * channels, channels);
      what = differing(header_.input, i, cycle.commands[i], outputs.commands[i]);
      what =
          what.empty() ? differing(kLabChannels[kServovalveCurrent], i, own[kServovalveCurrent], outputs.currents[i]) : what;
      what = what.empty() && begun_ ? differing(kLabChannels[kPiston], i, pistons_[i], lab_.positions()[i]) : what;
      pistons_[i] = own[kPiston];
      if (channels == kMostLabChannels) {
        const hal::RecordedChannel& pressure = header_.channels[kLoadPressure];
        what = what.empty() && begun_ ? differing(pressure, i, load_pressures_[i], own[kLoadPressureRead]) : what;
        load_pressures_[i] = own[kLoadPressure];
      }
    }
    begun_ = true;
    return what.empty() && hash_.value() != cycle.head.hash ? "the hash over commands and positions" : what;
  }

 private:
  static std::string differing_state(const Head& head, const InterlockOutputs& interlock) {
    const std::uint64_t replayed =
        Head::lab_flags(static_cast<std::uint64_t>(interlock.state), static_cast<std::uint64_t>(interlock.first));
    const std::uint64_t recorded = head.flags & Head::lab_flags(0xff, 0xff);
    if (recorded == replayed) {
      return {};
    }
    const auto state = [](std::uint64_t flags) { return static_cast<unsigned>((flags >> Head::kStateShift) & 0xff); };
    const auto fault = [](std::uint64_t flags) { return static_cast<unsigned>((flags >> Head::kFaultShift) & 0xff); };
    return text("state and first fault: recorded %u and %u, replayed %u and %u", state(recorded), fault(recorded),
                state(replayed), fault(replayed));
  }

  const hal::RecordingHeader& header_;
  Lab lab_;
  hal::Fnv1a hash_;
  PerActuator pistons_{};         ///< where they were at the end of the cycle before, as recorded
  PerActuator load_pressures_{};  ///< as the pistons
  bool begun_ = false;
};

bool is_of_this_version(const hal::RecordingHeader& header, const FaultLimits& limits) {
  const std::vector<hal::RecordedChannel> own = lab_channels(limits.has_load_pressure());
  return std::equal(
      header.channels.begin(), header.channels.end(), own.begin(), own.end(),
      [](const hal::RecordedChannel& one, const hal::RecordedChannel& other) { return one.name == other.name; });
}

}  // namespace

Replay replay_lab(hal::RecordingReader& reader) {
  const hal::RecordingHeader& header = reader.header();
  const double period = static_cast<double>(header.period_ns) * 1e-9;
  Replay result;
  LabImage image = parse_lab_image(header.model, "the profile in the header", period);
  if (!image.settings || image.settings->actuators != header.actuators ||
      !is_of_this_version(header, image.settings->limits)) {
    result.error = image.error.empty() ? "its channels are not those that this version of a lab records" : image.error;
    return result;
  }
  ReplayedLab lab(std::move(*image.settings), header, period);
  replay_cycles(reader, result, [&lab](const hal::RecordedCycle& cycle) { return lab.step(cycle); });
  return result;
}

}  // namespace hotfire::firmware
