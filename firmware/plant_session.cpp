#include <memory>

#include "firmware/can/plant_bus.hpp"
#include "firmware/can/sync_source.hpp"
#include "firmware/can_session.hpp"
#include "firmware/plant.hpp"
#include "firmware/plant_image.hpp"
#include "firmware/reference_plant.hpp"
#include "firmware/run_loop.hpp"
#include "hal/denormals.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/linux/socket_can_listener.hpp"
#include "hal/sim/plant_bus.hpp"
#include "hal/sim/sync_source.hpp"

namespace hotfire::firmware {
namespace {

using Clock = hal::PosixClock;
using Complete = std::function<void(Session&)>;
using CanPlantBus = can::PlantBus<hal::SocketCan, Clock>;

/// A plant between its bus and its recording.
template <class Model>
class PlantSession {
 public:
  PlantSession(const Options& options, const typename Model::Parameters& parameters, const PlantImage& image)
      : options_(options),
        image_(image),
        period_(static_cast<double>(options.loop.period_ns) * 1e-9),
        steps_(model::steps_per_period(period_)),
        plant_(std::make_unique<Plant<Model>>(parameters, period_, options.actuators, image.faults)) {}

  int run_without_wire() {
    hal::sim::SimulatedPlantBus wire(options_.source, period_);
    return run_paced(wire, [](Session&) {});
  }

  int run_on_can() {
    CanSession session(options_, can::plant_ids(options_.frame_layout(), options_.actuators, options_.strings));
    if (const int status = session.open(); status != kGood) {
      return status;
    }
    if (options_.strings) {
      plant_->string_up();
    }
    CanPlantBus wire(session.socket(), clock_,
                     {options_.frame_layout(), options_.actuators, Model::channels.size(), options_.command_per_current,
                      options_.loop.period_ns, static_cast<std::int64_t>(options_.command_age_ms * 1e6)});
    const Complete complete = [&](Session& result) {
      BusAccount account = session.account();
      account.messages = {
          {can::command_message(options_.frame_layout()).name, wire.commands(), session.socket().mailbox(0).superseded}};
      account.stale_cycles = wire.stale_cycles();
      account.too_old = wire.too_old();
      account.unsayable = wire.unsayable();
      result.bus = account;
    };
    if (options_.pace != PaceKind::can) {
      return run_paced(wire, complete);
    }
    hal::SocketCanListener frames(options_.bus, {can::id_of(can::sync::kMessage)});
    if (const auto refused = frames.open()) {
      complain(*refused);
      return kHardware;
    }
    can::CanSyncSource syncs(frames);
    return run_locked(wire, syncs, complete);
  }

 private:
  template <class Wire>
  int run_paced(Wire& wire, const Complete& complete) {
    if (options_.pace == PaceKind::clock) {
      return run(wire, OwnPace<Clock>(clock_, options_.loop.period_ns), complete);
    }
    hal::sim::SimulatedSyncSource<Clock> syncs(clock_, options_.loop.period_ns);
    return run_locked(wire, syncs, complete);
  }

  template <class Wire, class Syncs>
  int run_locked(Wire& wire, Syncs& syncs, const Complete& complete) {
    return run(wire,
               SyncPace<Clock, Syncs>(clock_, syncs, options_.loop.period_ns, options_.most_missed_syncs, patience_ns()),
               complete);
  }

  template <class Wire, class Pace>
  int run(Wire& wire, Pace pace, const Complete& complete) {
    using Bus = PlayedBus<Wire>;
    Bus bus(wire, image_.faults, period_);
    std::unique_ptr<RecordingSession> recording;
    if (!options_.recording.empty()) {
      recording = std::make_unique<RecordingSession>(options_, RecordedPlant::of<Model>(*plant_, steps_, image_.text));
      if (const auto failure = recording->start()) {
        complain(*failure);
        return kWrongUse;
      }
    }
    const auto loop = std::make_unique<Loop<Plant<Model>, Bus, Clock, Pace, Recorder>>(
        *plant_, bus, clock_, options_.loop, pace, recording ? &recording->recorder() : nullptr);
    Session session{options_, loop->result(), Model::topology, Model::channels, Model::channel_units, steps_};
    return run_loop(*loop, session, recording.get(), complete);
  }

  std::int64_t patience_ns() const {
    return options_.sync_patience_ms ? static_cast<std::int64_t>(*options_.sync_patience_ms * 1e6)
                                     : options_.loop.period_ns / 2;
  }

  const Options& options_;
  const PlantImage& image_;
  double period_;
  int steps_;
  hal::FlushDenormals flush_;
  Clock clock_;
  std::unique_ptr<Plant<Model>> plant_;
};

int run_simplex(const Options& options, const model::Simplex<double>::Parameters& parameters, const PlantImage& image) {
  PlantSession<model::Simplex<double>> session(options, parameters, image);
  return options.on_can() ? session.run_on_can() : session.run_without_wire();
}

}  // namespace

int run_plant(const Options& options) {
  if (options.image.empty()) {
    return run_simplex(options, reference_plant_with_every_effect(), {});
  }
  const PlantImage image = read_plant_image(options.image);
  if (!image.parameters) {
    std::fprintf(stderr, "hotfire-rt: %s\n", image.error.c_str());
    return kBadData;
  }
  if (const auto* simplex = std::get_if<model::Simplex<double>::Parameters>(&*image.parameters)) {
    return run_simplex(options, *simplex, image);
  }
  if (options.on_can()) {
    complain({"a model of topology direct has no servovalve that a CAN bus could command",
              "a model of topology simplex, or --bus sim"});
    return kWrongUse;
  }
  const auto& parameters = std::get<model::Direct<double>::Parameters>(*image.parameters);
  return PlantSession<model::Direct<double>>(options, parameters, image).run_without_wire();
}

}  // namespace hotfire::firmware
