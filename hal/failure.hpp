#pragma once

#include <string>

namespace hotfire::hal {

/// Why a step of a set-up was refused by the machine, and what a person does about it.
struct Failure {
  std::string what;
  std::string mend;
};

}  // namespace hotfire::hal
