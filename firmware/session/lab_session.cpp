// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "firmware/image/image_entries.hpp"
#include "firmware/lab/lab_end.hpp"
#include "firmware/lab/lab_image.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "firmware/lab/lab_rig.hpp"
#include "firmware/session/can_session.hpp"
#include "firmware/session/run_loop.hpp"
#include "firmware/text/text.hpp"
#include "hal/linux/can_bit_rates.hpp"
#include "hal/linux/gpiod_lines.hpp"
#include "hal/linux/posix_clock.hpp"

namespace hotfire::firmware {
namespace {

using Clock = hal::PosixClock;
using Rig = LabRig<hal::SocketCan, hal::GpiodLines, Clock>;

constexpr std::array<std::string_view, 1> kChannels{"command"};
constexpr std::array<std::string_view, 1> kUnits{"rad"};

RecordedPlant recorded(const Lab& lab, const std::string& image) {
  RecordedPlant plant;
  plant.topology = kLabTopology;
  plant.input = {"command", "rad"};
  plant.channels = lab_channels(lab.limits().has_load_pressure());
  plant.start.assign(lab.actuators() * plant.channels.size(), 0.0);
  plant.image = image;
  return plant;
}

LabAccount account_of(const Lab& lab, const LabEnd& end) {
  const InterlockOutputs& interlock = lab.outputs().interlock;
  LabAccount account{interlock.state, lab.completed(),  lab.armings(),     {},
                     interlock.first, end.left_the_bus, end.lines_dropped, lab.came_to_rest()};
  for (const FaultText& text : kFaults) {
    account.times_first[static_cast<std::size_t>(text.fault)] = lab.times_first(text.fault);
  }
  return account;
}

/// A lab on a real bus moves real actuators: it is run with the profile that a person has looked at, or not at all.
std::optional<hal::Failure> refuse_unconfirmed(const LabOptions& options, const std::string& image) {
  const std::string digest = text("%016llx", static_cast<unsigned long long>(hal::model_hash(image)));
  if (options.rehearsal || options.confirm == digest) {
    return std::nullopt;
  }
  return hal::Failure{"the digest of the profile is " + digest + "; --confirm has " + options.confirm,
                      "read the profile, and confirm the digest that 'hotfire check' prints of it"};
}

/// A watchdog on the heartbeat trips kWindowCycles after its last edge (docs/heartbeat.md): the program must find a command
/// that is too old before that, and name the fault.
std::optional<hal::Failure> refuse_slow_limit(const LabOptions& options, const FaultLimits& limits) {
  constexpr std::int64_t kWindowCycles = 5;
  const std::int64_t longest_ns = (kWindowCycles - 1) * options.loop.period_ns;
  if (options.rehearsal || limits.command_age_ns <= longest_ns) {
    return std::nullopt;
  }
  return hal::Failure{
      text("limits.command_age = %g s is longer than 4 periods, %g s: a watchdog of the heartbeat would trip "
           "before the program finds the fault",
           static_cast<double>(limits.command_age_ns) * 1e-9, static_cast<double>(longest_ns) * 1e-9),
      "a shorter command_age in the profile, or a longer --period-us; see docs/heartbeat.md"};
}

std::optional<hal::Failure> refuse_rehearsal(const LabOptions& options) {
  if (options.rehearsal && !hal::is_virtual_can(options.bus)) {
    return hal::Failure{"--rehearsal: " + options.bus + " is not a virtual CAN interface",
                        "a vcan, or leave --rehearsal out: a rehearsal must not move real actuators"};
  }
  // A real line of a rehearsal would switch a real supply. A chip that is not there is refused later, with its remedy.
  if (options.rehearsal && !hal::is_simulated_gpio(options.gpio).value_or(true)) {
    return hal::Failure{"--rehearsal: " + options.gpio + " is not a simulated GPIO chip",
                        "a chip of gpio-sim, or leave --rehearsal out: a rehearsal must not switch a real supply"};
  }
  return std::nullopt;
}

BusAccount account_of(const CanSession& can_session, const Rig& rig) {
  BusAccount account = can_session.account();
  for (std::size_t i = 0; i < rig.messages(); ++i) {
    account.messages.push_back({rig.message(i).name, rig.readings(i)});
  }
  account.unsayable = rig.unsayable();
  return account;
}

LiveCounters counters_of(CanSession& can_session, const Rig& rig) {
  LiveCounters counters;
  counters.faults([&rig](Fault fault) { return rig.lab().times_first(fault); }).can(can_session.socket());
  for (std::size_t i = 0; i < rig.messages(); ++i) {
    counters.message(std::string(rig.message(i).name), rig.readings(i));
  }
  return counters;
}

}  // namespace

int run(const LabOptions& given) {
  // From here on a signal ends the program through the interlock and closes the recording.
  stop_on_signals();
  stop_instead_of_suspending();
  const double period = static_cast<double>(given.loop.period_ns) * 1e-9;
  const ReadText file = read_image_text(given.image);
  LabImage image = file.error.empty() ? parse_lab_image(file.text, given.image, period) : LabImage{{}, {}, file.error, {}};
  if (!image.settings) {
    std::fprintf(stderr, "hotfire-rt: %s\n", image.error.c_str());
    return kBadData;
  }
  if (const auto refused = refuse_unconfirmed(given, image.text)) {
    complain(*refused);
    return kWrongUse;
  }
  if (const auto refused = refuse_slow_limit(given, image.settings->limits)) {
    complain(*refused);
    return kWrongUse;
  }
  LabOptions options = given;
  options.actuators = image.settings->actuators;
  const bool has_load_pressure = image.settings->limits.has_load_pressure();
  options.require_realtime = given.require_realtime || !given.rehearsal;
  // The lab counts them itself, so that its interlock stops what is driven.
  const std::uint64_t cycles = std::exchange(options.loop.cycles, 0);
  options.loop.number_skipped = true;
  const can::Layout layout = frame_layout(options);
  Lab lab(std::move(*image.settings), period);
  if (options.actuators > can::most_actuators(layout)) {
    complain({text("--layout %s has no room for the %zu actuators of the profile",
                   can::kLayouts[static_cast<std::size_t>(layout)].data(), options.actuators),
              "--layout fd, or fd-split"});
    return kWrongUse;
  }
  CanSession can_session(options, can::controller_ids(layout, options.actuators, has_load_pressure),
                         {false, has_load_pressure});
  if (const int status = can_session.open(); status != kGood) {
    return status;
  }
  if (const auto refused = refuse_rehearsal(options)) {
    complain(*refused);
    return kWrongUse;
  }
  if (const auto refused = can_session.refuse_without_take_back()) {
    complain(*refused);
    return kHardware;
  }
  const LabGpio wiring = lab_gpio(image.lines, options.gpio);
  hal::GpiodLines gpio(wiring.settings);
  if (const auto refused = gpio.open()) {
    complain(*refused);
    return kHardware;
  }
  Clock clock;
  Rig rig(lab, can_session.socket(), gpio, wiring, clock, layout, options.loop.period_ns);
  if (can::Authentication* const authentication = can_session.authentication()) {
    rig.authenticate(*authentication);
  }
  std::unique_ptr<RecordingSession> recording;
  CycleOutputs outputs;
  std::unique_ptr<LabRecorder<Rig, CycleOutputs>> recorder;
  if (!options.recording.empty()) {
    recording = std::make_unique<RecordingSession>(options, recorded(lab, image.text));
    if (const auto failure = recording->start()) {
      complain(*failure);
      return kWrongUse;
    }
    outputs.recorder = &recording->recorder();
    rig.watch(outputs.recorder);
  }
  if (!options.recording.empty() || !options.live_view.empty()) {
    recorder = std::make_unique<LabRecorder<Rig, CycleOutputs>>(outputs, rig);
  }
  rig.ask_to_stop_when(stop_asked);
  rig.stop_after(cycles == 0 ? 0 : cycles + options.loop.warm_up_cycles);
  const auto loop = std::make_unique<Loop<Rig, Rig, Clock, OwnPace<Clock>, LabRecorder<Rig, CycleOutputs>>>(
      rig, rig, clock, options.loop, OwnPace<Clock>(clock, options.loop.period_ns), recorder.get());
  LiveSession live(options);
  if (const auto failure = live.start(recorded(lab, image.text), counters_of(can_session, rig), loop->result(), outputs)) {
    complain(*failure);
    return kWrongUse;
  }
  Session session{options, loop->result(), kLabTopology, kChannels, kUnits};
  session.input = "readings";
  session.output = "commands";
  session.recording_file = options.recording;
  session.max_dropped = options.max_dropped;
  session.max_lost = options.max_lost;
  LabEnd reached;
  RunEnd end = end_with(recording.get(), live, [&](Session& result) {
    result.lab = account_of(lab, reached);
    result.bus = account_of(can_session, rig);
  });
  end.make_safe = [&] {
    reached = make_lab_safe(
        rig, [&](bool may_wait) { return can_session.leave(may_wait); },
        [&] {
          if (recorder) {
            recorder->finish();
          }
        });
    if (!reached.lines_dropped) {
      complain({"the lines of " + options.gpio + " cannot be set to off", "take the supply away by hand"});
    }
    if (!reached.left_the_bus) {
      complain(can_session.not_left());
    }
  };
  return run_loop(*loop, session, end, rig.ended());
}

}  // namespace hotfire::firmware
