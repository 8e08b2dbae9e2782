// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace hotfire {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const noexcept { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

struct FreeSystem {
  void operator()(ut_system* system) const noexcept { ut_free_system(system); }
};
using System = std::unique_ptr<ut_system, FreeSystem>;

System read_system() {
  ut_set_error_message_handler(ut_ignore);
  System system{ut_read_xml(nullptr)};
  if (!system) {
    throw UnitError("the unit database of UDUNITS-2 cannot be read: install libudunits2-data");
  }
  constexpr std::array<std::pair<const char*, const char*>, 2> kAliases{{{"deg", "arc_degree"}, {"gpm", "gallon/minute"}}};
  for (const auto& [alias, meaning] : kAliases) {
    const Unit unit{ut_parse(system.get(), meaning, UT_UTF8)};
    ut_map_name_to_unit(alias, UT_UTF8, unit.get());
  }
  return system;
}

ut_system* unit_system() {
  static const System system = read_system();
  return system.get();
}

/// UDUNITS-2 has whole exponents only and would read the digits after the point as a factor.
bool has_fractional_exponent(std::string_view unit) {
  bool inside_exponent = false;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const auto letter = static_cast<unsigned char>(unit[i]);
    const bool digit = std::isdigit(letter) != 0;
    if (inside_exponent && letter == '.' && i + 1 < unit.size() &&
        std::isdigit(static_cast<unsigned char>(unit[i + 1])) != 0) {
      return true;
    }
    const bool sign = letter == '+' || letter == '-';
    inside_exponent = std::isalpha(letter) != 0 || letter == '^' || (inside_exponent && (digit || sign));
  }
  return false;
}

Unit parse(const std::string& text) {
  if (has_fractional_exponent(text)) {
    throw UnitError(fmt::format("unit \"{}\" has an exponent with a decimal point, which cannot be converted", text));
  }
  Unit unit{text.empty() ? nullptr : ut_parse(unit_system(), text.c_str(), UT_UTF8)};
  if (!unit) {
    throw UnitError(fmt::format("unit \"{}\" is not known to UDUNITS-2 (write \"1\" for a number without unit)", text));
  }
  return unit;
}

std::string definition(const ut_unit* unit) {
  std::array<char, 256> buffer{};
  return ut_format(unit, buffer.data(), buffer.size() - 1, UT_ASCII | UT_DEFINITION) < 0 ? std::string{} : buffer.data();
}

bool has_radian(const ut_unit* unit) { return definition(unit).find("rad") != std::string::npos; }

/// True if `unit` is an angle, a plain number or either of them per time: where the radian decides what a number means.
bool is_angle_or_frequency(ut_unit* unit) {
  if (ut_is_dimensionless(unit) != 0) {
    return true;
  }
  const Unit second = parse("s");
  const Unit product{ut_multiply(unit, second.get())};
  return product && ut_is_dimensionless(product.get()) != 0;
}

/// What to write instead of a frequency given in cycles where radians are wanted, or the reverse.
std::string radian_remedy(ut_unit* given, ut_unit* wanted, const std::string& wanted_text, double value) {
  if (ut_is_dimensionless(wanted) != 0) {
    return "a plain number and an angle are not the same";
  }
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const std::unique_ptr<cv_converter, void (*)(cv_converter*)> without_radian{ut_get_converter(given, wanted), cv_free};
  const double meant = cv_convert_double(without_radian.get(), value) * (has_radian(wanted) ? kTurn : 1.0 / kTurn);
  return fmt::format("one turn is 2 pi rad; write {:.5g} {}", meant, wanted_text);
}

}  // namespace

bool follows_record(std::string_view unit) {
  if (unit.empty()) {
    return true;
  }
  constexpr std::array<std::string_view, 4> kPatterns{"force", "position", "time", "command"};
  for (const std::string_view pattern : kPatterns) {
    if (unit.find(pattern) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

void UnitConverter::Free::operator()(cv_converter* converter) const noexcept { cv_free(converter); }

UnitConverter::UnitConverter(const std::string& unit, const std::string& wanted, double value) {
  if (unit == wanted) {
    return;
  }
  if (has_fractional_exponent(wanted)) {
    throw UnitError(fmt::format("unit \"{}\" cannot be converted to {}: write a bare number in {}", unit, wanted, wanted));
  }
  const Unit given = parse(unit);
  const Unit target = parse(wanted);
  const Unit ratio{ut_divide(given.get(), target.get())};
  if (!ratio || ut_is_dimensionless(ratio.get()) == 0) {
    throw UnitError(
        fmt::format("unit \"{}\" (in base units {}) does not convert to {}", unit, definition(given.get()), wanted));
  }
  const bool counted_in_turns = unit.find("Hz") != std::string::npos || unit.find("hertz") != std::string::npos;
  if (has_radian(ratio.get()) && (is_angle_or_frequency(target.get()) || counted_in_turns)) {
    throw UnitError(fmt::format("unit \"{}\" does not convert to {}: {}", unit, wanted,
                                radian_remedy(given.get(), target.get(), wanted, value)));
  }
  converter_.reset(ut_get_converter(given.get(), target.get()));
}

double UnitConverter::operator()(double value) const {
  return converter_ ? cv_convert_double(converter_.get(), value) : value;
}

double convert_unit(double value, const std::string& unit, const std::string& wanted) {
  return UnitConverter(unit, wanted, value)(value);
}

void require_known_unit(const std::string& unit) { parse(unit); }

std::optional<double> unit_product(std::string_view unit,
                                   const std::function<std::optional<double>(std::string_view)>& factor_of_word) {
  double product = 1.0;
  std::size_t at = 0;
  bool divides = false;
  while (at <= unit.size()) {
    const std::size_t end = std::min(unit.find_first_of("./", at), unit.size());
    // A power may hold a point, "kg^-0.5": it ends where a letter or a slash follows.
    std::size_t stop = end;
    const std::size_t hat = unit.find('^', at);
    double power = 1.0;
    if (hat < end) {
      const auto read = std::from_chars(unit.data() + hat + 1, unit.data() + unit.size(), power);
      stop = static_cast<std::size_t>(read.ptr - unit.data());
      stop -= unit[stop - 1] == '.' ? 1 : 0;  // "m^2.s"
    }
    const std::optional<double> factor = factor_of_word(unit.substr(at, std::min(hat, end) - at));
    if (!factor) {
      return std::nullopt;
    }
    product *= std::pow(*factor, divides ? -power : power);
    if (stop >= unit.size()) {
      break;
    }
    divides = unit[stop] == '/';
    at = stop + 1;
  }
  return product;
}

}  // namespace hotfire
