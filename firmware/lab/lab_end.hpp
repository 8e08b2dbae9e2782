// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace hotfire::firmware {

/// Decides when the program may end: an end is requested, nothing is driven, and what was driven is seen off. It waits at
/// most kMostNs, or the time that a read-back may take if that is longer.
class LabLeaving {
 public:
  static constexpr std::int64_t kMostNs = 1'000'000'000;
  /// A cycle reads back the outputs that the previous cycle has set.
  static constexpr std::uint64_t kReadBackLag = 2;

  LabLeaving(std::int64_t period_ns, std::uint64_t read_back_cycles) noexcept
      : most_(std::max(static_cast<std::uint64_t>(kMostNs / period_ns), read_back_cycles + kReadBackLag)) {}

  /// Call it in every cycle. `seen_off`: the lines are set, the read-backs agree with them and no command waits.
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

/// The result of the end of a lab.
struct LabEnd {
  bool lines_dropped = true;  ///< every output is off
  bool left_the_bus = true;   ///< no command is before the bus
};

/// Makes a lab safe after the end of its loop. First the supply goes off. The fault line of a faulted rig stays on until
/// `leave(may_wait)` has left the bus, which must not wait if a command may still be sent. Then every line goes off. Only
/// then `finish` records the last cycle, so that a stalled disk holds no line on. `Rig` is a `LabRig`.
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
