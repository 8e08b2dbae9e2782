// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/gpiod_lines.hpp"

#include <CppUTest/TestHarness.h>

#include <unistd.h>

#include <filesystem>
#include <string>

namespace hotfire::hal {

namespace {

/// A chip as sysfs shows it: a link to a folder below the device, whose driver is a link too.
std::filesystem::path chip_of_driver(const std::filesystem::path& folder, const std::string& driver) {
  const std::filesystem::path device = folder / "devices" / driver;
  std::filesystem::create_directories(device / "gpiochip3");
  std::filesystem::create_directories(folder / "drivers" / driver);
  std::filesystem::create_directory_symlink(folder / "drivers" / driver, device / "driver");
  const std::filesystem::path chip = folder / ("chip-of-" + driver);
  std::filesystem::create_directory_symlink(device / "gpiochip3", chip);
  return chip;
}

}  // namespace

TEST_GROUP(SimulatedGpio) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hotfire-simulated-gpio-" + std::to_string(getpid()));

  void teardown() override { std::filesystem::remove_all(folder); }
};

TEST(SimulatedGpio, ChipIsSimulatedIfItsDriverIsOneThatOnlySimulates) {
  CHECK(is_simulated_device(chip_of_driver(folder, "gpio-sim")));
  CHECK(is_simulated_device(chip_of_driver(folder, "gpio-mockup")));
  CHECK(!is_simulated_device(chip_of_driver(folder, "pca953x")));
}

TEST(SimulatedGpio, ChipWithoutADriverOrThatIsNotThereIsNotSimulated) {
  std::filesystem::create_directories(folder / "device" / "gpiochip0");
  CHECK(!is_simulated_device(folder / "device" / "gpiochip0"));
  CHECK(!is_simulated_device(folder / "none"));
  CHECK(!is_simulated_gpio("/dev/no-gpiochip").has_value());
}

}  // namespace hotfire::hal
