// SPDX-License-Identifier: Apache-2.0
#include "tests/doctor/patient.hpp"

namespace hotfire::doctor {

using test::expect_good;
using test::expect_remedy;

TEST_GROUP(DoctorGpio) {
  test::PatientFiles files;
  Patient patient = files.patient();

  void setup() override {
    files.put("dev/gpiochip0", "");
    // libgpiod 1.6 prints the first two lines so, libgpiod 2 the others.
    files.said["gpioinfo"] =
        "gpiochip0 - 8 lines:\n\tline   0:      \"estop\"       unused   input  active-high \n"
        "\tline   1:     \"enable\" \"plant\"  output  active-high [used]\n"
        "\tline   2:\t\"arm\"           \tinput\n\tline   3:\t\"fault\"         \toutput consumer=\"plant\"\n";
  }

  Finding found(const char* check) const { return test::finding_of(look_at_gpio(patient), check); }
};

TEST(DoctorGpio, ChipsThatMayBeUsedAreGood) { expect_good(found("GPIO")); }

TEST(DoctorGpio, MachineWithoutAChipIsBadOnlyIfLinesAreNeeded) {
  std::filesystem::remove(patient.root / "dev/gpiochip0");
  expect_remedy(found("GPIO"), Level::advice, "no GPIO chip", "driver");
  patient.lines = {"estop"};
  expect_remedy(found("GPIO"), Level::bad, "no GPIO chip", "driver");
}

// A link to nowhere stands for a chip that this user may not open: the tests run as root too, who may open all that is
// there.
TEST(DoctorGpio, ChipThatCannotBeOpenedIsBad) {
  std::filesystem::create_symlink("nowhere", patient.root / "dev/gpiochip1");
  expect_remedy(found("GPIO"), Level::bad, "cannot be opened by this user: gpiochip1", "udev/rules.d/99-gpio.rules");
}

TEST(DoctorGpio, LineThatIsThereAndFreeIsGoodInBothFormatsOfGpioinfo) {
  patient.lines = {"estop", "arm"};
  expect_good(found("line estop"));
  expect_good(found("line arm"));
}

TEST(DoctorGpio, LineInUseOrMissingIsBad) {
  patient.lines = {"enable", "fault", "stop"};
  expect_remedy(found("line enable"), Level::bad, "in use by another program", "gpioinfo");
  expect_remedy(found("line fault"), Level::bad, "in use by another program", "gpioinfo");
  expect_remedy(found("line stop"), Level::bad, "no GPIO line has this name", "gpio-line-names");
}

TEST(DoctorGpio, MachineWithoutGpioinfoIsAdvisedToInstallIt) {
  patient.lines = {"estop"};
  files.said.clear();
  expect_remedy(found("lines"), Level::advice, "reported nothing", "apt install gpiod");
}

}  // namespace hotfire::doctor
