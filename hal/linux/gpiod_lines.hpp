// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/failure.hpp"
#include "hal/gpio.hpp"

namespace hotfire::hal {

/// Lines of a GPIO chip through libgpiod (`GpioLines`): gpiod_v1.cpp or gpiod_v2.cpp, by the version of the library.
///
/// Outputs, and inputs without edges, are one request and one system call each. With version 1 of the library an input with
/// edges is a request and a call of its own, and edges that the kernel's queue of 16 loses are not noticed; with version 2
/// all inputs are one request, and the kernel numbers its edges.
class GpiodLines {
 public:
  explicit GpiodLines(GpioSettings settings);
  ~GpiodLines();
  GpiodLines(const GpiodLines&) = delete;
  GpiodLines& operator=(const GpiodLines&) = delete;

  /// Requests the lines. Nothing is driven unless the chip and every line exist and are free. Call it once.
  std::optional<Failure> open() noexcept;

  bool try_read(GpioLevels& levels) noexcept;
  bool try_write(GpioLevels levels) noexcept;
  std::size_t read_edges(std::span<GpioEdge> edges) noexcept;
  std::uint64_t lost_edges() const noexcept;

 private:
  struct Request;  ///< what the version of the library needs

  GpioSettings settings_;
  std::unique_ptr<Request> request_;
};

static_assert(GpioLines<GpiodLines>);

/// Whether the driver of a GPIO chip only simulates it (gpio-sim, gpio-mockup): its lines move nothing. No value if no such
/// chip can be opened. By path, name or label, as in `GpiodLines`.
std::optional<bool> is_simulated_gpio(const std::string& chip);

/// The same for a chip's folder below /sys/bus/gpio/devices.
bool is_simulated_device(const std::filesystem::path& device);

}  // namespace hotfire::hal
