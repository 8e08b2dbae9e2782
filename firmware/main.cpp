// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "firmware/replay/replay.hpp"
#include "firmware/session/options.hpp"
#include "firmware/session/session.hpp"

int main(int count, char** values) {
  const auto parsed = hotfire::firmware::parse_options(std::vector<std::string>(values, values + count));
  if (!parsed.options) {
    std::fputs(parsed.message.c_str(), parsed.status == 0 ? stdout : stderr);
    return parsed.status;
  }
  return std::visit(
      []<class Own>(const Own& options) {
        if constexpr (std::is_same_v<Own, hotfire::firmware::ReplayOptions>) {
          return hotfire::firmware::run_replay(options.recording, options.json);
        } else {
          return hotfire::firmware::run(options);
        }
      },
      *parsed.options);
}
