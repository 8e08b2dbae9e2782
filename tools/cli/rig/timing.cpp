// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "tools/cli/rig/find_period.hpp"
#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

struct FindOptions {
  bool find = false;
  double seconds = PeriodSearch{}.seconds;
};

/// The search with the arguments of `timing`, which are passed on but for those that it sets itself.
PeriodSearch search_of(const std::vector<std::string>& arguments, double seconds) {
  constexpr std::array<std::string_view, 4> kOwn{"--period-us", "--cycles", "--max-overruns", "--policy"};
  PeriodSearch search;
  search.seconds = seconds;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string_view name = std::string_view(arguments[i]).substr(0, arguments[i].find('='));
    if (std::find(kOwn.begin(), kOwn.end(), name) != kOwn.end()) {
      throw UsageError(std::string(name) + " and --find exclude each other: the search sets it");
    }
    if (name == "--json") {
      search.json = true;
    } else {
      search.arguments.push_back(arguments[i]);
    }
  }
  return search;
}

}  // namespace

void add_timing(CLI::App& program) {
  const auto options = std::make_shared<FindOptions>();
  CLI::App* command = add_realtime_command(
      program, "timing", "Check the timing of this machine, with a verdict", TakesModel::optionally,
      [options](const std::vector<std::string>& arguments) {
        if (!options->find || asks_for_text_only(arguments)) {
          become_realtime_program(arguments);
        }
        if (const int status = find_shortest_period(search_of(arguments, options->seconds)); status != 0) {
          throw CLI::RuntimeError(status);
        }
      });
  command->add_flag("--find", options->find, "search the shortest period without an overrun");
  command->add_option("--seconds", options->seconds, "with --find: time at each period [s]")
      ->check(CLI::Range(0.1, 86400.0))
      ->needs("--find")
      ->capture_default_str();
}

}  // namespace hotfire
