// SPDX-License-Identifier: Apache-2.0
#include "firmware/image/image_entries.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

namespace hotfire::firmware {
namespace {

constexpr std::size_t kLargestImage = std::size_t{64} << 20;  ///< a profile of half a million rows
constexpr std::size_t kImagePiece = 1 << 14;

}  // namespace

double read_bounded(Entries& entries, const std::string& key, double lower, double upper, std::string_view unit) {
  double value = lower;
  read_list(entries, key, lower, upper, unit, std::span(&value, 1));
  return value;
}

int read_whole(Entries& entries, const std::string& key, int least, int most) {
  const Entry* entry = entries.take(key);
  int value = least;
  if (entry == nullptr) {
    return value;
  }
  const char* const end = entry->value.data() + entry->value.size();
  const auto [stop, error] = std::from_chars(entry->value.data(), end, value);
  if (error != std::errc{} || stop != end || value < least || value > most) {
    entries.refuse(*entry, text("allowed is a whole number from %d to %d", least, most));
    return least;
  }
  return value;
}

void read_list(Entries& entries, const std::string& key, double lower, double upper, std::string_view unit,
               std::span<double> values) {
  const Entry* entry = entries.take(key);
  if (entry == nullptr) {
    return;
  }
  const char* next = entry->value.c_str();
  bool good = true;
  for (std::size_t i = 0; i < values.size() && good; ++i) {
    char* end = nullptr;
    const double value = std::strtod(next, &end);
    good = end != next && model::is_inside(value, lower, upper) && *end == (i + 1 < values.size() ? ',' : '\0');
    values[i] = good ? value : lower;
    next = end + 1;
  }
  if (!good) {
    const std::string many = values.size() == 1 ? "a number" : text("%zu numbers, commas between them,", values.size());
    const std::string shown(unit == "1" ? "" : unit);
    entries.refuse(*entry, text("allowed is %s from %g to %g %s", many.c_str(), lower, upper, shown.c_str()));
  }
}

ReadText read_image_text(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string content;
  for (std::size_t read = kImagePiece; file && read == kImagePiece && content.size() <= kLargestImage;) {
    const std::size_t before = content.size();
    content.resize(before + kImagePiece);
    file.read(content.data() + before, kImagePiece);
    read = static_cast<std::size_t>(file.gcount());
    content.resize(before + read);
  }
  if (!file.is_open() || errno != 0) {
    return {{}, path + ": cannot be read as an image: " + std::strerror(errno)};
  }
  if (content.size() > kLargestImage) {
    return {{}, path + text(":1: over %zu bytes; allowed: an image of at most so many", kLargestImage)};
  }
  return {content, {}};
}

}  // namespace hotfire::firmware
