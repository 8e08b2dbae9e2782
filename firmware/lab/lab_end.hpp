// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace hotfire::firmware {

/// Decides when the program may end: when it is wanted, nothing is driven and what was driven is seen off. It does not wait
/// longer than kMostNs, or the time that a read-back may take if that is longer.
class LabLeaving {
 public:
  static constexpr std::int64_t kMostNs = 1'000'000'000;
  /// A cycle reads back what the cycle before has set.
  static constexpr std::uint64_t kReadBackLag = 2;

  LabLeaving(std::int64_t period_ns, std::uint64_t read_back_cycles) noexcept
      : most_(std::max(static_cast<std::uint64_t>(kMostNs / period_ns), read_back_cycles + kReadBackLag)) {}

  /// In every cycle. `seen_off`: the lines are set, the read-backs agree with them and no command waits.
  bool may_end(bool driven, bool wanted, bool seen_off) noexcept {
    undriven_ = driven ? 0 : undriven_ + 1;
    waited_ = wanted && !driven ? waited_ + 1 : 0;
    return waited_ > 0 && ((seen_off && undriven_ >= kReadBackLag) || waited_ > most_);
  }

 private:
  std::uint64_t most_;          ///< cycles
  std::uint64_t undriven_ = 0;  ///< cycles since anything was driven
  std::uint64_t waited_ = 0;    ///< cycles
};

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
