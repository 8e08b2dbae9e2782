// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/reference/realtime_help.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

std::string without_leading_spaces(const std::string& line) {
  const std::size_t start = line.find_first_not_of(' ');
  return start == std::string::npos ? "" : line.substr(start);
}

void append_with_space(std::string& text, const std::string& more) { text += (text.empty() ? "" : " ") + more; }

/// Two spaces, name, value, then the meaning in a column of its own, behind two spaces or from its place on.
RealtimeOption option_of(const std::string& line) {
  constexpr std::size_t kMeaningAt = 30;
  std::string head = line.substr(0, kMeaningAt);
  RealtimeOption option;
  option.meaning = line.size() > kMeaningAt ? line.substr(kMeaningAt) : "";
  head.erase(head.find_last_not_of(' ') + 1);
  std::istringstream(head) >> option.name;
  option.value = without_leading_spaces(head.substr(head.find(option.name) + option.name.size()));
  return option;
}

}  // namespace

RealtimeHelp parse_realtime_help(const std::string& text) {
  constexpr std::string_view kUsage = "Usage: ";
  RealtimeHelp help;
  bool in_examples = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kUsage)) {
      help.usage = line.substr(kUsage.size());
    } else if (line.starts_with("  --")) {
      help.options.push_back(option_of(line));
    } else if (line.starts_with(' ') && !help.options.empty()) {
      append_with_space(help.options.back().meaning, without_leading_spaces(line));
    } else if (line.starts_with(' ') && in_examples) {
      help.examples.push_back(without_leading_spaces(line));
    } else if (line.ends_with(':')) {
      in_examples = line == "Examples:";
    } else if (!line.empty() && !line.starts_with(' ')) {
      append_with_space(help.options.empty() ? help.introduction : help.ending, line);
    }
  }
  return help;
}

RealtimeHelp realtime_help(const std::string& mode) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "hotfire-rt";
  if (!std::filesystem::exists(program)) {
    throw UsageError(program + ": the program does not exist; build or install hotfire-rt beside hotfire");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(("'" + program + "' " + mode + " --help").c_str(), "r"),
                                                             pclose);
  std::string text;
  std::array<char, 4096> block{};
  for (std::size_t got = 1; pipe && got > 0;) {
    got = std::fread(block.data(), 1, block.size(), pipe.get());
    text.append(block.data(), got);
  }
  return parse_realtime_help(text);
}

}  // namespace hotfire
