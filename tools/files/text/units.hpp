// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

union cv_converter;

namespace hotfire {

/// A unit that is not known or not of the dimension wanted: what() names the unit, the dimension wanted and the remedy.
/// It has no place in a file: the reader of the unit adds file, line and key.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// True for the unit of a field that follows the record's own units ("", "force.time/position"): nothing converts to it.
bool follows_record(std::string_view unit);

/// Converts numbers of one unit into another by UDUNITS-2, which knows units by name, symbol, prefix and product.
///
/// Stricter than UDUNITS-2 where its rules would give a wrong number without a word:
/// - seconds do not convert to hertz (it would take the reciprocal);
/// - hertz do not convert to rad/s, nor back (it drops the radian, and the result is off by 2 pi), and a plain number is not
///   an angle;
/// - an exponent with a decimal point is refused (it reads "kg^-0.5" as a factor of 5).
///
/// `deg` and `gpm` are known beside the names of UDUNITS-2.
class UnitConverter {
 public:
  /// Throws UnitError. `value` only serves the message, which says what to write instead.
  UnitConverter(const std::string& unit, const std::string& wanted, double value = 1.0);

  double operator()(double value) const;

 private:
  struct Free {
    void operator()(cv_converter* converter) const noexcept;
  };
  std::unique_ptr<cv_converter, Free> converter_;  ///< null if both units are the same
};

/// `value` of `unit` in `wanted`. Throws UnitError.
double convert_unit(double value, const std::string& unit, const std::string& wanted);

/// The factor of a unit that is a product of powers of words, as the model's keys write it ("m^3/s/Pa", "kg^-0.5"), from the
/// factors of its words; none where one of its words has none.
std::optional<double> unit_product(std::string_view unit,
                                   const std::function<std::optional<double>(std::string_view)>& factor_of_word);

/// Throws UnitError unless UDUNITS-2 knows the unit.
void require_known_unit(const std::string& unit);

}  // namespace hotfire
