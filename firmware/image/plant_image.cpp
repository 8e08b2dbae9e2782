// SPDX-License-Identifier: Apache-2.0
#include "firmware/image/plant_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "firmware/image/image_entries.hpp"
#include "firmware/text/text.hpp"
#include "hal/recording/header.hpp"
#include "model/checks.hpp"
#include "model/vehicle_keys.hpp"

namespace hotfire::firmware {
namespace {

constexpr double kAnyFinite = std::numeric_limits<double>::max();

/// Fills the parameters it is shown (`model::visit_keys`, `model::visit_vehicle_keys`) from the entries.
class Filler {
 public:
  explicit Filler(Entries& entries) : entries_(entries) {}

  template <class Field>
  void number(const model::KeyText& key, const Field& field, double& value) {
    value = read_bounded(entries_, std::string(key.view()), field.lower, field.upper, field.unit);
  }

  template <class E>
  bool effect(const model::KeyText& prefix, bool& active) {
    active = entries_.has_prefix(prefix.view());
    return active;
  }

  template <class Options>
  void option(const model::KeyText& key, const Options& options, int& option) {
    option = read_word(entries_, std::string(key.view()), options);
  }

  template <class Field, class Table>
  void table(const model::KeyText& x_key, const model::KeyText& y_key, const Field& field, Table& table) {
    for (std::size_t i = 0; i < Table::kCapacity; ++i) {
      const std::string x = std::string(x_key.view()) + "." + std::to_string(i);
      const std::string y = std::string(y_key.view()) + "." + std::to_string(i);
      if (!entries_.has(x) && !entries_.has(y)) {
        return;
      }
      table.x[i] = read_bounded(entries_, x, -kAnyFinite, kAnyFinite, field.x_unit);
      if (const Entry* entry = entries_.take(x); entry != nullptr && !model::rises(table.x, i)) {
        entries_.refuse(*entry, "must be above the value before it");
      }
      table.y[i] = read_bounded(entries_, y, field.y_lower, field.y_upper, field.y_unit);
      table.points = static_cast<int>(i) + 1;
    }
  }

  void list(const model::KeyText& key, double lower, double upper, std::span<double> values) {
    read_list(entries_, std::string(key.view()), lower, upper, "", values);
  }

  void count(const model::KeyText& key, int most, int& count) {
    count = read_whole(entries_, std::string(key.view()), 0, most);
  }

 private:
  Entries& entries_;
};

/// What the faults of a plant are declared on.
struct FaultyPlant {
  std::span<const std::string_view> channels;
  bool hydraulic;
  std::size_t actuators;  ///< at most
  bool has_bearing = false;
};

PlayedFault read_fault(Entries& entries, const std::string& prefix, const FaultyPlant& plant) {
  constexpr double kForGood = std::numeric_limits<double>::infinity();
  PlayedFault fault;
  fault.kind = static_cast<PlayedKind>(read_word(entries, prefix + "kind", kPlayedKinds));
  fault.from = read_bounded(entries, prefix + "from", 0.0, kAnyFinite, "s");
  fault.to = read_bounded(entries, prefix + "to", fault.from, kForGood, "s");
  if (fault.kind == PlayedKind::bus_off) {
    return fault;
  }
  fault.actuator = read_whole(entries, prefix + "actuator", 0, static_cast<int>(plant.actuators));
  if (is_of_sensor(fault.kind)) {
    fault.channel = read_word(entries, prefix + "channel", plant.channels);
  } else if (!plant.hydraulic) {
    entries.refuse(prefix + "kind: leak, lost_supply, torque and thrust are of a hydraulic axis and its engine");
  } else if (fault.kind == PlayedKind::thrust && !plant.has_bearing) {
    entries.refuse(prefix + "kind: thrust is of topology taos or masv");
  }
  const auto read_value = [&](double least, double most, const char* unit) {
    fault.value = read_bounded(entries, prefix + "value", least, most, unit);
  };
  switch (fault.kind) {
    case PlayedKind::biased:
      read_value(-kAnyFinite, kAnyFinite, "in the channel's unit");
      break;
    case PlayedKind::noisy:
      read_value(0.0, kAnyFinite, "in the channel's unit");
      break;
    case PlayedKind::delayed:
      read_value(0.0, kLongestSensorDelay, "s");
      break;
    case PlayedKind::leak:
      read_value(0.0, 1e-6, "m^3/s/Pa");
      break;
    case PlayedKind::lost_supply:
      read_value(1e4, 1e9, "Pa");
      break;
    case PlayedKind::torque:
      read_value(-kLargestTorque, kLargestTorque, "N m");
      break;
    case PlayedKind::thrust:
      read_value(0.0, kLargestThrust, "N");
      break;
    default:
      break;
  }
  return fault;
}

/// Two faults would each want the actuator to be another model, or the engine to have another thrust.
bool are_at_odds(const PlayedFault& one, const PlayedFault& other) {
  const bool both_thrust = one.kind == PlayedKind::thrust && other.kind == PlayedKind::thrust;
  const auto part = [&](const PlayedFault& fault) { return both_thrust ? (fault.actuator + 1) / 2 : fault.actuator; };
  return (both_thrust || (is_of_actuator(one.kind) && is_of_actuator(other.kind))) && one.from < other.to &&
         other.from < one.to && (one.actuator == 0 || other.actuator == 0 || part(one) == part(other));
}

std::vector<PlayedFault> read_faults(Entries& entries, const FaultyPlant& plant) {
  std::vector<PlayedFault> faults;
  for (std::string prefix = "fault.0."; entries.has_prefix(prefix); prefix = text("fault.%zu.", faults.size())) {
    const PlayedFault fault = read_fault(entries, prefix, plant);
    if (std::any_of(faults.begin(), faults.end(), [&](const PlayedFault& other) { return are_at_odds(fault, other); })) {
      entries.refuse(
          prefix +
          "kind: a leak or lost supply of an actuator, or a thrust of an engine, that has another one at that time");
    }
    faults.push_back(fault);
  }
  return faults;
}

RecordedLoad read_recorded(Entries& entries, const std::string& prefix, const FaultyPlant& plant, std::size_t rows) {
  constexpr double kLargestForce = 1e8;        // [N]
  constexpr double kFastestVibration = 100.0;  // [rad/s]
  RecordedLoad load;
  load.kind = static_cast<RecordedKind>(read_word(entries, prefix + "kind", kRecordedKinds));
  if (!plant.hydraulic) {
    entries.refuse(prefix + "kind: a disturbance is of a hydraulic axis and its engine");
  } else if (load.kind != RecordedKind::torque && !plant.has_bearing) {
    entries.refuse(prefix + "kind: force, vibration and thrust are of topology taos or masv");
  }
  // One axis has copies as actuators, all of which its torque turns.
  const std::size_t axes = plant.has_bearing ? plant.actuators : 1;
  load.values.resize(rows);
  const auto read = [&](std::size_t places, double lower, double upper, std::string_view unit) {
    load.place = static_cast<std::size_t>(read_whole(entries, prefix + "place", 0, static_cast<int>(places) - 1));
    read_list(entries, prefix + "values", lower, upper, unit, load.values);
  };
  switch (load.kind) {
    case RecordedKind::torque:
      read(axes, -kLargestTorque, kLargestTorque, "N m");
      break;
    case RecordedKind::force:
      read(axes / 2 * 3, -kLargestForce, kLargestForce, "N");
      break;
    case RecordedKind::vibration:
      read(axes, -kFastestVibration, kFastestVibration, "rad/s");
      break;
    case RecordedKind::thrust:
      read(axes / 2, 0.0, kLargestThrust, "N");
      break;
  }
  return load;
}

LoadRecord read_disturbances(Entries& entries, const FaultyPlant& plant) {
  LoadRecord record;
  if (!entries.has_prefix("disturbance.")) {
    return record;
  }
  constexpr double kShortestRow = 1e-6;  // [s]
  constexpr double kLongestRow = 1.0;
  record.period = read_bounded(entries, "disturbance.period", kShortestRow, kLongestRow, "s");
  const int rows = read_whole(entries, "disturbance.rows", 1, static_cast<int>(hal::kMostPlayedValues));
  for (std::string prefix = "disturbance.0."; entries.error().empty() && entries.has_prefix(prefix);
       prefix = text("disturbance.%zu.", record.loads.size())) {
    record.loads.push_back(read_recorded(entries, prefix, plant, static_cast<std::size_t>(rows)));
  }
  return record;
}

/// Refuses values that contradict each other; `broken` is empty if none do.
void refuse_broken(Entries& entries, const std::string& key, std::string_view broken) {
  if (!broken.empty()) {
    entries.refuse(key + ": " + std::string(broken));
  }
}

template <class Parameters>
void refuse_broken_effects(Entries& entries, const std::string& prefix, const Parameters& axis) {
  const model::Broken part = model::broken_part(axis);
  refuse_broken(entries, prefix + std::string(part.name), part.relation);
  const model::Broken effect = model::broken_effect(axis);
  refuse_broken(entries, prefix + "effects." + std::string(effect.name), effect.relation);
}

template <class Model>
PlantImage fill(Entries& entries) {
  typename Model::Parameters parameters;
  Filler filler(entries);
  model::visit_keys(parameters, filler);
  constexpr bool kHydraulic = requires { parameters.actuator.leakage; };
  const FaultyPlant plant{Model::channels, kHydraulic, hal::kMaxActuators};
  std::vector<PlayedFault> faults = read_faults(entries, plant);
  LoadRecord recorded = read_disturbances(entries, plant);
  entries.refuse_unused();
  refuse_broken_effects(entries, "", parameters);
  if (!entries.error().empty()) {
    return {std::nullopt, entries.error()};
  }
  return {parameters, {}, std::move(faults), std::move(recorded)};
}

template <class Vehicle>
void refuse_broken_vehicle(Entries& entries, const model::InstrumentedVehicle<Vehicle>& instrumented) {
  const auto& vehicle = instrumented.vehicle;
  for (std::size_t e = 0; e < vehicle.gimbals.size(); ++e) {
    const std::string number = std::to_string(e + 1);
    refuse_broken_effects(entries, "pitch" + number + ".", vehicle.axes[2 * e]);
    refuse_broken_effects(entries, "yaw" + number + ".", vehicle.axes[2 * e + 1]);
    if (!vehicle.constant_arms[e]) {
      refuse_broken(entries, "attach points of engine " + number,
                    model::broken_relation(vehicle.attach[2 * e], vehicle.attach[2 * e + 1]));
    }
    refuse_broken(entries, "gimbal of engine " + number, model::broken_relation(vehicle.gimbals[e]));
    refuse_broken(entries, "strings of engine " + number,
                  model::StringPotentiometers<double>::broken_relation(instrumented.sensors.anchors[e]));
  }
}

template <class Vehicle>
PlantImage fill_vehicle(Entries& entries) {
  PlantImage image;
  auto& instrumented = std::get<model::InstrumentedVehicle<Vehicle>>(
      image.parameters.emplace(std::in_place_type<model::InstrumentedVehicle<Vehicle>>));
  Filler filler(entries);
  model::visit_vehicle_keys(instrumented, filler);
  const FaultyPlant plant{Vehicle::AxisModel::channels, true, Vehicle::kAxes, true};
  image.faults = read_faults(entries, plant);
  image.recorded = read_disturbances(entries, plant);
  entries.refuse_unused();
  refuse_broken_vehicle(entries, instrumented);
  if (!entries.error().empty()) {
    return {std::nullopt, entries.error()};
  }
  return image;
}

}  // namespace

PlantImage parse_plant_image(const std::string& text, const std::string& name) {
  Entries entries(text, name);
  const Entry* schema = entries.take("schema");
  if (schema != nullptr && schema->value != "1") {
    entries.refuse(*schema, "this build reads schema 1; use hotfire and hotfire-rt of the same version");
  }
  const Entry* topology = entries.take("topology");
  if (!entries.error().empty()) {
    return {std::nullopt, entries.error()};
  }
  if (topology->value == model::Simplex<double>::topology) {
    return fill<model::Simplex<double>>(entries);
  }
  if (topology->value == model::Direct<double>::topology) {
    return fill<model::Direct<double>>(entries);
  }
  if (topology->value == model::ImposedMotion<double>::topology) {
    return fill<model::ImposedMotion<double>>(entries);
  }
  if (topology->value == model::Modal<double>::topology) {
    return fill<model::Modal<double>>(entries);
  }
  if (topology->value == model::Electromechanical<double>::topology) {
    return fill<model::Electromechanical<double>>(entries);
  }
  if (topology->value == model::Taos<double>::topology) {
    return fill_vehicle<model::Taos<double>>(entries);
  }
  if (topology->value == model::Masv<double>::topology) {
    return fill_vehicle<model::Masv<double>>(entries);
  }
  entries.refuse(*topology, "allowed are direct electromechanical imposed_motion modal simplex taos masv");
  return {std::nullopt, entries.error()};
}

PlantImage read_plant_image(const std::string& path) {
  const ReadText file = read_image_text(path);
  if (!file.error.empty()) {
    return {std::nullopt, file.error};
  }
  PlantImage image = parse_plant_image(file.text, path);
  image.text = file.text;
  return image;
}

}  // namespace hotfire::firmware
