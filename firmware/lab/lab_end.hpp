// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

namespace hotfire::firmware {

/// What the end of a lab has reached.
struct LabEnd {
  bool lines_dropped = true;  ///< every output is off
  bool left_the_bus = true;   ///< no command is before the bus
};

/// Makes a lab safe whose loop has ended. The supply goes off first, and the fault line of a rig that is faulted stays on
/// until the bus is left: `leave(may_wait)` sees to that, and must not wait if a command may be before it. Then every line
/// goes off. Only then `finish` hands on the last cycle: a disk that stalls holds no line. `Rig` is a `LabRig`.
template <class Rig, class Leave, class Finish>
LabEnd make_lab_safe(Rig& rig, Leave&& leave, Finish&& finish) {
  LabEnd end;
  rig.drop_lines(true);
  end.left_the_bus = std::forward<Leave>(leave)(!rig.may_have_command_before_bus());
  end.lines_dropped = rig.drop_lines();
  std::forward<Finish>(finish)();
  return end;
}

}  // namespace hotfire::firmware
