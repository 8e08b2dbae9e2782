// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/reference/realtime_help.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

std::string without_leading_spaces(const std::string& line) {
  const std::size_t start = line.find_first_not_of(' ');
  return start == std::string::npos ? "" : line.substr(start);
}

void append_with_space(std::string& text, const std::string& more) { text += (text.empty() ? "" : " ") + more; }

/// Two spaces, name, value, then the meaning in a column of its own.
RealtimeOption option_of(const std::string& line) {
  std::istringstream words(line);
  RealtimeOption option;
  words >> option.name;
  constexpr std::size_t kMeaningAt = 25;
  // A long name or value moves the column; its meaning is behind the first space from there on.
  const std::size_t end = line.find(' ', kMeaningAt - 1);
  const std::string head = line.substr(0, end);
  const std::size_t value_at = head.find(option.name) + option.name.size();
  option.value = without_leading_spaces(head.substr(value_at));
  option.value.erase(option.value.find_last_not_of(' ') + 1);
  option.meaning = end == std::string::npos ? "" : without_leading_spaces(line.substr(end));
  return option;
}

}  // namespace

RealtimeHelp parse_realtime_help(const std::string& text) {
  RealtimeHelp help;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      continue;
    }
    if (line.front() != ' ') {
      append_with_space(help.options.empty() ? help.introduction : help.ending, line);
    } else if (line.starts_with("  --help, --version")) {
      help.options.push_back({"--help", "", "print this help"});
      help.options.push_back({"--version", "", "print the version"});
    } else if (line.starts_with("  --")) {
      help.options.push_back(option_of(line));
    } else if (help.options.empty()) {
      help.examples.push_back(without_leading_spaces(line));
    } else {
      append_with_space(help.options.back().meaning, without_leading_spaces(line));
    }
  }
  return help;
}

RealtimeHelp realtime_help() {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "hotfire-rt";
  if (!std::filesystem::exists(program)) {
    throw UsageError(program + ": there is no such program; build or install hotfire-rt beside hotfire");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(("'" + program + "' --help").c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> block{};
  for (std::size_t got = 1; pipe && got > 0;) {
    got = std::fread(block.data(), 1, block.size(), pipe.get());
    text.append(block.data(), got);
  }
  return parse_realtime_help(text);
}

}  // namespace hotfire
