// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "hal/can.hpp"

namespace hotfire::hal {

/// The part of `CanBus` that is the same for every backend: mailboxes, pending frames, state and counters. A backend reports
/// the events of the bus to it. No allocation after construction.
class CanNode {
 public:
  /// `senders` are the ids that are sent. Entries beyond kMaxCanSubscriptions or kMaxCanSenders are left out.
  CanNode(std::span<const CanSubscription> subscriptions, std::span<const CanId> senders) noexcept
      : subscribed_(std::min(subscriptions.size(), kMaxCanSubscriptions)),
        sending_(std::min(senders.size(), kMaxCanSenders)) {
    std::copy_n(subscriptions.begin(), subscribed_, subscriptions_.begin());
    std::copy_n(senders.begin(), sending_, senders_.begin());
  }

  /// Begins a receive: frames that were new are not new any more.
  void begin_receive() noexcept {
    arrived_ = 0;
    for (std::size_t i = 0; i < subscribed_; ++i) {
      mailboxes_[i].fresh = false;
    }
  }

  void take(const CanFrame& frame, std::int64_t arrived_ns) noexcept {
    for (std::size_t i = 0; i < subscribed_; ++i) {
      if (subscriptions_[i].id == frame.id) {
        if (subscriptions_[i].fd != frame.fd) {
          ++counters_.foreign;
          return;
        }
        CanMailbox& box = mailboxes_[i];
        const bool overtaken = box.fresh;
        box.superseded += overtaken ? 1 : 0;
        counters_.superseded += overtaken ? 1 : 0;
        box.frame = frame;
        box.arrived_ns = arrived_ns;
        box.fresh = true;
        ++box.received;
        ++counters_.received;
        keep(i, frame, arrived_ns);
        return;
      }
    }
    ++(sender(frame.id) < sending_ ? counters_.impostors : counters_.foreign);
  }

  /// The bus confirms that a frame of this id, sent by this node, has left.
  void confirm(const CanId& id) noexcept {
    const std::size_t i = sender(id);
    if (i < sending_ && pending_[i]) {
      pending_[i] = false;
      ++counters_.confirmed;
    }
  }

  /// Whether a frame of this id may be given to the bus. If not, the reason, counted.
  CanSend may_send(const CanId& id) noexcept {
    const std::size_t i = sender(id);
    if (i == sending_ || stopped_ || state_ >= CanState::bus_off) {
      ++counters_.unusable;
      return CanSend::unusable;
    }
    if (pending_[i]) {
      ++counters_.pending;
      return CanSend::pending;
    }
    return CanSend::taken;
  }

  /// A frame of this id has been handed over.
  void note_sent(const CanId& id) noexcept {
    pending_[sender(id)] = true;
    ++counters_.sent;
  }

  /// The controller reports another state. The worst two states stay.
  void change_state(CanState state) noexcept {
    if (state != state_ && (state_ < CanState::bus_off || state > state_)) {
      state_ = state;
      ++counters_.state_changes;
    }
  }

  void stop() noexcept { stopped_ = true; }

  /// Clears bus-off, down and stop, the pending frames, and every mailbox: an earlier frame is not a present reading.
  void rearm() noexcept {
    stopped_ = false;
    counters_.state_changes += state_ == CanState::good ? 0 : 1;
    state_ = CanState::good;
    pending_.fill(false);
    for (CanMailbox& box : mailboxes_) {
      box = {};
    }
    arrived_ = 0;
  }

  bool anything_pending() const noexcept { return std::find(pending_.begin(), pending_.end(), true) != pending_.end(); }

  const CanMailbox& mailbox(std::size_t i) const noexcept { return mailboxes_[i]; }

  std::span<const CanArrival> arrivals() const noexcept { return std::span(arrivals_).first(arrived_); }

  bool in_time(std::size_t i, std::int64_t now_ns) const noexcept {
    return mailboxes_[i].received > 0 && now_ns - mailboxes_[i].arrived_ns <= subscriptions_[i].age_limit_ns;
  }

  CanState state() const noexcept { return state_; }
  const CanCounters& counters() const noexcept { return counters_; }
  CanCounters& counters() noexcept { return counters_; }

 private:
  void keep(std::size_t subscription, const CanFrame& frame, std::int64_t arrived_ns) noexcept {
    if (arrived_ < arrivals_.size()) {
      arrivals_[arrived_++] = {subscription, frame, arrived_ns};
    } else {
      ++counters_.dropped;
    }
  }

  std::size_t sender(const CanId& id) const noexcept {
    const auto* const end = senders_.begin() + sending_;
    return static_cast<std::size_t>(std::find(senders_.begin(), end, id) - senders_.begin());
  }

  std::size_t subscribed_;
  std::size_t sending_;
  std::array<CanSubscription, kMaxCanSubscriptions> subscriptions_{};
  std::array<CanMailbox, kMaxCanSubscriptions> mailboxes_{};
  std::array<CanArrival, kMaxCanArrivals> arrivals_{};
  std::size_t arrived_ = 0;
  std::array<CanId, kMaxCanSenders> senders_{};
  std::array<bool, kMaxCanSenders> pending_{};
  bool stopped_ = false;
  CanState state_ = CanState::good;
  CanCounters counters_;
};

/// The part of `CanBus` that a backend delegates to its node. Public calls are for the program; the node belongs to the
/// backend.
class OnCanNode {
 public:
  const CanMailbox& mailbox(std::size_t i) const noexcept { return node_.mailbox(i); }
  std::span<const CanArrival> arrivals() const noexcept { return node_.arrivals(); }
  bool in_time(std::size_t i, std::int64_t now_ns) const noexcept { return node_.in_time(i, now_ns); }
  CanState state() const noexcept { return node_.state(); }
  bool anything_pending() const noexcept { return node_.anything_pending(); }
  const CanCounters& counters() const noexcept { return node_.counters(); }

 protected:
  OnCanNode(std::span<const CanSubscription> subscriptions, std::span<const CanId> senders) noexcept
      : node_(subscriptions, senders) {}
  ~OnCanNode() = default;

  CanNode node_;
};

}  // namespace hotfire::hal
