// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/written_record.hpp"

#include <fmt/format.h>

#include <iostream>

#include "tools/cli/shared/print_json.hpp"

namespace hotfire {

void print_written(const std::string& output, const Record& record, const std::vector<std::string>& notes, bool json) {
  if (json) {
    nlohmann::ordered_json channels = nlohmann::ordered_json::array();
    for (const Channel& channel : record.channels) {
      channels.push_back({{"name", channel.name}, {"unit", channel.unit}});
    }
    print_json({{"output", output},
                {"rows", record.rows},
                {"start", record.start},
                {"period", record.period},
                {"channels", channels},
                {"notes", notes}});
    return;
  }
  std::cout << fmt::format("{}: {} rows, period {:.6g} s,", output, record.rows, record.period);
  for (const Channel& channel : record.channels) {
    std::cout << ' ' << channel.name;
  }
  std::cout << '\n';
  for (const std::string& note : notes) {
    std::cout << note << '\n';
  }
}

}  // namespace hotfire
