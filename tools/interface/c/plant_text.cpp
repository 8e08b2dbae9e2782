// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/c/plant_text.hpp"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include "firmware/image/plant_image.hpp"
#include "tools/interface/c/hotfire.h"
#include "tools/interface/c/model_handle.hpp"

namespace hotfire::interface {

namespace {

/// Takes the lines of a text one by one.
class Lines {
 public:
  Lines(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  /// The value of the line that must be here, `key value`.
  std::string take(const std::string& key) {
    ++line_;
    const std::size_t end = text_.find('\n', at_);
    line_text_ = text_.substr(at_, end == std::string::npos ? end : end - at_);
    if (end == std::string::npos || !line_text_.starts_with(key + " ")) {
      refuse("expected `" + key + " value`: a plant text begins with period, seed and strings");
    }
    at_ = end + 1;
    return line_text_.substr(key.size() + 1);
  }

  [[noreturn]] void refuse(const std::string& problem) const {
    throw std::runtime_error(name_ + ": line " + std::to_string(line_) + ": " + line_text_.substr(0, 60) + ": " + problem);
  }

  std::string rest() const { return text_.substr(at_); }

 private:
  const std::string& text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::string line_text_;
};

}  // namespace

std::unique_ptr<plant::Plant> plant_of_text(const std::string& text, const std::string& name) {
  Lines lines(text, name);
  plant::Setup setup;
  const std::string period = lines.take("period");
  char* end = nullptr;
  setup.period = std::strtod(period.c_str(), &end);
  if (end == period.c_str() || *end != '\0' || !broken_period(setup.period).empty()) {
    lines.refuse("allowed: 1e-06 to 1 s");
  }
  const std::string seed = lines.take("seed");
  const unsigned long long number = std::strtoull(seed.c_str(), &end, 10);
  if (end == seed.c_str() || *end != '\0' || number > std::numeric_limits<std::uint32_t>::max()) {
    lines.refuse("allowed: a whole number from 0 to 4294967295");
  }
  setup.seed = static_cast<unsigned>(number);
  const std::string strings = lines.take("strings");
  if (strings != "yes" && strings != "no") {
    lines.refuse("allowed: yes, no");
  }
  setup.strings = strings == "yes";
  firmware::PlantImage image = firmware::parse_plant_image(lines.rest(), name);
  if (!image.parameters) {
    throw std::runtime_error(image.error);
  }
  if (!image.faults.empty()) {
    throw std::runtime_error(name + ": fault.0.kind: a plant text has no faults; remove them");
  }
  return plant::make_plant(*image.parameters, setup);
}

}  // namespace hotfire::interface

extern "C" {

const char* hotfire_version(void) { return HOTFIRE_VERSION; }

hotfire_status hotfire_open_plant(const char* text, const char* name, hotfire_model** model, char* message, size_t size) {
  using namespace hotfire::interface;
  const hotfire_status status = check_opening(text != nullptr && name != nullptr, model, message, size);
  return status != HOTFIRE_OK ? status : open_with([&] { return plant_of_text(text, name); }, model, message, size);
}
}
