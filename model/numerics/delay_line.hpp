// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The memory of a command holds its longest delay [s] at the shortest step [s], that of a 20 kHz record.
inline constexpr double kLongestCommandDelay = 0.1;
inline constexpr double kShortestDelayedStep = 5e-5;
inline constexpr std::size_t kCommandMemory = 2048;
static_assert(kLongestCommandDelay / kShortestDelayedStep < kCommandMemory - 2);

/// Transport delay of a value, x(t) -> x(t - delay), by the newest `Capacity` values in a ring. A delay of k + f steps
/// (0 <= f < 1) gives (1 - f) x[n-k] + f x[n-k-1]: the mean over a step of a value that is held between steps, and the value
/// itself of one that moves linearly. Differentiable in the delay. Beyond `Capacity` - 2 steps it would extrapolate.
///
/// A negative delay reads ahead, on the parabola through the newest three values: wrong by delay^3 / 6 times the third
/// derivative, for a clock that is early by far less than what it reads takes to change.
/// Source: transport lag e^{-sT}, any text on control.
template <class S, std::size_t Capacity>
class DelayLine {
 public:
  DelayLine() = default;
  /// The same in another scalar, value by value.
  template <class Other>
  explicit DelayLine(const DelayLine<Other, Capacity>& other) noexcept : newest_(other.newest_) {
    for (std::size_t i = 0; i < Capacity; ++i) {
      values_[i] = S(value_of(other.values_[i]));
    }
  }

  void fill(const S& value) noexcept { values_.fill(value); }

  /// Takes in the newest value; returns the one `delay` [s] ago at steps of `h` [s].
  S pass(const S& value, const S& delay, double h) noexcept {
    newest_ = (newest_ + 1) % Capacity;
    values_[newest_] = value;
    const S steps = delay / h;
    const auto is_early = value_of(steps) < 0.0;
    if (everywhere(is_early)) {
      return ahead(-steps);
    }
    const S late = behind(steps);
    return anywhere(is_early) ? select(is_early, ahead(-steps), late) : late;
  }

  /// Puts the state of a delay line of plain numbers into one lane; as many values have passed through both.
  template <class Other>
  void set_lane(int lane, const DelayLine<Other, Capacity>& other) noexcept {
    newest_ = other.newest_;
    for (std::size_t i = 0; i < Capacity; ++i) {
      values_[i].set(lane, other.values_[i]);
    }
  }

 private:
  template <class Other, std::size_t OtherCapacity>
  friend class DelayLine;

  /// Whole steps in a delay, from none to the most that the memory holds.
  static std::size_t whole_steps(double steps) noexcept {
    constexpr auto kLongest = static_cast<double>(Capacity - 2);
    return steps > 0.0 ? static_cast<std::size_t>(steps < kLongest ? steps : kLongest) : 0;
  }
  const S& ago(std::size_t steps) const noexcept { return values_[(newest_ + Capacity - steps) % Capacity]; }

  S behind(const S& steps) const noexcept {
    if constexpr (are_lanes<S>) {
      const auto whole_in = [&](int lane) { return whole_steps(steps[lane]); };
      const S whole = S::by_lane([&](int lane) { return static_cast<double>(whole_in(lane)); });
      const S later = S::by_lane([&](int lane) { return ago(whole_in(lane))[lane]; });
      const S earlier = S::by_lane([&](int lane) { return ago(whole_in(lane) + 1)[lane]; });
      return later + (earlier - later) * (steps - whole);
    } else {
      const std::size_t whole = whole_steps(value_of(steps));
      return ago(whole) + (ago(whole + 1) - ago(whole)) * (steps - static_cast<double>(whole));
    }
  }

  S ahead(const S& steps) const noexcept {
    const S& now = values_[newest_];
    const S& before = values_[(newest_ + Capacity - 1) % Capacity];
    const S& long_before = values_[(newest_ + Capacity - 2) % Capacity];
    const S slope = 1.5 * now - 2.0 * before + 0.5 * long_before;
    const S bend = now - 2.0 * before + long_before;
    return now + (slope + 0.5 * bend * steps) * steps;
  }

  std::array<S, Capacity> values_{};
  std::size_t newest_ = 0;
};

}  // namespace hotfire::model
