// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <sstream>

#include "tools/doctor/doctor.hpp"
#include "tools/doctor/files.hpp"

namespace hotfire::doctor {

namespace {

/// What `gpioinfo` says of a line, in the format of libgpiod 1 or 2; empty if it has no such line.
std::string line_of(const std::string& info, const std::string& name) {
  std::istringstream lines(info);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.find("\"" + name + "\"") != std::string::npos || line.find("\t" + name + " ") != std::string::npos) {
      return line;
    }
  }
  return "";
}

Finding look_at_line(const std::string& info, const std::string& name) {
  const std::string line = line_of(info, name);
  if (line.empty()) {
    return {"line " + name, Level::bad, "no GPIO line has this name",
            "name one that `gpioinfo` lists, or give it the name in the device tree (gpio-line-names)"};
  }
  const bool used = line.find("[used]") != std::string::npos || line.find("consumer=") != std::string::npos;
  if (used) {
    return {"line " + name, Level::bad, "in use by another program", "end that program: gpioinfo names its consumer"};
  }
  return {"line " + name, Level::good, "there and free", ""};
}

}  // namespace

std::vector<Finding> look_at_gpio(const Patient& patient) {
  std::string chips;
  std::string refused;
  for (const std::string& name : names_in(patient.root / "dev")) {
    if (name.starts_with("gpiochip")) {
      chips += (chips.empty() ? "" : ", ") + name;
      if (access((patient.root / "dev" / name).c_str(), R_OK | W_OK) != 0) {
        refused += (refused.empty() ? "" : ", ") + name;
      }
    }
  }
  std::vector<Finding> findings;
  if (chips.empty()) {
    findings.push_back({"GPIO", patient.lines.empty() ? Level::advice : Level::bad, "no GPIO chip",
                        "load the chip's driver, or plug its adapter in; a plant without interlocks needs none"});
  } else if (!refused.empty()) {
    findings.push_back({"GPIO", Level::bad, "cannot be opened by this user: " + refused,
                        "echo 'SUBSYSTEM==\"gpio\", KERNEL==\"gpiochip*\", GROUP=\"realtime\", MODE=\"0660\"' > "
                        "/etc/udev/rules.d/99-gpio.rules && udevadm trigger"});
  } else {
    findings.push_back({"GPIO", Level::good, chips, ""});
  }
  if (!patient.lines.empty() && !chips.empty()) {
    const std::string info = patient.run("gpioinfo");
    if (info.empty()) {
      findings.push_back({"lines", Level::advice, "`gpioinfo` reported nothing", "apt install gpiod"});
      return findings;
    }
    for (const std::string& name : patient.lines) {
      findings.push_back(look_at_line(info, name));
    }
  }
  return findings;
}

}  // namespace hotfire::doctor
