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
  /// `more`: the frames of a plant in addition to its readings, which are a part of the bus load.
  CanSession(const CanOptions& options, const RunOptions& run, const can::NodeIds& ids, can::MoreReadings more = {});

  /// The same of the options of a mode, which are both.
  template <class OfMode>
  CanSession(const OfMode& options, const can::NodeIds& ids, can::MoreReadings more = {})
      : CanSession(options, options, ids, more) {}

  /// Opens the bus. Refuses an interface that does not exist, is not CAN, is not FD or is down. Refuses a missing
  /// permission, and a schedule that takes too much of the bus. Prints the refusal with its remedy to standard error and
  /// returns the exit status; kGood if there is no refusal. No frame has been sent then.
  int open();

  /// Ensures that no frame leaves after the end of the program: a command that nobody has acknowledged must not move
  /// anything later. If it `may_wait`, a frame that is being sent gets the time that it needs. Frames that remain are taken
  /// back with the interface. If the kernel refuses this, it is asked again for a second. False if it still refuses.
  bool leave(bool may_wait = true);
  /// What there is to do then.
  hal::Failure not_left() const;

  /// Whether this program is not allowed to take the interface down, which is the only way to take a command back. Reported
  /// before anything is sent.
  std::optional<hal::Failure> refuse_without_take_back();

  hal::SocketCan& socket() noexcept { return socket_; }
  /// The key that the options name; null if they name none. Valid after `open` has accepted it.
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
