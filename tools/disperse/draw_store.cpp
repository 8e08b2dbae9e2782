// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/draw_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "tools/files/text/error.hpp"
#include "tools/files/text/sha256.hpp"

namespace hotfire::disperse {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kCheckDigits = 16;
constexpr std::string_view kEnding = ".draws";

std::string check_of(std::string_view text) { return sha256_of_text(text).substr(0, kCheckDigits); }

std::string line_of(const Json& content) {
  const std::string text = content.dump(-1, ' ', false, Json::error_handler_t::replace);
  return fmt::format("{} {}\n", check_of(text), text);
}

Json content_of(const DrawResult& result) {
  return {{"draw", result.draw},           {"model", result.model},   {"status", result.status},
          {"complaint", result.complaint}, {"result", result.result}, {"channels", result.channels}};
}

DrawResult result_of(const Json& content) {
  return {content.at("draw"),      content.at("model"),  content.at("status"),
          content.at("complaint"), content.at("result"), content.at("channels")};
}

/// The rest of a line whose check agrees.
Json checked(std::string_view line, const std::string& place) {
  const bool is_whole = line.size() > kCheckDigits + 1 && line[kCheckDigits] == ' ' &&
                        check_of(line.substr(kCheckDigits + 1)) == line.substr(0, kCheckDigits);
  Json content = is_whole ? Json::parse(line.substr(kCheckDigits + 1), nullptr, false) : Json(Json::value_t::discarded);
  if (content.is_discarded()) {
    throw FileError(
        fmt::format("{}: the line was changed since it was written; delete it, and its draw is run again", place));
  }
  return content;
}

/// Names what differs between the inputs of a file and those of this run.
void require_same_inputs(const Json& found, const Json& wanted, const std::string& place) {
  for (const auto& [key, value] : wanted.items()) {
    const Json own = found.is_object() && found.contains(key) ? found.at(key) : Json(nullptr);
    if (own != value) {
      throw FileError(fmt::format("{}: results of other inputs: {} was {}, now {}; give another --out, or remove the folder",
                                  place, key, own.dump(), value.dump()));
    }
  }
}

std::string content_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.good() && !file.eof()) {
    throw FileError(fmt::format("{}: cannot be read", path.string()));
  }
  // A line without an end is one that a kill has cut.
  text.resize(text.rfind('\n') + 1);
  return text;
}

[[noreturn]] void refuse_folder(const std::filesystem::path& path, const std::string& problem) {
  throw FileError(fmt::format("{}: {}; name a folder that can be written", path.string(), problem));
}

}  // namespace

DrawStore::DrawStore(const std::filesystem::path& folder, const Json& inputs, Share share)
    : file_(folder / fmt::format("share-{}-of-{}{}", share.index, share.count, kEnding)), header_(line_of(inputs)) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    refuse_folder(folder, failed.message());
  }
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    refuse_folder(file_, std::generic_category().message(errno));
  }
  try {
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      throw FileError(
          fmt::format("{}: another process works on this share; wait for it, or give another --out", file_.string()));
    }
    read_own_file();
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == kEnding && entry.path().filename() != file_.filename()) {
        read(content_of_file(entry.path()), entry.path().string(), From::folder);
      }
    }
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

DrawStore::~DrawStore() { close(descriptor_); }

void DrawStore::read_own_file() {
  const std::string text = content_of_file(file_);
  if (ftruncate(descriptor_, static_cast<off_t>(text.size())) != 0) {
    refuse_folder(file_, std::generic_category().message(errno));
  }
  if (text.empty()) {
    append(header_);
  } else {
    read(text, file_.string(), From::folder);
  }
}

void DrawStore::read(std::string_view text, const std::string& name, From from) {
  const Json wanted = Json::parse(header_.substr(kCheckDigits + 1));
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string place = fmt::format("{}:{}", name, number);
    const std::string_view line = text.substr(0, end);
    Json content = checked(line, place);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    // Files behind each other have a line of inputs each.
    if ((number == 1 && from != From::line) || !content.contains("draw")) {
      require_same_inputs(content, wanted, place);
      continue;
    }
    DrawResult result = result_of(content);
    const auto known = results_.find(result.draw);
    if (known != results_.end() && content_of(known->second) != content) {
      throw FileError(fmt::format("{}: draw {} has another result elsewhere in the folder; remove the folder and run again",
                                  place, result.draw));
    }
    if (known == results_.end() && from != From::folder) {
      append(std::string(line) + '\n');
    }
    results_[result.draw] = std::move(result);
  }
}

void DrawStore::append(const std::string& line) const {
  std::string_view left = line;
  while (!left.empty()) {
    const ssize_t written = write(descriptor_, left.data(), left.size());
    if (written < 0 && errno != EINTR) {
      throw FileError(fmt::format("{}: cannot be written: {}", file_.string(), std::generic_category().message(errno)));
    }
    left.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
}

void DrawStore::add(const DrawResult& result) {
  append(line_of(content_of(result)));
  results_[result.draw] = result;
}

void DrawStore::merge(std::string_view text, const std::string& name) { read(text, name, From::text); }

void DrawStore::merge_line(std::string_view line, const std::string& name) { read(line, name, From::line); }

std::string DrawStore::line(int draw) const { return line_of(content_of(results_.at(draw))); }

std::string DrawStore::text(Share share) const {
  std::string text = header_;
  for (const auto& [draw, result] : results_) {
    if (share.has(draw)) {
      text += line_of(content_of(result));
    }
  }
  return text;
}

}  // namespace hotfire::disperse
