// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hotfire::firmware {

/// The settled state of a contact. It begins as on. A button that is held at the start of the program, or whose line has not
/// settled, therefore does not count as seen off.
struct Contact {
  bool on = true;
  std::uint32_t differing = 0;  ///< cycles in a row that the line said the other thing

  friend constexpr bool operator==(const Contact&, const Contact&) noexcept = default;
};

/// Debounces both edges. The contact follows its line once the line has been the same for `cycles` whole periods, which is
/// `cycles` + 1 samples, without a change between two of them. `changed`: the line has changed since the previous sample,
/// whatever its level is now.
constexpr Contact settled(Contact contact, bool line, bool changed, std::uint32_t cycles) noexcept {
  if (line == contact.on) {
    contact.differing = 0;
    return contact;
  }
  contact.differing = changed ? 1 : contact.differing + 1;
  return contact.differing > cycles ? Contact{line, 0} : contact;
}

/// The state of a person's button within a press.
struct Button {
  bool ready = false;      ///< it was seen off when a press might begin
  bool refused = false;    ///< something forbade the press while it lasted
  std::uint32_t held = 0;  ///< cycles that it has been on for since

  friend constexpr bool operator==(const Button&, const Button&) noexcept = default;
};

enum class Press : std::uint8_t { none, good, refused };

/// How long a press may last.
struct PressTimes {
  std::uint32_t least = 1;  ///< cycles
  std::uint32_t most = 1;
};

/// A press is a button that goes on and, after `times`, off again. It acts when it is released, as ISO 13849-1:2015, 5.2.2,
/// requires of a manual reset. A contact that sticks, or a wire that breaks, is therefore not a press. `may_begin`: a press
/// may begin after this cycle if the button and its line are off in it. A line that is already on belongs to an earlier
/// press that has not settled. `forbidden`: the press is refused, even if the reason is over at its end. A press that begins
/// after this cycle is refused too, because a line that could not be read was not seen off.
constexpr Press press(Button& button, Contact contact, bool may_begin, bool forbidden, PressTimes times) noexcept {
  if (contact.on) {
    button.held += button.ready && button.held <= times.most ? 1 : 0;
    button.refused = button.ready && (button.refused || forbidden);
    return Press::none;
  }
  const bool whole = button.ready && button.held >= times.least && button.held <= times.most;
  const bool refused = button.refused || forbidden;
  const bool settling = contact.differing > 0;
  button = {may_begin && (!settling || button.ready), forbidden || (settling && button.refused), 0};
  return !whole ? Press::none : refused ? Press::refused : Press::good;
}

}  // namespace hotfire::firmware
