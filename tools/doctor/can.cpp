// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "tools/doctor/doctor.hpp"
#include "tools/doctor/files.hpp"

namespace hotfire::doctor {

namespace {

using Json = nlohmann::json;

constexpr std::int64_t kLongestQueue = 64;

/// The value at the end of a path of keys; null if any is missing.
Json at(const Json& json, std::initializer_list<const char*> keys) {
  const Json* here = &json;
  for (const char* key : keys) {
    if (!here->is_object() || !here->contains(key)) {
      return nullptr;
    }
    here = &(*here)[key];
  }
  return *here;
}

std::int64_t whole(const Json& json) { return json.is_number() ? json.get<std::int64_t>() : 0; }

std::string text(const Json& json) { return json.is_string() ? json.get<std::string>() : ""; }

/// Looks at one interface by what `ip -details -json` says of it.
class Interface {
 public:
  Interface(std::string name, Json link) : name_(std::move(name)), link_(std::move(link)) {}

  std::vector<Finding> findings() {
    is_up();
    // A virtual bus has neither bits nor errors.
    if (is_virtual()) {
      add(Level::advice, "bit rate", "none: virtual, a schedule that fits no real bus passes",
          "compute the load of the real bus with 'hotfire check'");
    } else {
      bit_rate();
      restart();
      mode();
      state();
      errors();
    }
    queue();
    return findings_;
  }

 private:
  void add(Level level, const std::string& what_is, const std::string& what, const std::string& remedy = "") {
    findings_.push_back({name_ + " " + what_is, level, what, remedy});
  }

  bool is_virtual() const { return text(at(link_, {"linkinfo", "info_kind"})) != "can"; }

  std::string set(const std::string& options) const {
    return fmt::format("ip link set {0} down && ip link set {0} {1} up", name_, options);
  }

  void is_up() {
    const Json flags = at(link_, {"flags"});
    const bool up = flags.is_array() && std::find(flags.begin(), flags.end(), "UP") != flags.end();
    up ? add(Level::good, "link", "up") : add(Level::bad, "link", "down", fmt::format("ip link set {} up", name_));
  }

  void bit_rate() {
    const std::int64_t rate = whole(at(link_, {"linkinfo", "info_data", "bittiming", "bitrate"}));
    const std::int64_t data_rate = whole(at(link_, {"linkinfo", "info_data", "data_bittiming", "bitrate"}));
    if (rate == 0) {
      add(Level::bad, "bit rate", "not set", set("type can bitrate 1000000"));
      return;
    }
    add(Level::good, "bit rate",
        fmt::format("{} bit/s{}", rate, data_rate > 0 ? fmt::format(", data {} bit/s", data_rate) : ""));
  }

  void restart() {
    const std::int64_t restart_ms = whole(at(link_, {"linkinfo", "info_data", "restart_ms"}));
    restart_ms == 0
        ? add(Level::good, "restart", "by hand only")
        : add(Level::bad, "restart",
              fmt::format("{} ms after bus-off, by itself: frames are sent again without a person's decision", restart_ms),
              set("type can restart-ms 0"));
  }

  void mode() {
    const Json modes = at(link_, {"linkinfo", "info_data", "ctrlmode"});
    for (const char* mute : {"LISTEN-ONLY", "LOOPBACK"}) {
      if (modes.is_array() && std::find(modes.begin(), modes.end(), mute) != modes.end()) {
        const std::string option = mute == std::string("LOOPBACK") ? "loopback" : "listen-only";
        add(Level::bad, "mode", std::string(mute) + ": nothing is sent to the bus", set("type can " + option + " off"));
      }
    }
  }

  void state() {
    const std::string state = text(at(link_, {"linkinfo", "info_data", "state"}));
    if (state == "BUS-OFF") {
      add(Level::bad, "state", "bus-off",
          "correct wiring, termination or bit rate, then: ip link set " + name_ + " type can restart");
    } else if (state == "ERROR-PASSIVE" || state == "ERROR-WARNING") {
      add(Level::advice, "state", state + ": many frames go wrong", "look at wiring, termination (60 ohm) and bit rate");
    } else {
      add(Level::good, "state", state.empty() ? "not reported by the driver" : state);
    }
  }

  void errors() {
    const std::int64_t transmit = whole(at(link_, {"linkinfo", "info_data", "berr_counter", "tx"}));
    const std::int64_t receive = whole(at(link_, {"linkinfo", "info_data", "berr_counter", "rx"}));
    const std::int64_t offs = whole(at(link_, {"linkinfo", "info_xstats", "bus_off"}));
    if (transmit + receive + offs == 0) {
      add(Level::good, "errors", "none counted");
      return;
    }
    add(Level::advice, "errors",
        fmt::format("error counters: transmit {}, receive {}; bus-off {} times since it was set up", transmit, receive,
                    offs),
        fmt::format("watch them: ip -details -statistics link show {}; rising ones mean wiring or termination", name_));
  }

  void queue() {
    const std::string discipline = text(at(link_, {"qdisc"}));
    const std::int64_t length = whole(at(link_, {"txqlen"}));
    if (discipline != "pfifo_fast" && discipline != "pfifo_head_drop" && discipline != "noqueue" && !discipline.empty()) {
      add(Level::bad, "queue", discipline + " reorders or delays frames",
          fmt::format("tc qdisc replace dev {} root pfifo_head_drop limit 10", name_));
    } else if (length > kLongestQueue) {
      add(Level::advice, "queue", fmt::format("{} frames long: what waits in it is old when it is sent", length),
          fmt::format("ip link set {} txqueuelen 10", name_));
    } else {
      add(Level::good, "queue", fmt::format("{}, {} frames", discipline.empty() ? "not reported" : discipline, length));
    }
  }

  std::string name_;
  Json link_;
  std::vector<Finding> findings_;
};

/// The interfaces of this machine that are CAN.
std::vector<std::string> can_interfaces(const Patient& patient) {
  constexpr const char* kCanHardware = "280";  // ARPHRD_CAN
  std::vector<std::string> found;
  for (const std::string& name : names_in(patient.root / "sys/class/net")) {
    if (text_of(patient.root / "sys/class/net" / name / "type") == kCanHardware) {
      found.push_back(name);
    }
  }
  return found;
}

}  // namespace

std::vector<Finding> look_at_can(const Patient& patient) {
  const std::vector<std::string> there = can_interfaces(patient);
  if (there.empty() && patient.can.empty()) {
    return {{"CAN", Level::advice, "no CAN interface",
             "plug an adapter in; or to try: modprobe vcan && ip link add vcan0 mtu 72 type vcan && ip link set vcan0 up"}};
  }
  std::vector<Finding> findings;
  for (const std::string& name : patient.can.empty() ? there : patient.can) {
    if (std::find(there.begin(), there.end(), name) == there.end()) {
      std::string known;
      for (const std::string& other : there) {
        known += (known.empty() ? "; there are " : ", ") + other;
      }
      findings.push_back({name, Level::bad, "no such CAN interface" + known,
                          "plug the adapter in and load its driver, or name another; see: ip link show type can"});
      continue;
    }
    const Json links = Json::parse(patient.run("ip -details -statistics -json link show dev " + name), nullptr, false);
    if (!links.is_array() || links.empty()) {
      findings.push_back({name, Level::advice, "`ip` reported nothing about it", "apt install iproute2"});
      continue;
    }
    const std::vector<Finding> own = Interface(name, links.front()).findings();
    findings.insert(findings.end(), own.begin(), own.end());
  }
  return findings;
}

}  // namespace hotfire::doctor
