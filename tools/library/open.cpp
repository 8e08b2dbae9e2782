// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <mutex>
#include <string>

#include "tools/interface/c/hotfire.h"
#include "tools/interface/c/model_handle.hpp"
#include "tools/library/declared_plant.hpp"

namespace {

/// The caller's options, or the defaults. What is wrong with them is in `problem`.
hotfire_options options_or_default(const hotfire_options* given, std::string& problem) {
  hotfire_options options;
  hotfire_default_options(&options);
  if (given != nullptr) {
    if (given->size != sizeof options) {
      problem =
          fmt::format("options.size = {}: allowed: {}; fill it with hotfire_default_options", given->size, sizeof options);
      return options;
    }
    options = *given;
  }
  if (const std::string_view broken = hotfire::interface::broken_period(options.period); !broken.empty()) {
    problem = fmt::format("options.period = {}: {}", options.period, broken);
  }
  return options;
}

/// `read(options)` gives a declared plant. UDUNITS-2 has one state for all threads.
template <class Read>
hotfire_status open_read(const hotfire_options* given, Read&& read, hotfire_model** model, char* message, std::size_t size) {
  std::string problem;
  const hotfire_options options = options_or_default(given, problem);
  if (!problem.empty()) {
    hotfire::interface::copy_message(problem, message, size);
    return HOTFIRE_WRONG_USE;
  }
  return hotfire::interface::open_with(
      [&] {
        static std::mutex units;
        const std::lock_guard lock(units);
        const hotfire::DeclaredPlant declared = read(options);
        return hotfire::plant::make_plant(declared.parameters, declared.setup);
      },
      model, message, size);
}

}  // namespace

extern "C" {

hotfire_status hotfire_open(const char* path, const hotfire_options* options, hotfire_model** model, char* message,
                            size_t size) {
  const hotfire_status status = hotfire::interface::check_opening(path != nullptr, model, message, size);
  return status != HOTFIRE_OK
             ? status
             : open_read(
                   options, [&](const hotfire_options& own) { return hotfire::declared_plant(path, own.period, own.seed); },
                   model, message, size);
}

hotfire_status hotfire_open_text(const char* text, const char* name, const hotfire_options* options, hotfire_model** model,
                                 char* message, size_t size) {
  const hotfire_status status = hotfire::interface::check_opening(text != nullptr && name != nullptr, model, message, size);
  return status != HOTFIRE_OK ? status
                              : open_read(
                                    options,
                                    [&](const hotfire_options& own) {
                                      return hotfire::declared_plant(std::string(text), name, own.period, own.seed);
                                    },
                                    model, message, size);
}
}
