// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <memory>

#include "tools/doctor/doctor.hpp"

namespace hotfire::doctor {

std::string run_command(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen((command + " 2>/dev/null").c_str(), "r"), pclose);
  std::string output;
  std::array<char, 4096> block{};
  for (std::size_t got = 1; pipe && got > 0;) {
    got = std::fread(block.data(), 1, block.size(), pipe.get());
    output.append(block.data(), got);
  }
  return output;
}

}  // namespace hotfire::doctor
