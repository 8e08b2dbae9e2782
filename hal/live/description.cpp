// SPDX-License-Identifier: Apache-2.0
#include "hal/live/description.hpp"

#include <algorithm>
#include <charconv>

#include "hal/recording/header.hpp"

namespace hotfire::hal {
namespace {

/// Cuts what is before the first `end`, without it, off the text.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return taken;
}

void add(std::string& text, std::string_view key, const std::vector<LiveWordMeaning>& words) {
  for (const LiveWordMeaning& word : words) {
    text.append(key).append(" ").append(std::to_string(word.number)).append(" ").append(word.name);
    text.append("\t").append(word.meaning).append("\n");
  }
}

bool take_meaning(std::string_view line, std::vector<LiveWordMeaning>& words) {
  const std::string_view digits = take_until(line, ' ');
  LiveWordMeaning word;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), word.number);
  word.name = take_until(line, '\t');
  word.meaning = line;
  words.push_back(std::move(word));
  return error == std::errc{} && stop == digits.data() + digits.size() && !words.back().name.empty();
}

bool take(LiveDescription& description, std::string_view line) {
  const std::string_view key = take_until(line, ' ');
  if (key == "state") {
    return take_meaning(line, description.states);
  }
  if (key == "fault") {
    return take_meaning(line, description.faults);
  }
  if (key == "ending") {
    return take_meaning(line, description.endings);
  }
  if (key == "counter") {
    const std::string_view group = take_until(line, ' ');
    description.counters.push_back({std::string(group), std::string(line)});
    return !group.empty() && !line.empty();
  }
  return false;
}

}  // namespace

std::string description_text(const LiveDescription& description) {
  std::string text = header_text(description.header);
  add(text, "state", description.states);
  add(text, "fault", description.faults);
  add(text, "ending", description.endings);
  for (const LiveCounterName& counter : description.counters) {
    text.append("counter ").append(counter.group).append(" ").append(counter.name).append("\n");
  }
  return text;
}

ParsedDescription parse_description(std::string_view text) {
  ParsedHeader header = parse_header(text);
  ParsedDescription parsed{{std::move(header.header), {}, {}, {}, {}}, std::move(header.error)};
  if (!parsed.error.empty()) {
    return parsed;
  }
  for (std::string_view rest = text.substr(header.bytes); !rest.empty();) {
    const std::string_view line = take_until(rest, '\n');
    if (!take(parsed.description, line)) {
      parsed.error = "\"" + std::string(line.substr(0, 60)) + "\": unknown key, or a value that is not of its kind";
      return parsed;
    }
  }
  return parsed;
}

}  // namespace hotfire::hal
