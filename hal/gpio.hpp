// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hotfire::hal {

/// A line of a GPIO chip. Its level here is logical: true is active. An active-low line is active at zero voltage.
struct GpioInput {
  std::string line;  ///< the name the chip gives it
  bool active_low = false;
  bool edges = false;  ///< its changes are reported by `read_edges` too
};
struct GpioOutput {
  std::string line;
  bool active_low = false;
  bool safe = false;  ///< its level from the request on, and at the end
};

enum class GpioBias : std::uint8_t { as_is, pull_up, pull_down, disabled };

/// The lines that a program uses, of one chip; at most kMaxGpioLines each way.
struct GpioSettings {
  std::string chip;  ///< path, name or label: "/dev/gpiochip0", "gpiochip0", "rig"
  std::string consumer = "hotfire";
  std::vector<GpioInput> inputs;
  std::vector<GpioOutput> outputs;
  GpioBias bias = GpioBias::as_is;  ///< of the inputs. With pull_down a broken wire reads false
};
inline constexpr std::size_t kMaxGpioLines = 32;

/// A change of an input with `edges`.
struct GpioEdge {
  std::size_t input = 0;     ///< its place in the settings
  bool active = false;       ///< became so
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC, stamped by the kernel at the interrupt
};

/// Levels, bit i for the line i of the settings.
using GpioLevels = std::uint32_t;

/// The GPIO lines of a cyclic program.
///
/// - `try_read(levels)`: the inputs now. False, with `levels` unchanged, if they cannot be read: assume the worst levels
///   then.
/// - `try_write(levels)`: sets every output; false if they cannot be set.
/// - `read_edges(edges)`: returns the number of changes that it took, for each line the oldest first. Call it until it
///   returns less than its capacity. Never waits for a change.
/// - `lost_edges()`: changes that are known to be missing in the results of `read_edges`.
/// - Outputs have their safe level from the moment they are requested, and again when the object ends. After that the board
///   determines the level of a line: wire it so that inactive is safe.
///
/// All without allocation, lock or exception. On a chip behind I2C, SPI or USB the first two wait for its bus.
template <class G>
concept GpioLines = requires(G& lines, const G& seen, GpioLevels& levels, std::span<GpioEdge> edges) {
  { lines.try_read(levels) }
  noexcept->std::same_as<bool>;
  { lines.try_write(levels) }
  noexcept->std::same_as<bool>;
  { lines.read_edges(edges) }
  noexcept->std::same_as<std::size_t>;
  { seen.lost_edges() }
  noexcept->std::same_as<std::uint64_t>;
};

}  // namespace hotfire::hal
