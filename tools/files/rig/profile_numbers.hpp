// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "model/checks.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

/// A number that a profile has to say.
struct ProfileNumber {
  std::string_view key;
  std::string_view unit;
  double lower;
  double upper;
};

/// The values of a profile file. Every refusal names file, line, key, value and what is allowed.
class ProfileNumbers {
 public:
  static constexpr double kAny = 1e9;
  static constexpr double kAboveZero = 1e-9;

  explicit ProfileNumbers(const std::filesystem::path& path) : source_(path) {}

  const TomlSource& source() const { return source_; }

  /// How many actuators a list has to have a number for.
  void set_actuators(std::size_t actuators) { actuators_ = actuators; }
  std::size_t actuators() const { return actuators_; }

  const toml::node& needed(const toml::table& table, const std::string& prefix, std::string_view key,
                           const std::string& allowed) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      source_.refuse_missing(table, prefix + std::string(key), "missing; allowed: " + allowed);
    }
    return *node;
  }

  double within(const toml::node& node, const std::string& key, std::string_view unit, double lower, double upper) const {
    const double value = source_.number(node, key, unit);
    if (!model::is_inside(value, lower, upper)) {
      source_.refuse(node, key, fmt::format("allowed: {:g} to {:g} {}", lower, upper, unit));
    }
    return value;
  }

  double number(const toml::table& table, const std::string& prefix, const ProfileNumber& wanted) const {
    const toml::node& node = needed(table, prefix, wanted.key, fmt::format("a number in {}", wanted.unit));
    return within(node, prefix + std::string(wanted.key), wanted.unit, wanted.lower, wanted.upper);
  }

  /// The number, or `otherwise` where nothing is said.
  double number_or(const toml::table& table, const std::string& prefix, const ProfileNumber& wanted,
                   double otherwise) const {
    return table.contains(wanted.key) ? number(table, prefix, wanted) : otherwise;
  }

  std::int64_t count(const toml::node& node, const std::string& key, std::int64_t lowest, std::int64_t highest) const {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < lowest || *value > highest) {
      source_.refuse(node, key, fmt::format("allowed: a whole number from {} to {}", lowest, highest));
    }
    return *value;
  }

  /// What is said of every actuator: a number for all of them, or a list with one for each.
  std::vector<double> each(const toml::node& node, const std::string& key, const ProfileNumber& wanted) const {
    const toml::array* list = node.as_array();
    if (list == nullptr) {
      return std::vector<double>(actuators_, within(node, key, wanted.unit, wanted.lower, wanted.upper));
    }
    if (list->size() != actuators_) {
      source_.refuse(node, key, "allowed: " + each_allowed(wanted.unit));
    }
    std::vector<double> result;
    for (const toml::node& item : *list) {
      result.push_back(within(item, key, wanted.unit, wanted.lower, wanted.upper));
    }
    return result;
  }

  std::string each_allowed(std::string_view unit) const {
    return fmt::format("a number in {}, for all actuators, or a list of {}, one for each", unit, actuators_);
  }

  const toml::array& list(const toml::table& table, const std::string& prefix, std::string_view key,
                          const std::string& allowed) const {
    const toml::node& node = needed(table, prefix, key, allowed);
    if (!node.is_array() || node.as_array()->empty()) {
      source_.refuse(node, prefix + std::string(key), "allowed: " + allowed);
    }
    return *node.as_array();
  }

 private:
  TomlSource source_;
  std::size_t actuators_ = 1;
};

}  // namespace hotfire
