// SPDX-License-Identifier: Apache-2.0
#include "tools/python/models.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "model/checks.hpp"
#include "model/key_text.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace py = pybind11;

namespace hotfire::python {

namespace {

/// Key, value, unit, least, most, meaning.
using Parameter = std::tuple<std::string, double, std::string, double, double, std::string>;

/// Lists the parameters that act, as `model::visit_keys` shows them.
class Lister {
 public:
  template <class Field>
  void number(const model::KeyText& key, const Field& field, double value) {
    if (model::is_used(field.options, option_)) {
      parameters.emplace_back(std::string(key.view()), value, std::string(field.unit), field.lower, field.upper,
                              std::string(field.meaning));
    }
  }

  template <class E>
  bool effect(const model::KeyText& prefix, bool active) {
    option_ = 0;
    if (active) {
      std::string name(prefix.view());
      name.pop_back();
      effects.emplace_back(std::move(name), "");
    }
    return active;
  }

  template <class Options>
  void option(const model::KeyText&, const Options& options, int option) {
    option_ = option;
    effects.back().second = options[static_cast<std::size_t>(option)];
  }

  template <class Field, class Table>
  void table(const model::KeyText&, const model::KeyText&, const Field&, const Table&) {}

  void next_axis() { option_ = 0; }

  std::vector<Parameter> parameters;
  std::vector<std::pair<std::string, std::string>> effects;  ///< "effects.gimbal_friction" and its law, "lugre"

 private:
  int option_ = 0;
};

/// Puts values into the parameters that act, and forgets those that it has put.
class Setter {
 public:
  explicit Setter(std::map<std::string, double>& values) : values_(values) {}

  template <class Field>
  void number(const model::KeyText& key, const Field& field, double& value) {
    const auto given = values_.find(std::string(key.view()));
    if (given == values_.end() || !model::is_used(field.options, option_)) {
      return;
    }
    if (!model::is_inside(field, given->second)) {
      throw FileError(fmt::format("{} = {}: outside its bounds; allowed: {:g} to {:g} {}", key.view(), given->second,
                                  field.lower, field.upper, field.unit));
    }
    value = given->second;
    values_.erase(given);
  }

  template <class E>
  bool effect(const model::KeyText&, bool active) {
    option_ = 0;
    return active;
  }

  template <class Options>
  void option(const model::KeyText&, const Options&, int option) {
    option_ = option;
  }

  template <class Field, class Table>
  void table(const model::KeyText&, const model::KeyText&, const Field&, const Table&) {}

  void next_axis() { option_ = 0; }

 private:
  std::map<std::string, double>& values_;
  int option_ = 0;
};

/// Shows every axis of a vehicle to a visitor, under the axis's name.
template <class Parameters, class Visitor>
void visit_axes(Parameters& parameters, Visitor& visitor) {
  const std::vector<std::string> names = axis_names(static_cast<int>(parameters.axes.size() / 2));
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    visitor.next_axis();
    model::visit_keys(parameters.axes[axis], visitor, names[axis] + ".");
  }
}

template <class Parameters>
Lister listed_vehicle(const Parameters& parameters) {
  Lister lister;
  visit_axes(parameters, lister);
  return lister;
}

Lister listed(const Model& model) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    return std::visit([](const auto& parameters) { return listed_vehicle(parameters); }, vehicle->parameters);
  }
  return std::visit(
      [](const auto& parameters) {
        Lister lister;
        model::visit_keys(parameters, lister);
        return lister;
      },
      std::get<ModelFile>(model.file).parameters);
}

std::string topology_of(const Model& model) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    return std::string(std::holds_alternative<TaosParameters>(vehicle->parameters) ? model::Taos<double>::topology
                                                                                   : model::Masv<double>::topology);
  }
  return std::visit([](const auto& parameters) { return std::string(PlantOf<decltype(parameters), double>::topology); },
                    std::get<ModelFile>(model.file).parameters);
}

Model load(const std::filesystem::path& path) {
  return is_vehicle(path) ? Model{load_vehicle(path)} : Model{load_model(path)};
}

Model parse(const std::string& text, const std::filesystem::path& name) {
  return is_vehicle(text, name) ? Model{parse_vehicle(text, name)} : Model{parse_model(text, name)};
}

std::string text_of(const Model& model) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    return vehicle_text(*vehicle);
  }
  return model_text(std::get<ModelFile>(model.file));
}

Model with_values(Model model, std::map<std::string, double> values) {
  if (auto* one = std::get_if<ModelFile>(&model.file)) {
    std::erase_if(one->left_out, [&values](const std::string& key) { return values.contains(key); });
  }
  Setter setter(values);
  if (auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    std::visit([&](auto& parameters) { visit_axes(parameters, setter); }, vehicle->parameters);
  } else {
    std::visit([&](auto& parameters) { model::visit_keys(parameters, setter); }, std::get<ModelFile>(model.file).parameters);
  }
  if (!values.empty()) {
    require_acting(model, {values.begin()->first});
  }
  return model;
}

}  // namespace

std::vector<std::string> acting_keys(const Model& model) {
  std::vector<std::string> keys;
  for (const Parameter& own : listed(model).parameters) {
    keys.push_back(std::get<0>(own));
  }
  return keys;
}

void require_acting(const Model& model, const std::vector<std::string>& keys) {
  const std::vector<std::string> acting = acting_keys(model);
  for (const std::string& key : keys) {
    if (std::find(acting.begin(), acting.end(), key) == acting.end()) {
      throw UsageError(fmt::format("{} is not a parameter that acts in the model; {}", key,
                                   suggestion(key, std::vector<std::string_view>(acting.begin(), acting.end()))));
    }
  }
}

void add_models(py::module_& module) {
  py::class_<Model>(module, "Model")
      .def_static("load", &load, py::arg("path"))
      .def_static("parse", &parse, py::arg("text"), py::arg("name"))
      .def_property_readonly("text", &text_of)
      .def_property_readonly("topology", &topology_of)
      .def_property_readonly(
          "name", [](const Model& model) { return std::visit([](const auto& file) { return file.name; }, model.file); })
      .def_property_readonly(
          "path",
          [](const Model& model) { return std::visit([](const auto& file) { return file.path.string(); }, model.file); })
      .def("parameters", [](const Model& model) { return listed(model).parameters; })
      .def("effects", [](const Model& model) { return listed(model).effects; });
  module.def("with_values", &with_values, py::arg("model"), py::arg("values"));
}

}  // namespace hotfire::python
