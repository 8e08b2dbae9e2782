// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/bus_account.hpp"
#include "firmware/text/json.hpp"
#include "firmware/text/text.hpp"
#include "hal/schedule/frame_time.hpp"

namespace hotfire::firmware {
namespace {

std::string load_text(const BusAccount& bus) {
  return bus.load ? text("worst-case load %.1f %%, allowed %.0f %%", 100.0 * *bus.load, 100.0 * hal::kLargestBusLoad)
                  : std::string("load not known: it has no bit rate, name one with --bit-rate");
}

}  // namespace

std::string text_of(const BusAccount& bus) {
  const hal::CanCounters& frames = bus.frames;
  std::string result =
      text("  bus           %s, %s layout%s, %s; %s\n", bus.interface.c_str(),
           can::kLayouts[static_cast<std::size_t>(bus.layout)].data(), bus.authenticated ? ", authenticated" : "",
           hal::kCanStates[static_cast<std::size_t>(bus.state)], load_text(bus).c_str());
  result += text(
      "  frames in     %llu received, %llu superseded, %llu foreign, %llu with an id of this program, %llu dropped by the "
      "kernel, %llu "
      "error frames\n",
      whole(frames.received), whole(frames.superseded), whole(frames.foreign), whole(frames.impostors),
      whole(frames.dropped), whole(frames.error_frames));
  result += text(
      "  frames out    %llu sent; not sent: %llu pending, %llu queue full, %llu bus unusable, %llu not encodable\n",
      whole(frames.sent), whole(frames.pending), whole(frames.queue_full), whole(frames.unusable), whole(bus.unsayable));
  for (const MessageAccount& message : bus.messages) {
    const can::MessageCounters& counters = message.counters;
    result += text(
        "  %s: %llu taken, %llu superseded, %llu lost, %llu repeated, %llu out of order, %llu surplus, %llu refused, %llu "
        "not authentic\n",
        message.name.data(), whole(counters.taken), whole(counters.superseded), whole(counters.skipped),
        whole(counters.repeated), whole(counters.backward), whole(counters.too_many), whole(counters.refused),
        whole(counters.unauthentic));
  }
  if (bus.stale_cycles + bus.too_old > 0) {
    result += text("  stale         %llu cycles without a valid command, %llu commands taken in too late\n",
                   whole(bus.stale_cycles), whole(bus.too_old));
  }
  return result;
}

void add_to(Json& json, const BusAccount& bus) {
  const hal::CanCounters& frames = bus.frames;
  json.open("bus");
  json.add("interface", bus.interface);
  json.add("layout", can::kLayouts[static_cast<std::size_t>(bus.layout)]);
  json.add("authenticated", bus.authenticated);
  json.add("state", hal::kCanStates[static_cast<std::size_t>(bus.state)]);
  if (bus.load) {
    json.add("worst_case_load", *bus.load);
  }
  json.add("lost", bus.lost());
  json.add("received", frames.received);
  json.add("superseded", frames.superseded);
  json.add("foreign", frames.foreign);
  json.add("impostors", frames.impostors);
  json.add("dropped", frames.dropped);
  json.add("error_frames", frames.error_frames);
  json.add("sent", frames.sent);
  json.add("pending", frames.pending);
  json.add("queue_full", frames.queue_full);
  json.add("unusable", frames.unusable);
  json.add("unsayable", bus.unsayable);
  json.add("stale_cycles", bus.stale_cycles);
  json.add("too_old", bus.too_old);
  json.add("lost_syncs", bus.lost_syncs);
  json.open("messages");
  for (const MessageAccount& message : bus.messages) {
    json.open(message.name);
    json.add("taken", message.counters.taken);
    json.add("superseded", message.counters.superseded);
    json.add("lost", message.counters.skipped);
    json.add("repeated", message.counters.repeated);
    json.add("out_of_order", message.counters.backward);
    json.add("too_many", message.counters.too_many);
    json.add("not_authentic", message.counters.unauthentic);
    json.add("refused", message.counters.refused);
    json.close();
  }
  json.close();
  json.close();
}

}  // namespace hotfire::firmware
