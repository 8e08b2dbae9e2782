// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "firmware/can/controller_bus.hpp"
#include "firmware/plant/reference_controller.hpp"
#include "firmware/session/can_session.hpp"
#include "firmware/session/run_loop.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/linux/socket_can_listener.hpp"

namespace hotfire::firmware {
namespace {

/// For the loop, the readings are what it takes in and the commands what it measures.
RecordedPlant shown(const ControllerOptions& options) {
  RecordedPlant plant;
  plant.topology = ReferenceController::topology;
  plant.input = {"piston", "m"};
  plant.channels = {{std::string(ReferenceController::channels[0]), std::string(ReferenceController::channel_units[0])}};
  plant.start.assign(options.actuators, 0.0);
  return plant;
}

}  // namespace

int run(const ControllerOptions& options) {
  stop_on_signals();
  using Clock = hal::PosixClock;
  using Bus = can::ControllerBus<hal::SocketCan, Clock>;
  const can::Layout layout = frame_layout(options);
  CanSession can_session(options, can::controller_ids(layout, options.actuators));
  if (const int status = can_session.open(); status != kGood) {
    return status;
  }
  Clock clock;
  Bus bus(can_session.socket(), clock,
          {layout, options.actuators, options.command_per_current, options.loop.period_ns, can_session.authentication()});
  ReferenceController controller(options.source, static_cast<double>(options.loop.period_ns) * 1e-9, options.actuators);
  const auto complete = [&](Session& result) {
    BusAccount account = can_session.account();
    for (std::size_t i = 0; i < can::reading_messages(layout, options.actuators); ++i) {
      account.messages.push_back({can::reading_message(layout, i).name, bus.readings(i)});
    }
    account.unsayable = bus.unsayable();
    account.lost_syncs = bus.lost_syncs();
    result.bus = account;
  };
  LiveCounters counters;
  counters.can(can_session.socket()).add("bus", "SYNC frames not sent", [&bus] { return bus.lost_syncs(); });
  for (std::size_t i = 0; i < can::reading_messages(layout, options.actuators); ++i) {
    counters.message(std::string(can::reading_message(layout, i).name), bus.readings(i));
  }
  const auto run_at = [&]<class Pace>(Pace pace) {
    CycleOutputs outputs;
    const auto loop = std::make_unique<Loop<ReferenceController, Bus, Clock, Pace, CycleOutputs>>(
        controller, bus, clock, options.loop, pace, &outputs);
    LiveSession live(options);
    if (const auto failure = live.start(shown(options), counters, loop->result(), outputs)) {
      complain(*failure);
      return int{kWrongUse};
    }
    Session session{options, loop->result(), ReferenceController::topology, ReferenceController::channels,
                    ReferenceController::channel_units};
    session.input = "readings";
    session.output = "commands";
    session.max_lost = options.max_lost;
    RunEnd end = end_with(nullptr, live, complete);
    end.make_safe = [&] {
      if (!can_session.leave()) {
        complain(can_session.not_left());
      }
    };
    return run_loop(*loop, session, end);
  };
  if (!options.lockstep) {
    return run_at(OwnPace<Clock>(clock, options.loop.period_ns));
  }
  const can::Message& answer = can::reading_message(layout, can::reading_messages(layout, options.actuators) - 1);
  hal::SocketCanListener answers(options.bus, {can::id_of(answer), answer.fd});
  if (const auto refused = answers.open()) {
    complain(*refused);
    return kHardware;
  }
  return run_at(LockstepPace<Clock, hal::SocketCanListener>(clock, answers, options.loop.period_ns));
}

}  // namespace hotfire::firmware
