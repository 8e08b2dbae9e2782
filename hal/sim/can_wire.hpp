// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include "hal/can_node.hpp"

namespace hotfire::hal::sim {

/// A bus within the process. Nodes give frames to a wire, and every other node takes them at its next `receive`. A test
/// delays confirmations, fills the queue, reports bus-off or takes the wire down. At most kMaxFrames wait for a node.
/// Further frames are dropped and counted, as by the buffer of a kernel. At most kMaxNodes nodes; for one thread.
class CanWire {
 public:
  static constexpr std::size_t kMaxFrames = 64;
  static constexpr std::size_t kMaxNodes = 4;

  /// One node (`CanBus`).
  class Node : public OnCanNode {
   public:
    Node(CanWire& wire, std::span<const CanSubscription> subscriptions, std::span<const CanId> senders) noexcept
        : OnCanNode(subscriptions, senders), wire_(wire), number_(wire.nodes_++) {
      assert(number_ < kMaxNodes);
    }

    void receive(std::int64_t now_ns) noexcept {
      node_.begin_receive();
      Inbox& inbox = wire_.inboxes_[number_];
      if (wire_.down_) {
        node_.change_state(CanState::down);
        inbox.count = 0;
      } else if (wire_.bus_off_) {
        node_.change_state(CanState::bus_off);
      }
      for (std::size_t i = 0; i < inbox.count; ++i) {
        const Waiting& waiting = inbox.frames[i];
        if (waiting.own) {
          node_.confirm(waiting.frame.id);
        } else {
          node_.take(waiting.frame, now_ns);
        }
      }
      node_.counters().dropped += inbox.dropped;
      inbox.count = 0;
      inbox.dropped = 0;
    }

    CanSend try_send(const CanFrame& frame) noexcept {
      const CanSend may = node_.may_send(frame.id);
      if (may != CanSend::taken) {
        return may;
      }
      if (wire_.down_) {
        node_.change_state(CanState::down);
        ++node_.counters().unusable;
        return CanSend::unusable;
      }
      if (wire_.full_) {
        ++node_.counters().queue_full;
        return CanSend::queue_full;
      }
      node_.note_sent(frame.id);
      wire_.carry(frame, number_);
      return CanSend::taken;
    }

    bool stop() noexcept {
      node_.stop();
      wire_.held_.count = wire_.refuses_stop_ ? wire_.held_.count : 0;
      return wire_.held_.count == 0;
    }

    bool rearm() noexcept {
      if (wire_.down_ || wire_.bus_off_) {
        return false;
      }
      wire_.inboxes_[number_] = {};
      node_.rearm();
      return true;
    }

   private:
    CanWire& wire_;
    std::size_t number_;
  };

  /// Frames stay below the program, unconfirmed, until `release`: a bus without an acknowledging partner.
  void hold() noexcept { holding_ = true; }
  void release() noexcept {
    holding_ = false;
    for (std::size_t i = 0; i < held_.count; ++i) {
      deliver(held_.frames[i].frame, held_.senders[i]);
    }
    held_.count = 0;
  }

  void set_queue_full(bool full) noexcept { full_ = full; }
  /// Held frames are not returned to `stop`.
  void set_stop_refused(bool refused) noexcept { refuses_stop_ = refused; }
  void set_bus_off(bool bus_off) noexcept { bus_off_ = bus_off; }
  /// A wire that goes down loses the held frames, as the queue of a network device does.
  void set_down(bool down) noexcept {
    down_ = down;
    held_.count = down ? 0 : held_.count;
  }

 private:
  struct Waiting {
    CanFrame frame;
    bool own = false;
  };
  struct Inbox {
    std::array<Waiting, kMaxFrames> frames{};
    std::array<std::size_t, kMaxFrames> senders{};
    std::size_t count = 0;
    std::uint64_t dropped = 0;
  };

  void carry(const CanFrame& frame, std::size_t sender) noexcept {
    if (!holding_) {
      deliver(frame, sender);
    } else if (held_.count < kMaxFrames) {
      held_.senders[held_.count] = sender;
      held_.frames[held_.count++].frame = frame;
    }
  }

  void deliver(const CanFrame& frame, std::size_t sender) noexcept {
    for (std::size_t node = 0; node < nodes_; ++node) {
      Inbox& inbox = inboxes_[node];
      if (inbox.count < kMaxFrames) {
        inbox.frames[inbox.count++] = {frame, node == sender};
      } else {
        ++inbox.dropped;
      }
    }
  }

  std::array<Inbox, kMaxNodes> inboxes_{};
  Inbox held_;
  std::size_t nodes_ = 0;
  bool holding_ = false;
  bool full_ = false;
  bool bus_off_ = false;
  bool down_ = false;
  bool refuses_stop_ = false;
};

static_assert(CanBus<CanWire::Node>);

}  // namespace hotfire::hal::sim
