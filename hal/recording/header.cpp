// SPDX-License-Identifier: Apache-2.0
#include "hal/recording/header.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "hal/plant_bus.hpp"

namespace hotfire::hal {
namespace {

std::string hexadecimal(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%a", value);
  return digits;
}

std::string hexadecimal(std::uint64_t value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
  return digits;
}

/// One line a value, whatever a host or a shell put into it.
std::string on_one_line(std::string value) {
  std::replace_if(
      value.begin(), value.end(), [](char letter) { return static_cast<unsigned char>(letter) < 0x20; }, ' ');
  return value;
}

/// Cuts the first line, without its end, off the text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

RecordedChannel channel_of(std::string_view value) {
  const std::size_t space = std::min(value.find(' '), value.size());
  return {std::string(value.substr(0, space)), std::string(value.substr(std::min(space + 1, value.size())))};
}

template <class Integer>
bool read_integer(std::string_view value, Integer& result) {
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, result);
  return error == std::errc{} && stop == end;
}

bool read_double(const std::string& value, double& result) {
  char* end = nullptr;
  result = std::strtod(value.c_str(), &end);
  return !value.empty() && *end == '\0';
}

/// Of the line that says what all lines before it hash to.
constexpr std::string_view kHashKey = "\nheader_hash ";

std::string hash_of(std::string_view text) {
  Fnv1a hash;
  hash.add(std::as_bytes(std::span(text)));
  return hexadecimal(hash.value());
}

/// Takes one line into the header; false if its value is not of its kind.
bool take(RecordingHeader& header, std::string_view key, std::string_view value, std::string& hash) {
  const std::string text(value);
  if (key == "period_ns") {
    return read_integer(value, header.period_ns);
  }
  if (key == "steps_per_cycle") {
    return read_integer(value, header.steps_per_cycle);
  }
  if (key == "actuators") {
    return read_integer(value, header.actuators);
  }
  if (key == "start") {
    return read_double(text, header.start.emplace_back());
  }
  if (key == "input") {
    header.input = channel_of(value);
  } else if (key == "channel") {
    header.channels.push_back(channel_of(value));
  } else if (key == "model") {
    header.model += text + "\n";
  } else if (key == "model_hash") {
    hash = text;
  } else {
    const std::pair<std::string_view, std::string*> texts[] = {
        {"version", &header.version}, {"started", &header.started},   {"host", &header.host},
        {"kernel", &header.kernel},   {"topology", &header.topology}, {"command_line", &header.command_line}};
    const auto* const found =
        std::find_if(std::begin(texts), std::end(texts), [&](const auto& entry) { return entry.first == key; });
    if (found == std::end(texts)) {
      return false;
    }
    *found->second = text;
  }
  return true;
}

std::string what_is_wrong(const RecordingHeader& header, const std::string& hash) {
  if (header.period_ns <= 0 || header.actuators == 0 || header.actuators > kMaxActuators || header.channels.empty() ||
      header.channels.size() > kMostRecordedChannels || header.input.name.empty()) {
    return "period_ns, actuators, input or channel is missing in its header, or there are more of them than a plant can "
           "have";
  }
  if (header.start.size() != header.channels.size() * header.actuators) {
    return "its header has not one line `start` for every reading";
  }
  if (hash != hexadecimal(model_hash(header.model))) {
    return "the model in its header is not the one it was written with";
  }
  return {};
}

/// Whether the lines, which end with the one of the hash, are those that were written; they lose that line.
bool take_hash(std::string_view& lines, std::string_view text) {
  const std::size_t at = lines.rfind(kHashKey);
  if (at == std::string_view::npos) {
    return false;
  }
  const std::string_view before = text.substr(0, static_cast<std::size_t>(lines.data() - text.data()) + at + 1);
  const std::string_view given = lines.substr(at + kHashKey.size());
  lines = lines.substr(0, at + 1);
  return given == hash_of(before) + "\n";
}

}  // namespace

std::uint64_t model_hash(std::string_view model) {
  Fnv1a hash;
  hash.add(std::as_bytes(std::span(model)));
  return hash.value();
}

std::string header_text(const RecordingHeader& header) {
  std::string text(kRecordingMark);
  const auto add = [&text](std::string_view key, const std::string& value) {
    text.append(key).append(" ").append(on_one_line(value)).append("\n");
  };
  add("version", header.version);
  add("started", header.started);
  add("host", header.host);
  add("kernel", header.kernel);
  add("command_line", header.command_line);
  add("topology", header.topology);
  add("period_ns", std::to_string(header.period_ns));
  add("steps_per_cycle", std::to_string(header.steps_per_cycle));
  add("actuators", std::to_string(header.actuators));
  add("input", header.input.name + " " + header.input.unit);
  for (const RecordedChannel& channel : header.channels) {
    add("channel", channel.name + " " + channel.unit);
  }
  for (const double value : header.start) {
    add("start", hexadecimal(value));
  }
  add("model_hash", hexadecimal(model_hash(header.model)));
  for (std::string_view rest = header.model; !rest.empty();) {
    add("model", std::string(take_line(rest)));
  }
  add(kHashKey.substr(1, kHashKey.size() - 2), hash_of(text));
  return text.append(kLastHeaderLine.substr(1));
}

ParsedHeader parse_header(std::string_view text) {
  if (!text.starts_with(kRecordingMark)) {
    return {{}, 0, "line 1: it does not begin with `hotfire recording 2`: it is not a recording, or it has another version"};
  }
  const std::size_t last = text.substr(0, kLongestHeader).find(kLastHeaderLine);
  if (last == std::string_view::npos) {
    return text.size() < kLongestHeader
               ? ParsedHeader{{}, 0, "its header has no end: the file is cut off"}
               : ParsedHeader{{}, 0, "its header has no end within " + std::to_string(kLongestHeader) + " bytes"};
  }
  ParsedHeader parsed;
  parsed.bytes = last + kLastHeaderLine.size();
  std::string_view lines = text.substr(kRecordingMark.size(), last + 1 - kRecordingMark.size());
  if (!take_hash(lines, text)) {
    parsed.error = "its header is damaged: it does not agree with its line `header_hash`";
    return parsed;
  }
  std::string hash;
  for (int number = 2; !lines.empty(); ++number) {
    const std::string_view line = take_line(lines);
    const std::size_t space = std::min(line.find(' '), line.size());
    if (!take(parsed.header, line.substr(0, space), line.substr(std::min(space + 1, line.size())), hash)) {
      parsed.error = "line " + std::to_string(number) + ": \"" + std::string(line.substr(0, 60)) +
                     "\": unknown key, or a value that is not of its kind";
      return parsed;
    }
  }
  parsed.error = what_is_wrong(parsed.header, hash);
  return parsed;
}

}  // namespace hotfire::hal
