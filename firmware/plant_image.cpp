#include "firmware/plant_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "firmware/image_entries.hpp"
#include "firmware/text.hpp"
#include "model/key_text.hpp"

namespace hotfire::firmware {
namespace {

/// Fills the parameters it is shown (`model::visit_keys`) from the entries.
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
      const double lowest = i == 0 ? -HUGE_VAL : std::nextafter(table.x[i - 1], HUGE_VAL);
      table.x[i] = read_bounded(entries_, x, lowest, 1.7e308, field.x_unit);
      table.y[i] = read_bounded(entries_, y, field.y_lower, field.y_upper, field.y_unit);
      table.points = static_cast<int>(i) + 1;
    }
  }

 private:
  Entries& entries_;
};

PlayedFault read_fault(Entries& entries, const std::string& prefix, std::span<const std::string_view> channels,
                       bool hydraulic) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  constexpr double kForGood = std::numeric_limits<double>::infinity();
  PlayedFault fault;
  fault.kind = static_cast<PlayedKind>(read_word(entries, prefix + "kind", kPlayedKinds));
  fault.from = read_bounded(entries, prefix + "from", 0.0, kLargest, "s");
  fault.to = read_bounded(entries, prefix + "to", fault.from, kForGood, "s");
  if (fault.kind == PlayedKind::bus_off) {
    return fault;
  }
  fault.actuator = static_cast<int>(read_bounded(entries, prefix + "actuator", 0.0, hal::kMaxActuators, ""));
  if (is_of_sensor(fault.kind)) {
    fault.channel = read_word(entries, prefix + "channel", channels);
  } else if (!hydraulic) {
    entries.refuse(prefix + "kind: leak and lost_supply are faults of a hydraulic axis");
  }
  switch (fault.kind) {
    case PlayedKind::biased:
      fault.value = read_bounded(entries, prefix + "value", -kLargest, kLargest, "in the channel's unit");
      break;
    case PlayedKind::noisy:
      fault.value = read_bounded(entries, prefix + "value", 0.0, kLargest, "in the channel's unit");
      break;
    case PlayedKind::delayed:
      fault.value = read_bounded(entries, prefix + "value", 0.0, kLongestSensorDelay, "s");
      break;
    case PlayedKind::leak:
      fault.value = read_bounded(entries, prefix + "value", 0.0, 1e-6, "m^3/s/Pa");
      break;
    case PlayedKind::lost_supply:
      fault.value = read_bounded(entries, prefix + "value", 1e4, 1e9, "Pa");
      break;
    default:
      break;
  }
  return fault;
}

/// Two faults would each want the actuator to be another model.
bool are_at_odds(const PlayedFault& one, const PlayedFault& other) {
  return is_of_actuator(one.kind) && is_of_actuator(other.kind) && one.from < other.to && other.from < one.to &&
         (one.actuator == 0 || other.actuator == 0 || one.actuator == other.actuator);
}

template <class Model>
std::vector<PlayedFault> read_faults(Entries& entries) {
  std::vector<PlayedFault> faults;
  constexpr bool kHydraulic = requires(typename Model::Parameters parameters) { parameters.actuator.leakage; };
  for (std::string prefix = "fault.0."; entries.has_prefix(prefix); prefix = text("fault.%zu.", faults.size())) {
    const PlayedFault fault = read_fault(entries, prefix, Model::channels, kHydraulic);
    if (std::any_of(faults.begin(), faults.end(), [&](const PlayedFault& other) { return are_at_odds(fault, other); })) {
      entries.refuse(prefix + "kind: a leak or lost supply of an actuator that has another one at that time");
    }
    faults.push_back(fault);
  }
  return faults;
}

template <class Model>
PlantImage fill(Entries& entries) {
  typename Model::Parameters parameters;
  Filler filler(entries);
  model::visit_keys(parameters, filler);
  std::vector<PlayedFault> faults = read_faults<Model>(entries);
  entries.refuse_unused();
  model::visit_effects(parameters, [&]<class E>(std::size_t index, const auto& values) {
    if constexpr (requires { E::broken_relation(values); }) {
      const std::string_view broken = parameters.effects.active[index] ? E::broken_relation(values) : std::string_view{};
      if (!broken.empty()) {
        entries.refuse("effects." + std::string(E::name) + ": " + std::string(broken));
      }
    }
  });
  if (!entries.error().empty()) {
    return {std::nullopt, entries.error()};
  }
  return {parameters, {}, std::move(faults)};
}

}  // namespace

PlantImage parse_plant_image(const std::string& text, const std::string& name) {
  Entries entries(text, name);
  const Entry* schema = entries.take("schema");
  if (schema != nullptr && schema->value != "1") {
    entries.refuse(*schema, "this build reads schema 1; use hotfire and hotfire-rt of the same version");
  }
  const Entry* topology = entries.take("topology");
  if (entries.error().empty() && topology->value == model::Simplex<double>::topology) {
    return fill<model::Simplex<double>>(entries);
  }
  if (entries.error().empty() && topology->value == model::Direct<double>::topology) {
    return fill<model::Direct<double>>(entries);
  }
  if (topology != nullptr) {
    entries.refuse(*topology, "allowed are direct simplex");
  }
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
