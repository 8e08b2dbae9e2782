// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <system_error>

#include "hal/linux/gpio_refusals.hpp"
#include "hal/linux/gpiod_lines.hpp"

namespace hotfire::hal {

std::optional<bool> is_simulated_gpio(const std::string& chip) {
  for (const std::string& place : places_of_chip(chip)) {
    const int file = open(place.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) {
      continue;
    }
    gpiochip_info info{};
    const bool known = ioctl(file, GPIO_GET_CHIPINFO_IOCTL, &info) == 0;
    close(file);
    if (known && (place == chip || chip == info.name || chip == info.label)) {
      return is_simulated_device(std::filesystem::path("/sys/bus/gpio/devices") / info.name);
    }
  }
  return std::nullopt;
}

bool is_simulated_device(const std::filesystem::path& device) {
  std::error_code failed;
  // The chip is a child of the device that its driver is bound to.
  const std::filesystem::path parent = std::filesystem::canonical(device, failed).parent_path();
  const std::filesystem::path driver = std::filesystem::read_symlink(parent / "driver", failed).filename();
  return !failed && (driver == "gpio-sim" || driver == "gpio-mockup");
}

}  // namespace hotfire::hal
