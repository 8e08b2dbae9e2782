// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

#include "model/numerics/operators.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Memory of a term of the grammar for its argument s: a linear filter, a hysteresis, a limit, a loss of information or an
/// oscillation. Curves without memory that have a parameter are included.
enum class Memory {
  none,
  delay,       ///< s(t - time)
  lag,         ///< first-order low pass of time constant `time`
  washout,     ///< s less that low pass
  resonance,   ///< second-order low pass of `frequency` and `damping`
  band_pass,   ///< 2 damping / (2 pi frequency) times the rate of that
  stops,       ///< stop operators (Krasnosel'skii and Pokrovskii 1989, sec. 2), one for each of up to four widths
  play,        ///< what follows s at a distance of up to `width` (backlash)
  stop,        ///< s less that: one stop operator
  slew,        ///< what follows s by at most `width` a second
  hold,        ///< s as it was sampled once every `time`, of which `phase` over a turn has passed at the start
  quantise,    ///< s rounded to multiples of `width`
  dead_zone,   ///< s without what lies within `width` of zero
  saturation,  ///< s limited to `width`
  periodic,    ///< s less the nearest multiple of `width`
  oscillator,  ///< sine of a phase that starts at `phase` and advances at `frequency` + s, both in hertz
  odd_power,   ///< sgn(s) |s / width|^exponent, times `width`; constant where s is beyond four widths
  even_power   ///< |s / width|^exponent, times `width`; constant there as well
};
inline constexpr std::array<std::string_view, 18> kMemoryNames{
    "none", "delay", "lag",      "washout",   "resonance",  "band_pass", "stops",      "play",      "stop",
    "slew", "hold",  "quantise", "dead_zone", "saturation", "periodic",  "oscillator", "odd_power", "even_power"};

/// Widths up to which a power continues. It is constant beyond.
inline constexpr double kPowerLimit = 4.0;

constexpr bool is_power(Memory kind) noexcept { return kind == Memory::odd_power || kind == Memory::even_power; }

template <class S>
struct MemoryParameters {
  Memory kind = Memory::none;
  S time{0.0};        ///< [s]
  S frequency{1.0};   ///< [Hz]
  S damping{0.5};     ///< of critical [1]
  S width{1.0};       ///< in the argument's unit
  S phase{0.0};       ///< of an oscillator or of the samples of a hold at the start [rad]
  S exponent{2.0};    ///< of a power [1]
  double mean = 0.0;  ///< how late in a step a hold's argument is known, in steps: 0.5 where it is the mean over the step
};

inline constexpr std::size_t kMostStops = 4;

/// State of a memory. Before its start it is at rest under the present argument: its output is the steady one.
template <class S>
class MemoryState {
 public:
  MemoryState() = default;
  /// The same in another scalar, value by value.
  template <class Other>
  explicit MemoryState(const MemoryState<Other>& other) noexcept
      : started_(other.started_),
        value_(value_of(other.value_)),
        rate_(value_of(other.rate_)),
        turns_(value_of(other.turns_)),
        since_(other.since_),
        newest_(other.newest_),
        age_(other.age_) {
    for (std::size_t k = 0; k < kMostStops; ++k) {
      stops_[k] = S(value_of(other.stops_[k]));
    }
    for (std::size_t k = 0; k < kEarlier; ++k) {
      earlier_[k] = S(value_of(other.earlier_[k]));
    }
  }

  void rest() noexcept { started_ = false; }

  /// Output of every memory but `stops`, mean over a step of `h` [s] in which the argument `s` is held.
  S step(const MemoryParameters<S>& params, const S& s, double h) noexcept {
    const bool begins = !started_;
    start(s);
    switch (params.kind) {
      case Memory::none:
      case Memory::stops:
        return s;
      case Memory::delay:
        return delayed(params.time, s, h);
      case Memory::lag:
        return lag_of_held(value_, s, params.time, h);
      case Memory::washout:
        return s - lag_of_held(value_, s, params.time, h);
      case Memory::resonance:
      case Memory::band_pass: {
        // Implicit midpoint rule: stable at any frequency.
        const S natural = 2.0 * std::numbers::pi * params.frequency;
        const S start = value_;
        const S mean_rate = (rate_ + 0.5 * h * natural * natural * (s - start)) /
                            (1.0 + natural * h * (params.damping + 0.25 * natural * h));
        value_ = start + h * mean_rate;
        rate_ = 2.0 * mean_rate - rate_;
        return params.kind == Memory::resonance ? S(0.5 * (start + value_)) : S(2.0 * params.damping * mean_rate / natural);
      }
      case Memory::play:
      case Memory::stop:
        stops_[0] = stop_after<S>(stops_[0], s - value_, params.width);
        value_ = s;
        return params.kind == Memory::stop ? stops_[0] : S(s - stops_[0]);
      case Memory::slew:
        value_ = value_ + clamp_symmetric<S>(s - value_, params.width * h);
        return value_;
      case Memory::hold:
        return held(params, begins ? value_of(params.phase) : 0.0, s, h);
      case Memory::quantise:
        return params.width * std::round(value_of(s) / value_of(params.width));
      case Memory::dead_zone:
        return s - clamp_symmetric<S>(s, params.width);
      case Memory::saturation:
        return clamp_symmetric<S>(s, params.width);
      case Memory::periodic:
        return s - params.width * std::round(value_of(s) / value_of(params.width));
      case Memory::oscillator: {
        using std::sin;
        const S advance = h * (params.frequency + s);
        const S middle = turns_ + 0.5 * advance;
        turns_ += advance - std::floor(value_of(turns_ + advance));
        return S(sin(2.0 * std::numbers::pi * middle + params.phase));
      }
      case Memory::odd_power:
        return sign_of<S>(s) * power_of(s, params);
      case Memory::even_power:
        return power_of(s, params);
    }
    return s;
  }

  /// Output of the stop operators of given widths.
  template <class Widths>
  const std::array<S, kMostStops>& stop(const Widths& widths, int count, const S& s) noexcept {
    start(s);
    const S change = s - value_;
    value_ = s;
    for (std::size_t k = 0; k < kMostStops; ++k) {
      if (static_cast<int>(k) < count) {
        stops_[k] = stop_after<S>(stops_[k], change, S(widths[k]));
      }
    }
    return stops_;
  }

 private:
  template <class Other>
  friend class MemoryState;

  static constexpr std::size_t kEarlier = 64;

  void start(const S& s) noexcept {
    if (!started_) {
      started_ = true;
      value_ = s;
      rate_ = S{0.0};
      turns_ = S{0.0};
      stops_.fill(S{0.0});
      earlier_.fill(s);
      since_ = 0.0;
      age_ = 0;
    }
  }

  /// width |s / width|^exponent, for |s| up to four widths and constant beyond. The bound keeps a plant finite if the power
  /// moves its own argument. Below 1e-9 of the width, the result and its derivatives are zero.
  static S power_of(const S& s, const MemoryParameters<S>& params) noexcept {
    using std::log;
    constexpr double kLeast = 1e-9;
    const S size = clamp_symmetric<S>(s * sign_of<S>(s) / params.width, S{kPowerLimit});
    return value_of(size) > kLeast ? S(params.width * exp(params.exponent * log(size))) : S{0.0};
  }

  /// The newest sample of the argument. A sample is due at a time between two arguments: its value is interpolated.
  S held(const MemoryParameters<S>& params, double phase, const S& s, double h) noexcept {
    const double time = value_of(params.time);
    const double turns = phase / (2.0 * std::numbers::pi);
    since_ += (turns - std::floor(turns)) * time;
    if (since_ >= time * (1.0 - 1e-9)) {
      since_ = std::clamp(since_ - time, 0.0, time);
      value_ = s + (earlier_[0] - s) * std::min(params.mean + since_ / h, 1.0);
    }
    since_ += h;
    earlier_[0] = s;
    return value_;
  }

  /// The argument `time` ago, between samples that are as many steps apart as the ring needs to reach so far.
  S delayed(const S& time, const S& s, double h) noexcept {
    const S steps = time / h;
    const int stride = 1 + static_cast<int>(value_of(steps) / (kEarlier - 3));
    age_ = age_ + 1;
    if (age_ >= stride) {
      age_ = 0;
      newest_ = (newest_ + 1) % kEarlier;
      earlier_[newest_] = s;
    }
    const S back = (steps - static_cast<double>(age_)) / static_cast<double>(stride);
    if (value_of(back) < 0.0) {
      return s + (earlier_[newest_] - s) * (steps / static_cast<double>(age_));
    }
    const auto whole = static_cast<std::size_t>(value_of(back));
    const S& later = earlier_[(newest_ + kEarlier - whole) % kEarlier];
    const S& older = earlier_[(newest_ + kEarlier - whole - 1) % kEarlier];
    return later + (older - later) * (back - static_cast<double>(whole));
  }

  bool started_ = false;
  S value_{0.0};
  S rate_{0.0};
  S turns_{0.0};  ///< of an oscillator, without whole ones
  std::array<S, kMostStops> stops_{};
  double since_ = 0.0;                 ///< the last sample of `hold` [s]
  std::array<S, kEarlier> earlier_{};  ///< arguments of a delay; the first, of a hold
  std::size_t newest_ = 0;
  int age_ = 0;  ///< of the newest of them, in steps
};

}  // namespace hotfire::model
