// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/declared_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "tools/files/model/key_groups.hpp"
#include "tools/files/record/axis_names.hpp"

namespace hotfire::disperse {

namespace {

/// The keys of a number of one axis, from general to particular. `tables` are the names of the axis.
std::vector<std::string> keys_of_axis(const std::string& section, std::string_view name,
                                      const std::vector<std::string>& tables) {
  std::vector<std::string> keys{fmt::format("{}.{}", section, name)};
  for (const std::string& table : tables) {
    keys.push_back(fmt::format("{}.{}.{}", section, table, name));
  }
  return keys;
}

void append_group(std::vector<DeclaredNumber>& numbers, const KeyGroup& group, const std::string& section,
                  const std::vector<std::string>& tables) {
  for (const NumberKey& number : group.numbers) {
    if (group.uses(number.options)) {
      numbers.push_back({keys_of_axis(section, number.name, tables), std::string{number.unit}, number.value});
    }
  }
}

void append_layout(std::vector<DeclaredNumber>& numbers, const ModelLayout& layout, const std::vector<std::string>& tables) {
  for (const KeyGroup& part : layout.parts) {
    append_group(numbers, part, std::string{part.name}, tables);
  }
  for (const KeyGroup& effect : layout.effects) {
    if (*effect.active) {
      append_group(numbers, effect, fmt::format("effects.{}", effect.name), tables);
    }
  }
}

template <class Parameters>
void append_gimbal(std::vector<DeclaredNumber>& numbers, Parameters& parameters) {
  for (auto& gimbal : parameters.gimbals) {
    append_group(numbers, part_group(gimbal.bearing), "gimbal", {});
    if (gimbal.friction.rubs()) {
      append_group(numbers, part_group(gimbal.friction), "gimbal.friction", {});
    }
    if (gimbal.vibration.pitch_velocity > 0.0 || gimbal.vibration.yaw_velocity > 0.0) {
      append_group(numbers, part_group(gimbal.vibration), "gimbal.vibration", {});
    }
    if (gimbal.compliant) {
      for (double& cell : gimbal.stiffness.reshaped()) {
        numbers.push_back({{"gimbal.stiffness"}, "", &cell});
      }
    }
  }
}

template <class Plant, class Parameters>
std::vector<DeclaredNumber> numbers_of(Parameters& parameters) {
  std::vector<DeclaredNumber> numbers;
  for (int axis = 0; axis < Plant::kAxes; ++axis) {
    const auto own = static_cast<std::size_t>(axis);
    const std::vector<std::string> tables = tables_of_axis(axis, Plant::kEngines);
    append_layout(numbers, layout_of_plant<model::Simplex<double, typename Plant::Effects>>(parameters.axes[own]), tables);
    if (!parameters.constant_arms[own / 2]) {
      // There is no attach point of every axis.
      std::vector<DeclaredNumber> points;
      append_group(points, part_group(parameters.attach[own]), "attach", tables);
      for (DeclaredNumber& point : points) {
        point.keys.erase(point.keys.begin());
        numbers.push_back(std::move(point));
      }
    }
  }
  append_gimbal(numbers, parameters);
  return numbers;
}

std::variant<ModelFile, VehicleFile> loaded(const std::filesystem::path& path) {
  if (is_vehicle(path)) {
    return load_vehicle(path);
  }
  return load_model(path);
}

}  // namespace

DeclaredModel::DeclaredModel(const std::filesystem::path& path) : model_(loaded(path)) {}

std::vector<DeclaredNumber> DeclaredModel::numbers() {
  if (auto* model = std::get_if<ModelFile>(&model_)) {
    std::vector<DeclaredNumber> numbers;
    append_layout(numbers, layout_of(*model), {});
    return numbers;
  }
  auto& parameters = std::get<VehicleFile>(model_).parameters;
  if (auto* taos = std::get_if<TaosParameters>(&parameters)) {
    return numbers_of<model::Taos<double>>(*taos);
  }
  return numbers_of<model::Masv<double>>(std::get<MasvParameters>(parameters));
}

std::vector<std::pair<std::string, double>> DeclaredModel::tolerances() const {
  if (const auto* model = std::get_if<ModelFile>(&model_)) {
    return {model->tolerance.begin(), model->tolerance.end()};
  }
  const std::vector<AxisDeclaration>& axes = std::get<VehicleFile>(model_).axes;
  const std::vector<std::string> names = axis_names(static_cast<int>(axes.size() / 2));
  std::set<std::string> keys;
  for (const AxisDeclaration& axis : axes) {
    for (const auto& [key, relative] : axis.tolerance) {
      keys.insert(key);
    }
  }
  std::vector<std::pair<std::string, double>> tolerances;
  for (const std::string& key : keys) {
    const auto of = [&](const AxisDeclaration& axis) {
      const auto found = axis.tolerance.find(key);
      return found != axis.tolerance.end() ? found->second : 0.0;
    };
    if (std::all_of(axes.begin(), axes.end(), [&](const AxisDeclaration& axis) { return of(axis) == of(axes.front()); })) {
      tolerances.emplace_back(key, of(axes.front()));
      continue;
    }
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      if (of(axes[axis]) > 0.0) {
        const auto dot = key.rfind('.');
        tolerances.emplace_back(fmt::format("{}.{}{}", key.substr(0, dot), names[axis], key.substr(dot)), of(axes[axis]));
      }
    }
  }
  return tolerances;
}

std::string DeclaredModel::text(TableName table) const {
  if (const auto* model = std::get_if<ModelFile>(&model_)) {
    return model_text(*model);
  }
  VehicleFile vehicle = std::get<VehicleFile>(model_);
  std::string text = vehicle_text(vehicle);
  if (table == TableName::without_folder && !vehicle.modes_table.empty()) {
    const std::string full = std::filesystem::absolute(vehicle.modes_table).string();
    if (const auto at = text.find(full); at != std::string::npos) {
      text.replace(at, full.size(), vehicle.modes_table.filename().string());
    }
  }
  return text;
}

std::filesystem::path DeclaredModel::modes_table() const {
  const auto* vehicle = std::get_if<VehicleFile>(&model_);
  return vehicle != nullptr ? vehicle->modes_table : std::filesystem::path{};
}

}  // namespace hotfire::disperse
