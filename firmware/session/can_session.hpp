// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "firmware/can/authentication.hpp"
#include "firmware/can/bus_account.hpp"
#include "firmware/can/layout.hpp"
#include "firmware/session/options.hpp"
#include "hal/failure.hpp"
#include "hal/linux/socket_can.hpp"

namespace hotfire::firmware {

/// A program's CAN interface.
class CanSession {
 public:
  /// `more`: what a plant sends besides its readings, which is a part of the bus's load.
  CanSession(const CanOptions& options, const RunOptions& run, const can::NodeIds& ids, can::MoreReadings more = {});

  /// The same of the options of a mode, which are both.
  template <class OfMode>
  CanSession(const OfMode& options, const can::NodeIds& ids, can::MoreReadings more = {})
      : CanSession(options, options, ids, more) {}

  /// Opens it. Refuses an interface that is not there, no CAN, not FD or down, no permission, and a schedule that takes too
  /// much of it. Prints the refusal with its remedy to standard error and returns the exit status; kGood if there is none.
  /// Nothing has been sent then.
  int open();

  /// Sees to it that nothing that was handed to the bus leaves after the program: a command that nobody has acknowledged
  /// must not move anything when somebody does. If it `may_wait`, a frame that is on its way is given the time it takes.
  /// What is left is taken back with the interface, and the kernel asked for a second if it refuses that. False if it still
  /// does.
  bool leave(bool may_wait = true);
  /// What there is to do then.
  hal::Failure not_left() const;

  /// Whether this program may not take the interface down, which alone takes a command back: said before anything is sent.
  std::optional<hal::Failure> refuse_without_take_back();

  hal::SocketCan& socket() noexcept { return socket_; }
  /// Of the key that the options name; null if they name none. Once `open` has found it good.
  can::Authentication* authentication() noexcept { return authentication_ ? &*authentication_ : nullptr; }

  /// Its account so far, without messages.
  BusAccount account() const;

 private:
  std::optional<hal::Failure> refuse_load();
  std::optional<hal::Failure> refuse_key();

  can::Layout layout() const { return frame_layout(options_, run_.actuators); }

  const CanOptions& options_;
  const RunOptions& run_;
  can::MoreReadings more_;
  hal::SocketCan socket_;
  std::optional<double> load_;
  std::optional<can::Authentication> authentication_;
};

/// Prints what is refused, and the remedy, to standard error.
void complain(const hal::Failure& failure);

}  // namespace hotfire::firmware
