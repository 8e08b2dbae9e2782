// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "tools/interface/c/hotfire.h"
#include "tools/interface/plant/plant.hpp"

/// What is behind the handle of the C interface.
struct hotfire_model {  // NOLINT(readability-identifier-naming): the name is C
  explicit hotfire_model(std::unique_ptr<hotfire::plant::Plant> own);

  std::unique_ptr<hotfire::plant::Plant> plant;
  std::vector<double> wanted;               ///< room for the parameters of hotfire_set
  std::vector<hotfire::plant::Seed> seeds;  ///< room for those of hotfire_differentiate: every input and parameter twice
  std::array<char, 512> message{};
  bool started = false;
};

namespace hotfire::interface {

inline constexpr double kShortestPeriod = 1e-6;  ///< [s]
inline constexpr double kLongestPeriod = 1.0;    ///< [s]

/// What is wrong with a period [s]; empty if nothing.
std::string_view broken_period(double period);

/// Writes why a model could not be stepped. Apart from `step`, so that a step in the loop of a caller stays small.
hotfire_status refuse_step(hotfire_model& model) noexcept;

/// What hotfire_step does.
inline hotfire_status step(hotfire_model& model) noexcept {
  return model.started && model.plant->advance() ? HOTFIRE_OK : refuse_step(model);
}

/// Copies a text into a caller's buffer, cut to its size.
void copy_message(std::string_view text, char* message, std::size_t size) noexcept;

/// Runs `make()`, which gives a plant or throws, and wraps the result as a handle; a status with the sentence in `message`.
template <class Make>
hotfire_status open_with(Make&& make, hotfire_model** model, char* message, std::size_t size) noexcept {
  try {
    copy_message("", message, size);
    *model = new hotfire_model(make());
    return HOTFIRE_OK;
  } catch (const std::bad_alloc&) {
    copy_message("there is not enough memory for the model", message, size);
    return HOTFIRE_NO_MEMORY;
  } catch (const std::exception& error) {
    copy_message(error.what(), message, size);
    return HOTFIRE_BAD_DATA;
  }
}

/// Refuses an opening without one of its texts or without a place for the model, which is NULL otherwise.
inline hotfire_status check_opening(bool has_texts, hotfire_model** model, char* message, std::size_t size) noexcept {
  if (model != nullptr) {
    *model = nullptr;
  }
  if (model == nullptr || !has_texts) {
    copy_message("a path, a text, a name or the place for the model is NULL", message, size);
    return HOTFIRE_WRONG_USE;
  }
  return HOTFIRE_OK;
}

}  // namespace hotfire::interface
