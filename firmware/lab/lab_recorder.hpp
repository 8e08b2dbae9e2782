// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/lab/lab.hpp"
#include "firmware/recording/recorder.hpp"
#include "hal/recording/format.hpp"
#include "hal/recording/reader.hpp"

namespace hotfire::firmware {

/// The channels that a recording has for each actuator of a lab. `piston` is the position at the end of the cycle, as in the
/// recording of a plant. The other channels are of the cycle itself. They are the current for the servovalve, which was sent
/// if anything was driven, and the inputs of the decision: the two readings and the age of each. A lab that measures load
/// pressures has three more: `load_pressure` at the end of the cycle, then the value of the decision and its age.
enum LabChannel : std::uint8_t {
  kPiston,
  kServovalveCurrent,
  kPistonA,
  kPistonB,
  kPistonAgeA,
  kPistonAgeB,
  kLoadPressure,
  kLoadPressureRead,
  kLoadPressureAge
};
inline const std::array<hal::RecordedChannel, 6> kLabChannels{{{"piston", "m"},
                                                               {"servovalve_current", "A"},
                                                               {"piston_a", "m"},
                                                               {"piston_b", "m"},
                                                               {"piston_age_a", "s"},
                                                               {"piston_age_b", "s"}}};
inline const std::array<hal::RecordedChannel, 3> kLoadPressureChannels{
    {{"load_pressure", "Pa"}, {"load_pressure_read", "Pa"}, {"load_pressure_age", "s"}}};
inline constexpr std::size_t kMostLabChannels = kLoadPressureAge + 1;
static_assert(kMostLabChannels <= hal::kMostRecordedChannels);

constexpr std::size_t lab_channel_count(bool has_load_pressure) noexcept {
  return has_load_pressure ? kMostLabChannels : std::size_t{kLoadPressure};
}

inline std::vector<hal::RecordedChannel> lab_channels(bool has_load_pressure) {
  std::vector<hal::RecordedChannel> channels(kLabChannels.begin(), kLabChannels.end());
  if (has_load_pressure) {
    channels.insert(channels.end(), kLoadPressureChannels.begin(), kLoadPressureChannels.end());
  }
  return channels;
}

/// Boolean inputs of a lab, from bit `kInputsShift` of the flags of a cycle on, in this order.
inline constexpr auto kSeenBits = std::to_array<bool ObservedRig::*>(
    {&ObservedRig::bad_frame, &ObservedRig::transmit_queue_full, &ObservedRig::overrun, &ObservedRig::dropped_recording,
     &ObservedRig::emergency_stop, &ObservedRig::hydraulic_enable, &ObservedRig::bus_off, &ObservedRig::bus_down,
     &ObservedRig::take_back_refused, &ObservedRig::supply_reads_other, &ObservedRig::fault_line_reads_other});
inline constexpr auto kSwitchBits = std::to_array<bool LabInputs::*>(
    {&LabInputs::arm, &LabInputs::arm_changed, &LabInputs::start, &LabInputs::start_changed, &LabInputs::stop});
/// Further inputs from the bus, from bit `kBusShift` of the flags on.
inline constexpr std::array<bool ObservedRig::*, 3> kBusBits{&ObservedRig::second_sender, &ObservedRig::command_not_answered,
                                                             &ObservedRig::not_authentic};
inline constexpr unsigned kBusShift = 40;
static_assert(hal::CycleHead::kInputsShift + kSeenBits.size() + kSwitchBits.size() <= kBusShift);
static_assert(kBusShift + kBusBits.size() <= hal::CycleHead::kSkippedShift);

/// All inputs of `Lab::step` in a cycle, from its recording bit for bit.
inline LabInputs recorded_inputs(const hal::RecordedCycle& cycle) noexcept {
  LabInputs inputs;
  std::uint64_t bits = cycle.head.flags >> hal::CycleHead::kInputsShift;
  const auto next = [&bits] {
    const bool on = (bits & 1U) != 0;
    bits >>= 1U;
    return on;
  };
  for (bool ObservedRig::*seen : kSeenBits) {
    inputs.rig.*seen = next();
  }
  for (bool LabInputs::*pressed : kSwitchBits) {
    inputs.*pressed = next();
  }
  bits = cycle.head.flags >> kBusShift;
  for (bool ObservedRig::*seen : kBusBits) {
    inputs.rig.*seen = next();
  }
  inputs.rig.command_age_ns = static_cast<std::int64_t>(cycle.head.command_sequence);
  const auto age_ns = [](double age) { return std::llround(age * 1e9); };
  const std::size_t channels = cycle.readings.size() / cycle.commands.size();
  for (std::size_t i = 0; i < cycle.commands.size(); ++i) {
    const std::span<const double> own = cycle.readings.subspan(i * channels, channels);
    inputs.readings[i] = {own[kPistonA], own[kPistonB]};
    inputs.ages_ns[i] = {age_ns(own[kPistonAgeA]), age_ns(own[kPistonAgeB])};
    if (channels == kMostLabChannels) {
      inputs.load_pressures[i] = own[kLoadPressureRead];
      inputs.load_pressure_ages_ns[i] = age_ns(own[kLoadPressureAge]);
    }
  }
  return inputs;
}

/// Records the inputs and outputs of a lab, so that a replay can decide every cycle again. `Rig` is a `LabRig`, `Outputs`
/// takes the cycles.
template <class Rig, class Outputs = Recorder>
class LabRecorder {
 public:
  LabRecorder(Outputs& recorder, const Rig& rig) noexcept
      : recorder_(recorder), rig_(rig), channels_(lab_channel_count(rig.lab().limits().has_load_pressure())) {}

  /// Keeps the cycle, and passes on the previous cycle, whose end is now known.
  void record(const hal::CycleHead& head, std::span<const double>, std::span<const double> commands) noexcept {
    finish();
    const std::size_t actuators = commands.size();
    begun_ = true;
    head_ = head;
    head_.flags |= state_bits() | input_bits();
    head_.command_sequence = static_cast<std::uint64_t>(rig_.inputs().rig.command_age_ns);
    std::copy(commands.begin(), commands.end(), commands_.begin());
    for (std::size_t i = 0; i < actuators; ++i) {
      const std::span<double> own = own_of(i);
      own[kServovalveCurrent] = rig_.lab().outputs().currents[i];
      own[kPistonA] = rig_.inputs().readings[i][0];
      own[kPistonB] = rig_.inputs().readings[i][1];
      own[kPistonAgeA] = static_cast<double>(rig_.inputs().ages_ns[i][0]) * 1e-9;
      own[kPistonAgeB] = static_cast<double>(rig_.inputs().ages_ns[i][1]) * 1e-9;
      if (has_load_pressure()) {
        own[kLoadPressureRead] = rig_.inputs().load_pressures[i];
        own[kLoadPressureAge] = static_cast<double>(rig_.inputs().load_pressure_ages_ns[i]) * 1e-9;
      }
    }
  }

  /// Passes on the last cycle, with the present positions of the pistons and the load pressures. At the end of the loop no
  /// later cycle gives its end, so these are its own readings.
  void finish() noexcept {
    if (!begun_) {
      return;
    }
    begun_ = false;
    const std::size_t actuators = rig_.lab().actuators();
    for (std::size_t i = 0; i < actuators; ++i) {
      own_of(i)[kPiston] = rig_.lab().positions()[i];
      if (has_load_pressure()) {
        own_of(i)[kLoadPressure] = rig_.inputs().load_pressures[i];
      }
    }
    recorder_.record(head_, std::span(commands_).first(actuators), std::span(readings_).first(actuators * channels_));
  }

 private:
  bool has_load_pressure() const noexcept { return channels_ == kMostLabChannels; }
  /// What is kept of an actuator.
  std::span<double> own_of(std::size_t actuator) noexcept {
    return std::span(readings_).subspan(actuator * channels_, channels_);
  }

  std::uint64_t state_bits() const noexcept {
    const InterlockOutputs& interlock = rig_.lab().outputs().interlock;
    return hal::CycleHead::lab_flags(static_cast<std::uint64_t>(interlock.state),
                                     static_cast<std::uint64_t>(interlock.first));
  }

  std::uint64_t input_bits() const noexcept {
    std::uint64_t bits = 0;
    unsigned place = hal::CycleHead::kInputsShift;
    for (bool ObservedRig::*seen : kSeenBits) {
      bits |= (rig_.inputs().rig.*seen ? std::uint64_t{1} : 0) << place++;
    }
    for (bool LabInputs::*pressed : kSwitchBits) {
      bits |= (rig_.inputs().*pressed ? std::uint64_t{1} : 0) << place++;
    }
    place = kBusShift;
    for (bool ObservedRig::*seen : kBusBits) {
      bits |= (rig_.inputs().rig.*seen ? std::uint64_t{1} : 0) << place++;
    }
    return bits;
  }

  Outputs& recorder_;
  const Rig& rig_;
  std::size_t channels_;  ///< of an actuator
  bool begun_ = false;
  hal::CycleHead head_;
  PerActuator commands_{};
  std::array<double, hal::kMaxActuators * kMostLabChannels> readings_{};
};

}  // namespace hotfire::firmware
