// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/key_text.hpp"
#include "tools/interface/plant/variable.hpp"

namespace hotfire::plant {

/// A number that identifies a text (FNV-1a, 64 bits).
class Fingerprint {
 public:
  void add(std::string_view bytes) noexcept {
    for (const char byte : bytes) {
      value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
    }
  }
  void add(double value) noexcept { add(std::string_view(reinterpret_cast<const char*>(&value), sizeof value)); }
  std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// Everything that makes a plant, as it is shown to a visitor (`model::visit_keys`, `model::visit_vehicle_keys`): a table of
/// the parameters, and the choices, curves and modes as a list of numbers.
class ParameterTable {
 public:
  template <class Field>
  void number(const model::KeyText& key, const Field& field, double value) {
    const std::string_view name = key.view();
    // What reads the plant is part of its state, which is made at the start.
    const bool reads = name.starts_with("sensors.") || name.find(".string") != std::string_view::npos;
    variables_.push_back(
        {std::string(name), std::string(field.unit), std::string(field.meaning), value, field.lower, field.upper, !reads});
    fingerprint_.add(name);
  }

  template <class E>
  bool effect(const model::KeyText& prefix, bool active) {
    choose(prefix, active ? 1.0 : 0.0);
    return active;
  }

  template <class Options>
  void option(const model::KeyText& key, const Options&, int option) {
    choose(key, option);
  }

  template <class Field, class Table>
  void table(const model::KeyText& key, const model::KeyText&, const Field&, const Table& table) {
    choose(key, table.points);
    for (std::size_t i = 0; i < table.x.size(); ++i) {
      choose(key, table.x[i]);
      choose(key, table.y[i]);
    }
  }

  void list(const model::KeyText& key, double, double, std::span<const double> values) {
    for (const double value : values) {
      choose(key, value);
    }
  }

  void count(const model::KeyText& key, int, int count) { choose(key, count); }

  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<double>& choices() const { return choices_; }
  /// Of all but the values of the parameters.
  std::uint64_t fingerprint() const { return fingerprint_.value(); }

 private:
  void choose(const model::KeyText& key, double value) {
    fingerprint_.add(key.view());
    fingerprint_.add(value);
    choices_.push_back(value);
  }

  std::vector<Variable> variables_{};
  std::vector<double> choices_{};
  Fingerprint fingerprint_{};
};

/// Fills parameters in any scalar from a table, and keeps the places of its parameters, in the order of the table.
template <class S>
class ParameterSlots {
 public:
  explicit ParameterSlots(const ParameterTable& table) : table_(table) {}

  template <class Field>
  void number(const model::KeyText&, const Field&, S& value) {
    value = S(table_.variables()[slots_.size()].start);
    slots_.push_back(&value);
  }

  template <class E>
  bool effect(const model::KeyText&, bool& active) {
    active = next() > 0.0;
    return active;
  }

  template <class Options>
  void option(const model::KeyText&, const Options&, int& option) {
    option = static_cast<int>(next());
  }

  template <class Field, class Table>
  void table(const model::KeyText&, const model::KeyText&, const Field&, Table& table) {
    table.points = static_cast<int>(next());
    for (std::size_t i = 0; i < table.x.size(); ++i) {
      table.x[i] = S(next());
      table.y[i] = S(next());
    }
  }

  void list(const model::KeyText&, double, double, std::span<S> values) {
    for (S& value : values) {
      value = S(next());
    }
  }

  void count(const model::KeyText&, int, int& count) { count = static_cast<int>(next()); }

  std::vector<S*> take() { return std::move(slots_); }

 private:
  double next() { return table_.choices()[next_++]; }

  const ParameterTable& table_;
  std::vector<S*> slots_{};
  std::size_t next_ = 0;
};

}  // namespace hotfire::plant
