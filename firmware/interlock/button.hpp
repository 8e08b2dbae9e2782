// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hotfire::firmware {

/// What a contact is taken to say once it has settled. It begins on: a button that is held when the program starts, or whose
/// line has not settled yet, has not been seen off.
struct Contact {
  bool on = true;
  std::uint32_t differing = 0;  ///< cycles in a row that the line said the other thing

  friend constexpr bool operator==(const Contact&, const Contact&) noexcept = default;
};

/// Debounces both edges: the contact follows its line once the line has said the same for `cycles` whole periods, so in
/// `cycles` + 1 looks, without a change between two of them. `changed`: the line has changed since the look before, whatever
/// it says now.
constexpr Contact settled(Contact contact, bool line, bool changed, std::uint32_t cycles) noexcept {
  if (line == contact.on) {
    contact.differing = 0;
    return contact;
  }
  contact.differing = changed ? 1 : contact.differing + 1;
  return contact.differing > cycles ? Contact{line, 0} : contact;
}

/// A person's button as far as it has been pressed.
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

/// A press is a button that goes on and, after `times`, off again: it acts when it is released, as ISO 13849-1:2015, 5.2.2,
/// asks of a manual reset. So neither a contact that sticks nor a wire that breaks is one. `may_begin`: a press may begin
/// after this cycle if the button is off in it, and its line too: a line that is on already belongs to a press that began
/// before and has not settled. `forbidden`: the press is refused, also if that is over when it ends, and
/// one that begins after this cycle: a line that could not be read was not seen off.
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
