#include "firmware/image_entries.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace hotfire::firmware {

double read_bounded(Entries& entries, const std::string& key, double lower, double upper, std::string_view unit) {
  const Entry* entry = entries.take(key);
  if (entry == nullptr) {
    return lower;
  }
  char* end = nullptr;
  const double value = std::strtod(entry->value.c_str(), &end);
  // Written so that NaN is refused as well.
  if (*end == '\0' && value >= lower && value <= upper) {
    return value;
  }
  const std::string shown(unit == "1" ? "" : unit);
  entries.refuse(*entry, text("allowed is a number from %g to %g %s", lower, upper, shown.c_str()));
  return lower;
}

ReadText read_image_text(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf())) {
    return {{}, path + ": cannot be read as an image: " + std::strerror(errno)};
  }
  return {content.str(), {}};
}

}  // namespace hotfire::firmware
