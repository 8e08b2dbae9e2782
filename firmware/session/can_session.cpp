// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/can_session.hpp"

#include <cstdio>

#include "firmware/can/bus_load.hpp"
#include "firmware/service/status.hpp"
#include "firmware/session/key_file.hpp"
#include "firmware/text/text.hpp"
#include "hal/linux/can_bit_rates.hpp"
#include "hal/linux/posix_clock.hpp"

namespace hotfire::firmware {

void complain(const hal::Failure& failure) {
  std::fprintf(stderr, "hotfire-rt: %s\n  remedy: %s\n", failure.what.c_str(), failure.remedy.c_str());
}

CanSession::CanSession(const CanOptions& options, const RunOptions& run, const can::NodeIds& ids, can::MoreReadings more)
    : options_(options),
      run_(run),
      more_(more),
      socket_({options.bus, ids.subscriptions, ids.senders, can::is_fd(frame_layout(options, run.actuators))}) {}

int CanSession::open() {
  if (const auto refused = refuse_key()) {
    complain(*refused);
    return kWrongUse;
  }
  if (const auto refused = socket_.open()) {
    complain(*refused);
    return kHardware;
  }
  if (const auto refused = refuse_load()) {
    complain(*refused);
    return kWrongUse;
  }
  return kGood;
}

std::optional<hal::Failure> CanSession::refuse_key() {
  if (options_.key.empty()) {
    return std::nullopt;
  }
  if (!can::is_fd(layout())) {
    return hal::Failure{"--key: the frames of the classic layouts have no space for a code", "--layout fd, or fd-split"};
  }
  const ReadKey read = read_key(options_.key);
  if (!read.refused) {
    authentication_.emplace(read.key, static_cast<std::int64_t>(options_.freshness_ms * 1e6), &hal::real_time_ns);
  }
  return read.refused;
}

std::optional<hal::Failure> CanSession::refuse_load() {
  hal::CanBitRates rates = hal::can_bit_rates(options_.bus);
  rates.nominal = options_.bit_rate > 0.0 ? options_.bit_rate : rates.nominal;
  rates.data = options_.data_bit_rate > 0.0 ? options_.data_bit_rate : rates.data;
  if (rates.nominal == 0.0) {
    return std::nullopt;
  }
  rates.data = rates.data > 0.0 ? rates.data : rates.nominal;
  load_ = can::bus_load(layout(), run_.actuators, run_.loop.period_ns, rates.nominal, rates.data, more_);
  if (*load_ <= hal::kLargestBusLoad) {
    return std::nullopt;
  }
  return hal::Failure{text("%s at %.0f bit/s would be loaded by %.1f %% in the worst case; allowed: %.0f %%",
                           options_.bus.c_str(), rates.nominal, 100.0 * *load_, 100.0 * hal::kLargestBusLoad),
                      "a longer --period-us, a faster bus, or --layout fd; 'hotfire check' computes a schedule"};
}

std::optional<hal::Failure> CanSession::refuse_without_take_back() {
  if (socket_.may_take_interface_down()) {
    return std::nullopt;
  }
  return hal::Failure{
      "this program may not take " + options_.bus + " down, so it could not take back a command that no node acknowledges",
      "give the program CAP_NET_ADMIN: 'setcap cap_net_admin,cap_ipc_lock,cap_sys_nice+ep hotfire-rt', or "
      "AmbientCapabilities= of its unit"};
}

bool CanSession::leave(bool may_wait) {
  constexpr std::int64_t kFrameNs = 1'000'000;
  constexpr int kMostFrames = 20;
  constexpr std::int64_t kAskAgainNs = 100'000'000;
  constexpr int kMostAsked = 10;
  const hal::PosixClock clock;
  for (int i = 0; may_wait && i < kMostFrames && socket_.anything_pending(); ++i) {
    clock.sleep_until_ns(clock.now_ns() + kFrameNs);
    socket_.receive(clock.now_ns());
  }
  for (int i = 0; i < kMostAsked; ++i) {
    if (socket_.stop()) {
      return true;
    }
    clock.sleep_until_ns(clock.now_ns() + kAskAgainNs);
  }
  return false;
}

hal::Failure CanSession::not_left() const {
  return {"a frame is still before " + options_.bus + " and cannot be taken back",
          "'ip link set " + options_.bus + " down'; the program may do that itself with CAP_NET_ADMIN"};
}

BusAccount CanSession::account() const {
  BusAccount account;
  account.interface = options_.bus;
  account.layout = layout();
  account.load = load_;
  account.authenticated = authentication_.has_value();
  account.state = socket_.state();
  account.frames = socket_.counters();
  return account;
}

}  // namespace hotfire::firmware
