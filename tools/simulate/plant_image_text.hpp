// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "model/key_text.hpp"
#include "model/vehicle_keys.hpp"
#include "tools/files/model/plant_of.hpp"

namespace hotfire {

/// Writes what it is shown (`model::visit_keys`, `model::visit_vehicle_keys`) as lines `key value`, numbers in hexadecimal
/// floating point.
class PlantImageWriter {
 public:
  explicit PlantImageWriter(std::string_view topology) {
    line("schema", "1");
    line("topology", topology);
  }

  template <class Field>
  void number(const model::KeyText& key, const Field&, double value) {
    line(key.view(), exact(value));
  }

  template <class E>
  bool effect(const model::KeyText&, bool active) {
    return active;
  }

  template <class Options>
  void option(const model::KeyText& key, const Options& options, int option) {
    line(key.view(), options[static_cast<std::size_t>(option)]);
  }

  template <class Field, class Table>
  void table(const model::KeyText& x_key, const model::KeyText& y_key, const Field&, const Table& table) {
    for (int i = 0; i < table.points; ++i) {
      const std::string index = std::string(".").append(std::to_string(i));
      line(std::string(x_key.view()) + index, exact(table.x[static_cast<std::size_t>(i)]));
      line(std::string(y_key.view()) + index, exact(table.y[static_cast<std::size_t>(i)]));
    }
  }

  void list(const model::KeyText& key, double, double, std::span<const double> values) {
    std::string numbers;
    for (const double value : values) {
      numbers.append(numbers.empty() ? "" : ",").append(exact(value));
    }
    line(key.view(), numbers);
  }

  void count(const model::KeyText& key, int, int count) { line(key.view(), std::to_string(count)); }

  const std::string& text() const { return text_; }

 private:
  static std::string exact(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%a", value);
    return digits;
  }

  void line(std::string_view key, std::string_view value) { text_.append(key).append(" ").append(value).append("\n"); }

  std::string text_;
};

/// The plant image of an axis alone or a mass, which `hotfire-rt --image` reads back bit for bit.
template <class Parameters>
std::string plant_image_text(const Parameters& parameters) requires requires {
  parameters.effects;
}
{
  PlantImageWriter writer(PlantOf<Parameters, double>::topology);
  model::visit_keys(parameters, writer);
  return writer.text();
}

/// The plant image of a vehicle with its sensors.
template <class Vehicle>
std::string plant_image_text(const model::InstrumentedVehicle<Vehicle>& instrumented) {
  PlantImageWriter writer(Vehicle::topology);
  model::visit_vehicle_keys(instrumented, writer);
  return writer.text();
}

/// The plant image of a model.
inline std::string plant_image_text(const ModelFile& model) {
  return std::visit([](const auto& parameters) { return plant_image_text(parameters); }, model.parameters);
}

}  // namespace hotfire
