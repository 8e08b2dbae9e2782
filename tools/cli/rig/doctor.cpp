// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

using doctor::Finding;
using doctor::Level;
using Json = nlohmann::ordered_json;

constexpr std::string_view name_of(Level level) {
  return level == Level::good ? "good" : level == Level::advice ? "advice" : "BAD";
}

/// A name of an interface or a line becomes a word of a command.
void require_plain(const std::vector<std::string>& names, const std::string& option) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.:-";
  for (const std::string& name : names) {
    if (name.empty() || name.find_first_not_of(kAllowed) != std::string::npos) {
      throw UsageError(fmt::format("{} \"{}\": allowed are letters, digits and _.:-", option, name));
    }
  }
}

void examine(doctor::Patient patient, bool as_json) {
  require_plain(patient.can, "--can");
  require_plain(patient.lines, "--line");
  patient.run = doctor::run_command;
  const std::vector<Finding> findings = doctor::look(patient);
  const auto count = [&](Level level) {
    return std::count_if(findings.begin(), findings.end(), [level](const Finding& f) { return f.level == level; });
  };
  const bool good = count(Level::bad) == 0;
  if (as_json) {
    Json list = Json::array();
    for (const Finding& finding : findings) {
      list.push_back({{"check", finding.check},
                      {"level", finding.level == Level::bad ? "bad" : name_of(finding.level)},
                      {"what", finding.what},
                      {"remedy", finding.remedy}});
    }
    const Json result{{"verdict", good ? "good" : "bad"}, {"findings", list}};
    print_json(result);
  } else {
    for (const Finding& finding : findings) {
      std::cout << fmt::format("{:<6}  {:<16} {}\n", name_of(finding.level), finding.check, finding.what);
      if (!finding.remedy.empty()) {
        std::cout << fmt::format("{:<25}remedy: {}\n", "", finding.remedy);
      }
    }
    std::cout << fmt::format("\nverdict: {} ({} bad, {} to consider)\n", good ? "good" : "BAD", count(Level::bad),
                             count(Level::advice));
  }
  if (!good) {
    throw CLI::RuntimeError(static_cast<int>(ExitStatus::bad_verdict));
  }
}

}  // namespace

void add_doctor(CLI::App& program) {
  struct Options {
    doctor::Patient patient;
    std::string root = "/";
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("doctor", "Check that this machine is fit for a real-time run; each finding has a remedy");
  command->add_option("--cpu", options->patient.cpu, "CPU on which the loop will run")->check(CLI::Range(0, 1023));
  command->add_option("--can", options->patient.can, "CAN interface that must exist; default: all are checked");
  command->add_option("--line", options->patient.lines, "name of a GPIO line that must exist");
  command->add_option("--root", options->root, "folder to check instead of /, such as a mounted image")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--json", options->json, "print the findings as JSON");
  command->footer(
      "Example: hotfire doctor --cpu 1 --can can0 --line estop\nExit status: 0 no check failed (advice is "
      "not a failure), 1 a check failed.");
  command->callback([options] {
    options->patient.root = options->root;
    examine(options->patient, options->json);
  });
}

}  // namespace hotfire
