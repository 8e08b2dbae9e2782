// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
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
  if (parsed.options->mode == hotfire::firmware::Mode::replay) {
    return hotfire::firmware::run_replay(parsed.options->recording, parsed.options->json);
  }
  return hotfire::firmware::run_session(*parsed.options);
}
