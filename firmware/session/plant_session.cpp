// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "firmware/can/plant_bus.hpp"
#include "firmware/can/sync_source.hpp"
#include "firmware/image/image_plant.hpp"
#include "firmware/plant/reference_plant.hpp"
#include "firmware/session/can_session.hpp"
#include "firmware/session/run_loop.hpp"
#include "firmware/text/text.hpp"
#include "hal/arithmetic/denormals.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/linux/socket_can_listener.hpp"
#include "hal/sim/plant_bus.hpp"
#include "hal/sim/sync_source.hpp"

namespace hotfire::firmware {
namespace {

using Clock = hal::PosixClock;

/// What only the owner of a wire knows: for the report at the end, and for the live view.
struct WireAccount {
  std::function<void(Session&)> complete = [](Session&) {};
  LiveCounters counters{};
};
using CanPlantBus = can::PlantBus<hal::SocketCan, Clock>;

/// [s]
double period_of(const RunOptions& options) { return static_cast<double>(options.loop.period_ns) * 1e-9; }

/// Which value of an actuator its load pressure is; none if the plant has none.
template <class Plant>
constexpr std::optional<std::size_t> load_pressure_of() {
  const auto found = std::find(Plant::channels.begin(), Plant::channels.end(), "load_pressure");
  return found == Plant::channels.end() ? std::nullopt
                                        : std::optional(static_cast<std::size_t>(found - Plant::channels.begin()));
}

/// A plant between its bus and its recording.
template <class Plant>
class PlantSession {
 public:
  PlantSession(const PlantOptions& options, const PlantImage& image, std::unique_ptr<Plant> plant)
      : options_(options), image_(image), period_(period_of(options)), plant_(std::move(plant)) {}

  int run_without_wire() {
    hal::sim::SimulatedPlantBus wire(options_.source, period_);
    return run_paced(wire, {});
  }

  int run_on_can() {
    const can::MoreReadings more{options_.strings, options_.load_pressure};
    CanSession session(options_, can::plant_ids(frame_layout(options_), options_.actuators, more), more);
    if (const int status = session.open(); status != kGood) {
      return status;
    }
    if (options_.strings) {
      plant_->string_up();
    }
    CanPlantBus wire(session.socket(), clock_,
                     {frame_layout(options_), options_.actuators, Plant::channels.size(), options_.command_per_current,
                      options_.loop.period_ns, static_cast<std::int64_t>(options_.command_age_ms * 1e6),
                      static_cast<std::int64_t>(options_.heartbeat_age_ms * 1e6), session.authentication(),
                      options_.load_pressure ? load_pressure_of<Plant>() : std::nullopt, options_.heartbeat_optional});
    WireAccount account_of_wire;
    account_of_wire.complete = [&](Session& result) {
      BusAccount account = session.account();
      account.messages = {{can::command_message(frame_layout(options_)).name, wire.commands()},
                          {can::heartbeat::kMessage.name, wire.heartbeats()}};
      account.stale_cycles = wire.stale_cycles();
      account.too_old = wire.too_old();
      account.unsayable = wire.unsayable();
      result.bus = account;
    };
    account_of_wire.counters.can(session.socket())
        .add("bus", "cycles without a command", [&wire] { return wire.stale_cycles(); })
        .message(std::string(can::command_message(frame_layout(options_)).name), wire.commands())
        .message(std::string(can::heartbeat::kMessage.name), wire.heartbeats());
    if (options_.pace != PaceKind::can) {
      return run_paced(wire, account_of_wire);
    }
    hal::SocketCanListener frames(options_.bus, {can::id_of(can::sync::kMessage)});
    if (const auto refused = frames.open()) {
      complain(*refused);
      return kHardware;
    }
    can::CanSyncSource syncs(frames);
    return run_locked(wire, syncs, account_of_wire);
  }

 private:
  template <class Wire>
  int run_paced(Wire& wire, const WireAccount& account) {
    if (options_.pace == PaceKind::clock) {
      return run(wire, OwnPace<Clock>(clock_, options_.loop.period_ns), account);
    }
    hal::sim::SimulatedSyncSource<Clock> syncs(clock_, options_.loop.period_ns);
    return run_locked(wire, syncs, account);
  }

  template <class Wire, class Syncs>
  int run_locked(Wire& wire, Syncs& syncs, const WireAccount& account) {
    return run(wire,
               SyncPace<Clock, Syncs>(clock_, syncs, options_.loop.period_ns, options_.most_missed_syncs, patience_ns()),
               account);
  }

  template <class Wire, class Pace>
  int run(Wire& wire, Pace pace, const WireAccount& account) {
    using Bus = PlayedBus<Wire>;
    Bus bus(wire, image_.faults, period_);
    std::unique_ptr<RecordingSession> recording;
    if (!options_.recording.empty()) {
      recording = std::make_unique<RecordingSession>(options_, RecordedPlant::of(*plant_, image_.text));
      if (const auto failure = recording->start()) {
        complain(*failure);
        return kWrongUse;
      }
    }
    CycleOutputs outputs;
    outputs.recorder = recording ? &recording->recorder() : nullptr;
    const auto loop =
        std::make_unique<Loop<Plant, Bus, Clock, Pace, CycleOutputs>>(*plant_, bus, clock_, options_.loop, pace, &outputs);
    LiveSession live(options_);
    if (const auto failure =
            live.start(RecordedPlant::of(*plant_, image_.text), account.counters, loop->result(), outputs)) {
      complain(*failure);
      return kWrongUse;
    }
    Session session{options_,        loop->result(),       Plant::topology,
                    Plant::channels, Plant::channel_units, plant_->steps_per_cycle()};
    session.recording_file = options_.recording;
    session.max_dropped = options_.max_dropped;
    session.max_lost = options_.max_lost;
    session.synchronised = options_.pace != PaceKind::clock;
    session.is_vehicle = actuators_of(*image_.parameters) != 0;
    return run_loop(*loop, session, end_with(recording.get(), live, account.complete));
  }

  std::int64_t patience_ns() const {
    return options_.sync_patience_ms ? static_cast<std::int64_t>(*options_.sync_patience_ms * 1e6)
                                     : options_.loop.period_ns / 2;
  }

  const PlantOptions& options_;
  const PlantImage& image_;
  double period_;
  Clock clock_;
  std::unique_ptr<Plant> plant_;
};

/// The image that the options name, or the reference plant.
PlantImage image_of(const PlantOptions& options) {
  if (!options.image.empty()) {
    return read_plant_image(options.image);
  }
  PlantImage reference;
  reference.parameters = reference_plant_with_every_effect();
  return reference;
}

/// What of the options the plant of the image cannot be.
std::optional<hal::Failure> refuse_options(const PlantOptions& options, const PlantImage& image) {
  const std::size_t own = actuators_of(*image.parameters);
  if (own != 0 && options.actuators_given && options.actuators != own) {
    return hal::Failure{text("--actuators %zu: the model is a vehicle of %zu actuators", options.actuators, own),
                        "leave --actuators out: a vehicle has one for each axis"};
  }
  const std::size_t most = hal::kMaxReadings / readings_of(*image.parameters);
  if (own == 0 && options.actuators > most) {
    return hal::Failure{text("--actuators %zu: each has %zu readings, and a plant has room for %zu", options.actuators,
                             readings_of(*image.parameters), hal::kMaxReadings),
                        text("--actuators from 1 to %zu", most)};
  }
  if (const std::string refused = refused_record(image, period_of(options)); !refused.empty()) {
    return hal::Failure{refused, "--period-us, or a record with other rows: hotfire import with [resample] period"};
  }
  if (options.on_can() && own > can::most_actuators(options.layout.value_or(can::Layout::fd))) {
    return hal::Failure{text("--layout %s has no room for the %zu actuators of the model",
                             can::kLayouts[static_cast<std::size_t>(*options.layout)].data(), own),
                        "leave --layout out"};
  }
  if (const std::string_view topology = topology_without_valve(*image.parameters); options.on_can() && !topology.empty()) {
    return options.load_pressure
               ? hal::Failure{text("--load-pressure: a model of topology %s has no load pressure, nor a servovalve",
                                   topology.data()),
                              "a model of topology simplex, taos or masv"}
               : hal::Failure{text("a model of topology %s has no servovalve that a CAN bus could command", topology.data()),
                              "a model of topology simplex, taos or masv, or --bus sim"};
  }
  return std::nullopt;
}

}  // namespace

int run(const PlantOptions& asked) {
  const PlantImage image = image_of(asked);
  if (!image.parameters) {
    std::fprintf(stderr, "hotfire-rt: %s\n", image.error.c_str());
    return kBadData;
  }
  if (const auto refused = refuse_options(asked, image)) {
    complain(*refused);
    return kWrongUse;
  }
  PlantOptions options = asked;
  if (const std::size_t own = actuators_of(*image.parameters); own != 0) {
    options.actuators = own;
  }
  const hal::FlushDenormals flush;
  return with_plant(image, period_of(options), options.actuators, [&]<class Plant>(std::unique_ptr<Plant> plant) {
    PlantSession<Plant> session(options, image, std::move(plant));
    return options.on_can() ? session.run_on_can() : session.run_without_wire();
  });
}

/// A plant without a bus.
int run(const TimingOptions& options) {
  PlantOptions plant;
  static_cast<PlantRunOptions&>(plant) = options;
  return run(plant);
}

}  // namespace hotfire::firmware
