#include <memory>

#include "firmware/image/image_entries.hpp"
#include "firmware/lab/lab_image.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "firmware/lab/lab_rig.hpp"
#include "firmware/session/can_session.hpp"
#include "firmware/session/run_loop.hpp"
#include "hal/linux/gpiod_lines.hpp"
#include "hal/linux/posix_clock.hpp"

namespace hotfire::firmware {
namespace {

using Clock = hal::PosixClock;
using Rig = LabRig<hal::SocketCan, hal::GpiodLines, Clock>;

constexpr std::array<std::string_view, 1> kChannels{"command"};
constexpr std::array<std::string_view, 1> kUnits{"rad"};

/// In the order of LabInput and LabOutput. A broken wire of an input reads off, which is a stop, no enable, and no arming.
hal::GpioSettings gpio_settings(const Options& options, const LabLines& lines) {
  hal::GpioSettings settings;
  settings.chip = options.gpio;
  settings.bias = hal::GpioBias::pull_down;
  settings.inputs = {{lines.emergency_stop}, {lines.hydraulic_enable}, {lines.arm}};
  settings.outputs = {{lines.supply}, {lines.heartbeat}, {lines.fault}};
  return settings;
}

RecordedPlant recorded(const Lab& lab, const std::string& image) {
  RecordedPlant plant;
  plant.topology = kLabTopology;
  plant.input = {"command", "rad"};
  plant.channels.assign(kLabChannels.begin(), kLabChannels.end());
  plant.start.assign(lab.actuators() * kLabChannels.size(), 0.0);
  plant.image = image;
  return plant;
}

LabAccount account_of(const Lab& lab) {
  LabAccount account{lab.outputs().interlock.state, lab.completed(), lab.armings(), {}, lab.outputs().interlock.first};
  for (const FaultText& text : kFaults) {
    account.times_first[static_cast<std::size_t>(text.fault) - 1] = lab.times_first(text.fault);
  }
  return account;
}

BusAccount account_of(const CanSession& can_session, const Rig& rig, can::Layout layout, std::size_t messages) {
  BusAccount account = can_session.account();
  for (std::size_t i = 0; i < messages; ++i) {
    account.messages.push_back({can::reading_message(layout, i).name, rig.readings(i)});
  }
  account.unsayable = rig.unsayable();
  return account;
}

}  // namespace

int run_lab(const Options& given) {
  const double period = static_cast<double>(given.loop.period_ns) * 1e-9;
  const ReadText file = read_image_text(given.image);
  LabImage image = file.error.empty() ? parse_lab_image(file.text, given.image, period) : LabImage{{}, {}, file.error, {}};
  if (!image.settings) {
    std::fprintf(stderr, "hotfire-rt: %s\n", image.error.c_str());
    return kBadData;
  }
  Options options = given;
  options.actuators = image.settings->actuators;
  const can::Layout layout = options.frame_layout();
  Lab lab(std::move(*image.settings), period);
  if (options.actuators > can::most_actuators(layout)) {
    complain({text("--layout %s has no room for the %zu actuators of the profile",
                   can::kLayouts[static_cast<std::size_t>(layout)].data(), options.actuators),
              "--layout fd, or fd-split"});
    return kWrongUse;
  }
  CanSession can_session(options, can::controller_ids(layout, options.actuators));
  if (const int status = can_session.open(); status != kGood) {
    return status;
  }
  hal::GpiodLines gpio(gpio_settings(options, image.lines));
  if (const auto refused = gpio.open()) {
    complain(*refused);
    return kHardware;
  }
  Clock clock;
  Rig rig(lab, can_session.socket(), gpio, clock, layout, options.loop.period_ns);
  if (can::Authentication* const authentication = can_session.authentication()) {
    rig.authenticate(*authentication);
  }
  std::unique_ptr<RecordingSession> recording;
  std::unique_ptr<LabRecorder<Rig>> recorder;
  if (!options.recording.empty()) {
    recording = std::make_unique<RecordingSession>(options, recorded(lab, image.text));
    if (const auto failure = recording->start()) {
      complain(*failure);
      return kWrongUse;
    }
    recorder = std::make_unique<LabRecorder<Rig>>(recording->recorder(), rig);
    rig.watch(&recording->recorder());
  }
  rig.ask_to_stop_when(stop_asked);
  const auto loop = std::make_unique<Loop<Rig, Rig, Clock, OwnPace<Clock>, LabRecorder<Rig>>>(
      rig, rig, clock, options.loop, OwnPace<Clock>(clock, options.loop.period_ns), recorder.get());
  Session session{options, loop->result(), kLabTopology, kChannels, kUnits};
  session.input = "readings";
  session.output = "commands";
  const auto complete = [&](Session& result) {
    can_session.leave();
    result.lab = account_of(lab);
    result.bus = account_of(can_session, rig, layout, can::reading_messages(layout, options.actuators));
  };
  return run_loop(*loop, session, recording.get(), complete, rig.ended());
}

}  // namespace hotfire::firmware
