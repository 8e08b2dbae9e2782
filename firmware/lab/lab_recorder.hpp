#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/lab/lab.hpp"
#include "firmware/recording/recorder.hpp"
#include "hal/recording/format.hpp"

namespace hotfire::firmware {

/// What a recording keeps of each actuator of a lab. `piston` is where it was at the end of the cycle, as in the recording
/// of a plant; the others are of the cycle itself: the current for its servovalve, sent if anything was driven, then what
/// the cycle was decided on: the two readings as they had come, and the age of each.
enum LabChannel : std::uint8_t { kPiston, kServovalveCurrent, kPistonA, kPistonB, kPistonAgeA, kPistonAgeB };
inline const std::array<hal::RecordedChannel, 6> kLabChannels{{{"piston", "m"},
                                                               {"servovalve_current", "A"},
                                                               {"piston_a", "m"},
                                                               {"piston_b", "m"},
                                                               {"piston_age_a", "s"},
                                                               {"piston_age_b", "s"}}};

/// What a lab has seen that is a yes or no, from bit `kInputsShift` of the flags of a cycle on, in this order.
inline constexpr auto kSeenBits = std::to_array<bool ObservedRig::*>(
    {&ObservedRig::bad_frame, &ObservedRig::transmit_queue_full, &ObservedRig::overrun, &ObservedRig::dropped_recording,
     &ObservedRig::emergency_stop, &ObservedRig::hydraulic_enable, &ObservedRig::bus_off, &ObservedRig::bus_down,
     &ObservedRig::take_back_refused, &ObservedRig::supply_reads_other, &ObservedRig::fault_line_reads_other});
inline constexpr auto kSwitchBits = std::to_array<bool LabInputs::*>(
    {&LabInputs::arm, &LabInputs::arm_changed, &LabInputs::start, &LabInputs::start_changed, &LabInputs::stop});
/// What it has seen of the bus beside those, from bit `kBusShift` of the flags on.
inline constexpr std::array<bool ObservedRig::*, 3> kBusBits{&ObservedRig::second_sender, &ObservedRig::command_not_answered,
                                                             &ObservedRig::not_authentic};
inline constexpr unsigned kBusShift = 40;
static_assert(hal::CycleHead::kInputsShift + kSeenBits.size() + kSwitchBits.size() <= kBusShift);
static_assert(kBusShift + kBusBits.size() <= hal::CycleHead::kSkippedShift);

/// Everything `Lab::step` is given in a cycle, taken out of its recording bit for bit.
inline LabInputs recorded_inputs(const hal::CycleHead& head, std::span<const double> readings) noexcept {
  LabInputs inputs;
  std::uint64_t bits = head.flags >> hal::CycleHead::kInputsShift;
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
  bits = head.flags >> kBusShift;
  for (bool ObservedRig::*seen : kBusBits) {
    inputs.rig.*seen = next();
  }
  inputs.rig.command_age_ns = static_cast<std::int64_t>(head.command_sequence);
  for (std::size_t i = 0; i < readings.size() / kLabChannels.size(); ++i) {
    const std::span<const double> own = readings.subspan(i * kLabChannels.size(), kLabChannels.size());
    inputs.readings[i] = {own[kPistonA], own[kPistonB]};
    inputs.ages_ns[i] = {std::llround(own[kPistonAgeA] * 1e9), std::llround(own[kPistonAgeB] * 1e9)};
  }
  return inputs;
}

/// Records a lab: what it saw and what it did, so that a replay can decide every cycle anew. `Rig` is a `LabRig`.
template <class Rig>
class LabRecorder {
 public:
  LabRecorder(Recorder& recorder, const Rig& rig) noexcept : recorder_(recorder), rig_(rig) {}

  /// Keeps the cycle, and hands on the one before it, whose end this one has seen.
  void record(const hal::CycleHead& head, std::span<const double>, std::span<const double> commands) noexcept {
    finish();
    const std::size_t actuators = commands.size();
    const std::span<double> readings = std::span(readings_).first(actuators * kLabChannels.size());
    begun_ = true;
    head_ = head;
    head_.flags |= state_bits() | input_bits();
    head_.command_sequence = static_cast<std::uint64_t>(rig_.inputs().rig.command_age_ns);
    std::copy(commands.begin(), commands.end(), commands_.begin());
    for (std::size_t i = 0; i < actuators; ++i) {
      const std::span<double> own = readings.subspan(i * kLabChannels.size(), kLabChannels.size());
      own[kServovalveCurrent] = rig_.lab().outputs().currents[i];
      own[kPistonA] = rig_.inputs().readings[i][0];
      own[kPistonB] = rig_.inputs().readings[i][1];
      own[kPistonAgeA] = static_cast<double>(rig_.inputs().ages_ns[i][0]) * 1e-9;
      own[kPistonAgeB] = static_cast<double>(rig_.inputs().ages_ns[i][1]) * 1e-9;
    }
  }

  /// Hands on the cycle that is kept, with where the pistons are now: at the end of the loop, where none sees its end, that
  /// is what it had itself read.
  void finish() noexcept {
    if (!begun_) {
      return;
    }
    begun_ = false;
    const std::size_t actuators = rig_.lab().actuators();
    for (std::size_t i = 0; i < actuators; ++i) {
      readings_[i * kLabChannels.size() + kPiston] = rig_.lab().positions()[i];
    }
    recorder_.record(head_, std::span(commands_).first(actuators),
                     std::span(readings_).first(actuators * kLabChannels.size()));
  }

 private:
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

  Recorder& recorder_;
  const Rig& rig_;
  bool begun_ = false;
  hal::CycleHead head_;
  PerActuator commands_{};
  std::array<double, hal::kMaxActuators * kLabChannels.size()> readings_{};
};

}  // namespace hotfire::firmware
