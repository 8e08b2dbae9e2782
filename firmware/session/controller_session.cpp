// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "firmware/can/controller_bus.hpp"
#include "firmware/plant/reference_controller.hpp"
#include "firmware/session/can_session.hpp"
#include "firmware/session/run_loop.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/linux/socket_can_listener.hpp"

namespace hotfire::firmware {

int run_controller(const Options& options) {
  using Clock = hal::PosixClock;
  using Bus = can::ControllerBus<hal::SocketCan, Clock>;
  const can::Layout layout = options.frame_layout();
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
  const auto run = [&]<class Pace>(Pace pace) {
    const auto loop =
        std::make_unique<Loop<ReferenceController, Bus, Clock, Pace>>(controller, bus, clock, options.loop, pace, nullptr);
    Session session{options, loop->result(), ReferenceController::topology, ReferenceController::channels,
                    ReferenceController::channel_units};
    session.input = "readings";
    session.output = "commands";
    RunEnd end = end_with(nullptr, complete);
    end.make_safe = [&] { can_session.leave(); };
    return run_loop(*loop, session, end);
  };
  if (!options.lockstep) {
    return run(OwnPace<Clock>(clock, options.loop.period_ns));
  }
  const can::Message& answer = can::reading_message(layout, can::reading_messages(layout, options.actuators) - 1);
  hal::SocketCanListener answers(options.bus, {can::id_of(answer), answer.fd});
  if (const auto refused = answers.open()) {
    complain(*refused);
    return kHardware;
  }
  return run(LockstepPace<Clock, hal::SocketCanListener>(clock, answers, options.loop.period_ns));
}

}  // namespace hotfire::firmware
