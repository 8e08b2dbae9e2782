// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include "model/checks.hpp"
#include "model/key_text.hpp"

namespace hotfire::model {

/// One parameter of a plant in a program that reads no files: its full key and its value in SI, or the word of a law or
/// channel.
struct ImageEntry {
  std::string_view key;  ///< "effects.gimbal_friction.coulomb_torque"
  double value = 0.0;
  std::string_view word{};  ///< "lugre"
};

namespace detail {

// Not constexpr and never defined: the compiler names the one that it meets while it reads an image.
void image_has_another_key_here();
void image_value_is_outside_its_bounds();
void image_word_is_none_of_the_options();
void image_table_is_too_long_or_does_not_rise();
void image_has_keys_that_this_plant_does_not_read();

/// Fills the parameters that `visit_keys` shows it, from the entries in their order.
class ImageFiller {
 public:
  constexpr explicit ImageFiller(std::span<const ImageEntry> image) : image_(image) {}

  template <class Field, class S>
  constexpr void number(const KeyText& key, const Field& field, S& value) {
    value = S(bounded(take(key.view(), {}), field.lower, field.upper));
  }

  template <class E>
  constexpr bool effect(const KeyText& prefix, bool& active) {
    active = next_ < image_.size() && image_[next_].key.starts_with(prefix.view());
    return active;
  }

  template <class Options>
  constexpr void option(const KeyText& key, const Options& options, int& option) {
    option = option_named(options, take(key.view(), {}).word);
    if (option < 0) {
      image_word_is_none_of_the_options();
    }
  }

  template <class Field, class Table>
  constexpr void table(const KeyText& x_key, const KeyText& y_key, const Field& field, Table& table) {
    using S = std::remove_cvref_t<decltype(table.x[0])>;
    std::size_t points = 0;
    while (is_next(x_key.view())) {
      const KeyText index("", static_cast<int>(points), "");
      const double x = take(x_key.view(), index.view()).value;
      if (points == Table::kCapacity) {
        image_table_is_too_long_or_does_not_rise();
      }
      table.x[points] = S(x);
      if (!rises(table.x, points)) {
        image_table_is_too_long_or_does_not_rise();
      }
      table.y[points] = S(bounded(take(y_key.view(), index.view()), field.y_lower, field.y_upper));
      ++points;
    }
    table.points = static_cast<int>(points);
  }

  constexpr void finish() const {
    if (next_ != image_.size()) {
      image_has_keys_that_this_plant_does_not_read();
    }
  }

 private:
  /// True if the next entry is a point of the table with this key.
  constexpr bool is_next(std::string_view key) const {
    return next_ < image_.size() && image_[next_].key.size() > key.size() && image_[next_].key.starts_with(key) &&
           image_[next_].key[key.size()] == '.';
  }

  /// The next entry, whose key must be `key`, or `key.index`.
  constexpr const ImageEntry& take(std::string_view key, std::string_view index) {
    const bool fits = index.empty() ? next_ < image_.size() && image_[next_].key == key
                                    : is_next(key) && image_[next_].key.substr(key.size() + 1) == index;
    if (!fits) {
      image_has_another_key_here();
    }
    return image_[next_++];
  }

  static constexpr double bounded(const ImageEntry& entry, double lower, double upper) {
    if (!is_inside(entry.value, lower, upper)) {
      image_value_is_outside_its_bounds();
    }
    return entry.value;
  }

  std::span<const ImageEntry> image_;
  std::size_t next_ = 0;
};

}  // namespace detail

/// The parameters of a plant from the image that `hotfire header` writes, while the program is compiled: on the target they
/// are constants, and neither keys nor checks are left. The image has every parameter, and every parameter of an active
/// effect, in the order of the plant. The compiler refuses another key, order or law, a value outside its bounds, and an
/// effect that the list of the plant has not. Relations between parameters have been checked by `hotfire header`.
template <class Parameters>
consteval Parameters parameters_of(std::span<const ImageEntry> image) {
  Parameters parameters;
  detail::ImageFiller filler(image);
  visit_keys(parameters, filler);
  filler.finish();
  return parameters;
}

}  // namespace hotfire::model
