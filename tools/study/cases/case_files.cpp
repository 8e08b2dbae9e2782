// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "tools/files/text/whole_file.hpp"
#include "tools/study/cases/case.hpp"
#include "tools/study/draws/wild_draw.hpp"

namespace hotfire::study {

namespace {

/// "unlisted@SITE|SITE" for what is in no list, else the name: one word for each effect that is missing.
nlohmann::json wanted_words(const StudyCase& made) {
  const CaseOrder& order = made.order;
  nlohmann::json words = nlohmann::json::array();
  for (const std::string& name : order.effects) {
    if (name == kWild) {
      words.push_back("unlisted@" + std::string(right_sites(*made.plan.axis.wild)));
    } else if (order.two_axes) {
      words.push_back(name.starts_with(kCrossHose) ? "unlisted@engine_torque" + name.substr(name.rfind('.')) : name);
    } else {
      words.push_back(is_listed(studied_effect(name)) ? name : "unlisted@" + std::string(studied_effect(name).site));
    }
  }
  if (const auto fault = condition_of(order.condition).fault(); !fault.empty()) {
    words.push_back(fault);
  }
  return words;
}

nlohmann::json parameters_of(const ReferenceAxis& axis) {
  return {{"valve_natural_frequency", axis.valve_frequency},
          {"position_gain", axis.position_gain},
          {"pressure_feedback_gain", axis.pressure_gain},
          {"bulk_modulus", axis.bulk_modulus},
          {"leakage", axis.leakage},
          {"piston_damping", axis.piston_damping},
          {"structure_stiffness", axis.load_stiffness},
          {"inertia", axis.inertia},
          {"viscous_damping", axis.damping},
          {"duct_stiffness", axis.duct_stiffness}};
}

nlohmann::json truth_of(const StudyCase& made) {
  nlohmann::json truth{{"case", made.order.name},
                       {"seed", made.order.seed},
                       {"effects", wanted_words(made)},
                       {"kinds", made.order.effects},
                       {"law", made.plan.law},
                       {"effect_values", made.plan.values},
                       {"effect_size", made.effect_size},
                       {"noise_factor", made.order.noise_factor},
                       {"scatter_factor", made.order.scatter_factor},
                       {"condition", made.order.condition},
                       {"exclusions", made.exclusions}};
  truth["may_name"] = nlohmann::json::array();
  for (const std::string& name : made.order.effects) {
    const std::string_view contained = name == kWild         ? contained_effect(*made.plan.axis.wild)
                                       : made.order.two_axes ? ""
                                                             : studied_effect(name).contains;
    if (!contained.empty()) {
      truth["may_name"].push_back(contained);
    }
  }
  truth["parameters"] = parameters_of(made.plan.axis);
  if (made.yaw) {
    truth["parameters_of_yaw"] = parameters_of(*made.yaw);
  }
  return truth;
}

}  // namespace

void write_case(const StudyCase& made, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "given");
  std::filesystem::create_directories(folder / "kept");
  write_whole_file(folder / "given/declared.toml", made.declared);
  for (const Record& record : made.given) {
    write_record(record, folder / "given" / record.name);
  }
  write_record(made.unseen, folder / "kept" / made.unseen.name);
  if (!made.truth.empty()) {
    write_whole_file(folder / "kept/true.toml", made.truth);
  }
  // Last: a folder that has it is whole.
  write_whole_file(folder / "kept/truth.json", truth_of(made).dump(1) + "\n");
}

}  // namespace hotfire::study
