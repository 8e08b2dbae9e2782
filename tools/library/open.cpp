// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <mutex>
#include <string>

#include "tools/files/text/error.hpp"
#include "tools/interface/c/hotfire.h"
#include "tools/interface/c/model_handle.hpp"
#include "tools/library/declared_plant.hpp"

namespace {

hotfire_options options_or_default(const hotfire_options* given) {
  hotfire_options options;
  hotfire_default_options(&options);
  if (given != nullptr) {
    if (given->size != sizeof options) {
      throw hotfire::UsageError(
          fmt::format("options.size = {}: allowed: {}; fill it with hotfire_default_options", given->size, sizeof options));
    }
    options = *given;
  }
  if (const std::string_view broken = hotfire::interface::broken_period(options.period); !broken.empty()) {
    throw hotfire::UsageError(fmt::format("options.period = {}: {}", options.period, broken));
  }
  return options;
}

/// `read(options)` gives a declared plant. UDUNITS-2 has one state for all threads.
template <class Read>
hotfire_model* open_read(const hotfire_options* given, Read&& read, char* message, std::size_t size) {
  return hotfire::interface::open_with(
      [&] {
        const hotfire_options options = options_or_default(given);
        static std::mutex units;
        const std::lock_guard lock(units);
        const hotfire::DeclaredPlant declared = read(options);
        return hotfire::plant::make_plant(declared.parameters, declared.setup);
      },
      message, size);
}

}  // namespace

extern "C" {

hotfire_model* hotfire_open(const char* path, const hotfire_options* options, char* message, size_t size) {
  return open_read(
      options, [&](const hotfire_options& own) { return hotfire::declared_plant(path, own.period, own.seed); }, message,
      size);
}

hotfire_model* hotfire_open_text(const char* text, const char* name, const hotfire_options* options, char* message,
                                 size_t size) {
  return open_read(
      options,
      [&](const hotfire_options& own) { return hotfire::declared_plant(std::string(text), name, own.period, own.seed); },
      message, size);
}
}
