// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "model/numerics/interpolation.hpp"

namespace hotfire::firmware {

/// Disturbances of a record that a plant applies. `torque` [N m] acts on the engine towards positive angles of an axis,
/// `force` [N] at the centre of its gimbal. `vibration` [rad/s] adds to the slip of its bearing. `thrust` [N] replaces the
/// declared one.
enum class RecordedKind : std::uint8_t { torque, force, vibration, thrust };
inline constexpr std::array<std::string_view, 4> kRecordedKinds{"torque", "force", "vibration", "thrust"};

/// One channel of a record.
struct RecordedLoad {
  RecordedKind kind = RecordedKind::torque;
  std::size_t place = 0;  ///< torque, vibration: axis; force: 3 x engine + direction; thrust: engine; all from 0
  std::vector<double> values{};
};

/// The disturbances of a record, row by row from the first cycle of the plant.
struct LoadRecord {
  double period = 0.0;  ///< of a row [s]
  std::vector<RecordedLoad> loads{};
};

/// The cycles of `period` [s] that a row lasts; nothing unless that is a whole number.
inline std::optional<int> cycles_per_row(double row_period, double period) noexcept {
  constexpr double kRounding = 1e-6;
  constexpr double kMost = 1e6;
  const double cycles = std::round(row_period / period);
  const bool is_whole = cycles >= 1.0 && cycles < kMost && std::abs(cycles * period - row_period) <= kRounding * row_period;
  return is_whole ? std::optional(static_cast<int>(cycles)) : std::nullopt;
}

/// Applies the disturbances of a record as `hotfire simulate` does. Between rows a thrust is held and the others are
/// interpolated (`model::Interpolation`). A plant step gets the mean over its part of the row. After the last row the thrust
/// is the declared one, and the others are zero.
///
/// All values are in memory before the first cycle. A cycle costs the same for any record.
class RecordedLoads {
 public:
  /// `period` [s] of a cycle, and the plant steps in it. Applies nothing if a row does not last a whole number of cycles:
  /// such a record is refused before (`cycles_per_row`).
  RecordedLoads(LoadRecord record, double period, int steps) : steps_(static_cast<std::uint64_t>(steps)) {
    const std::optional<int> cycles = cycles_per_row(record.period, period);
    cycles_ = static_cast<std::uint64_t>(cycles.value_or(1));
    for (RecordedLoad& load : record.loads) {
      if (cycles && !load.values.empty()) {
        signals_.emplace_back(std::move(load), *cycles * steps);
      }
    }
  }

  bool any() const noexcept { return !signals_.empty(); }

  /// Calls `act(kind, place, value)` for each disturbance in a plant step of a cycle, both counted from 0. Real-time.
  template <class Act>
  void act_in(std::uint64_t cycle, int step, Act&& act) const noexcept {
    const std::uint64_t row = cycle / cycles_;
    const std::size_t part = static_cast<std::size_t>(cycle % cycles_ * steps_) + static_cast<std::size_t>(step);
    for (const Signal& signal : signals_) {
      const bool lasts = row < signal.load.values.size();
      if (signal.load.kind != RecordedKind::thrust) {
        act(signal.load.kind, signal.load.place, lasts ? signal.mean(static_cast<std::size_t>(row), part) : 0.0);
      } else if (lasts) {
        act(signal.load.kind, signal.load.place, signal.load.values[static_cast<std::size_t>(row)]);
      }
    }
  }

 private:
  struct Signal {
    /// `parts` plant steps a row.
    Signal(RecordedLoad one, int parts) : load(std::move(one)), interpolation(load.values) {
      for (int part = 0; part < parts; ++part) {
        weights.push_back(
            interpolation.mean_weights(static_cast<double>(part) / parts, static_cast<double>(part + 1) / parts));
      }
    }

    double mean(std::size_t row, std::size_t part) const noexcept {
      return interpolation.mean(load.values, row, weights[part]);
    }

    RecordedLoad load;
    model::Interpolation interpolation;
    std::vector<model::Interpolation::Weights> weights{};
  };

  std::uint64_t cycles_ = 1;  ///< of a row
  std::uint64_t steps_;       ///< of a cycle
  std::vector<Signal> signals_;
};

}  // namespace hotfire::firmware
