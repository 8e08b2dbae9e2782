// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "hal/gpio.hpp"

namespace hotfire::hal::sim {

/// Lines within the process (`GpioLines`): a test sets the inputs and reads the outputs. Edges beyond kMaxEdges are lost and
/// counted, as those of a kernel are.
class GpioBoard {
 public:
  static constexpr std::size_t kMaxEdges = 16;

  explicit GpioBoard(GpioSettings settings) : settings_(std::move(settings)) { outputs_ = safe_levels(); }

  bool try_read(GpioLevels& levels) noexcept {
    if (!broken_) {
      levels = inputs_;
    }
    return !broken_;
  }

  bool try_write(GpioLevels levels) noexcept {
    if (!broken_) {
      outputs_ = levels;
    }
    return !broken_;
  }

  std::size_t read_edges(std::span<GpioEdge> edges) noexcept {
    const std::size_t taken = std::min(edges.size(), waiting_);
    std::copy_n(edges_.begin(), taken, edges.begin());
    std::copy(edges_.begin() + taken, edges_.begin() + waiting_, edges_.begin());
    waiting_ -= taken;
    return taken;
  }

  std::uint64_t lost_edges() const noexcept { return lost_; }

  /// The world changes the level of an input.
  void drive(std::size_t input, bool active, std::int64_t time_ns = 0) noexcept {
    const GpioLevels bit = GpioLevels{1} << input;
    const bool changes = ((inputs_ & bit) != 0) != active;
    inputs_ ^= changes ? bit : 0;
    if (!changes || !settings_.inputs[input].edges) {
      return;
    }
    if (waiting_ == kMaxEdges) {
      ++lost_;
    } else {
      edges_[waiting_++] = {input, active, time_ns};
    }
  }

  /// The chip no longer answers.
  void set_broken(bool broken) noexcept { broken_ = broken; }

  GpioLevels outputs() const noexcept { return outputs_; }

 private:
  GpioLevels safe_levels() const noexcept {
    GpioLevels levels = 0;
    for (std::size_t i = 0; i < settings_.outputs.size(); ++i) {
      levels |= settings_.outputs[i].safe ? GpioLevels{1} << i : 0;
    }
    return levels;
  }

  GpioSettings settings_;
  GpioLevels inputs_ = 0;
  GpioLevels outputs_ = 0;
  std::array<GpioEdge, kMaxEdges> edges_{};
  std::size_t waiting_ = 0;
  std::uint64_t lost_ = 0;
  bool broken_ = false;
};

static_assert(GpioLines<GpioBoard>);

}  // namespace hotfire::hal::sim
