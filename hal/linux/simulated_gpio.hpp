// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace hotfire::hal {

/// Whether the driver of a GPIO chip only simulates it (gpio-sim, gpio-mockup): its lines move nothing. Nothing if there is
/// no such chip that may be opened. By path, name or label, as `GpiodLines` takes it.
std::optional<bool> is_simulated_gpio(const std::string& chip);

/// The same of a chip's folder below /sys/bus/gpio/devices.
bool is_simulated_device(const std::filesystem::path& device);

}  // namespace hotfire::hal
