// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/disturbances.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "hal/recording/header.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// A kind of disturbance, its unit and what a plant in real time takes of it: hotfire-rt, which reads the image, checks the
/// bounds too.
struct Kind {
  std::string_view name;
  std::string_view unit;
  double lower;
  double upper;
};
constexpr std::array<Kind, 4> kKinds{{{"torque", "N.m", -1e7, 1e7},
                                      {"force", "N", -1e8, 1e8},
                                      {"vibration", "rad/s", -100.0, 100.0},
                                      {"thrust", "N", 0.0, 1e8}}};

const Kind& kind_of(const Disturbance& disturbance) { return kKinds[static_cast<std::size_t>(disturbance.kind)]; }

std::vector<std::string> names_of_engines(int engines) {
  std::vector<std::string> names;
  for (int e = 1; e <= engines; ++e) {
    names.push_back(fmt::format("engine{}", e));
  }
  return names;
}

std::vector<std::string> names_of_directions(int engines) {
  std::vector<std::string> names;
  for (int e = 1; e <= engines; ++e) {
    for (const char* direction : {"x", "y", "z"}) {
      names.push_back(engines == 1 ? direction : fmt::format("{}{}", direction, e));
    }
  }
  return names;
}

void add(const std::vector<const Channel*>& channels, DisturbanceKind kind, std::vector<Disturbance>& disturbances) {
  for (std::size_t place = 0; place < channels.size(); ++place) {
    if (channels[place] != nullptr) {
      disturbances.push_back({kind, place, channels[place]});
    }
  }
}

void require_bounds(const Record& inputs, const Channel& channel, double lower, double upper, std::string_view unit) {
  const auto outside = std::find_if(channel.values.begin(), channel.values.end(),
                                    [=](double value) { return !(value >= lower && value <= upper); });
  if (outside != channel.values.end()) {
    throw FileError(fmt::format("{}: {} = {:g}; allowed: {:g} to {:g} {}",
                                inputs.place_of(static_cast<std::size_t>(outside - channel.values.begin())), channel.name,
                                *outside, lower, upper, unit));
  }
}

}  // namespace

std::vector<const Channel*> channels_by_place(const Record& inputs, std::string_view kind,
                                              const std::vector<std::string>& places) {
  const std::string prefix = fmt::format("{}.", kind);
  std::vector<const Channel*> channels;
  channels.reserve(places.size());
  for (const std::string& place : places) {
    channels.push_back(inputs.find(prefix + place));
  }
  for (const Channel& channel : inputs.channels) {
    const std::string_view name = channel.name;
    if (name.starts_with(prefix) && std::find(places.begin(), places.end(), name.substr(prefix.size())) == places.end()) {
      throw FileError(fmt::format("{}:1: {}: the model has no such axis; allowed: {}", inputs.path.string(), name,
                                  fmt::join(places, ", ")));
    }
  }
  return channels;
}

std::vector<Disturbance> disturbances_of(const Record& inputs, std::span<const model::GimbalParameters<double>> gimbals) {
  const int engines = static_cast<int>(gimbals.size());
  std::vector<Disturbance> disturbances;
  add(channels_by_place(inputs, "torque", axis_names(engines)), DisturbanceKind::torque, disturbances);
  add(channels_by_place(inputs, "force", names_of_directions(engines)), DisturbanceKind::force, disturbances);
  add(channels_by_place(inputs, "vibration", axis_names(engines)), DisturbanceKind::vibration, disturbances);
  add(engines == 1 ? std::vector{inputs.find("thrust")} : channels_by_place(inputs, "thrust", names_of_engines(engines)),
      DisturbanceKind::thrust, disturbances);
  for (const Disturbance& one : disturbances) {
    if (one.kind == DisturbanceKind::thrust) {
      require_bounds(inputs, *one.channel, 0.0, kind_of(one).upper, kind_of(one).unit);
    }
    if (one.kind == DisturbanceKind::vibration &&
        gimbals[one.place / 2].friction.law() == model::BearingFriction<double>::Law::vibrated_lugre) {
      throw FileError(
          fmt::format("{}:1: {}: the model's gimbal has law \"vibrated_lugre\"; it and a recorded vibration are two ways "
                      "to the same physics; give one of them",
                      inputs.path.string(), one.channel->name));
    }
  }
  return disturbances;
}

std::vector<Disturbance> disturbances_of(const Record& inputs) {
  std::vector<Disturbance> disturbances;
  add({inputs.find("torque")}, DisturbanceKind::torque, disturbances);
  return disturbances;
}

std::string disturbances_image_text(const Record& inputs, const std::vector<Disturbance>& disturbances) {
  if (disturbances.empty()) {
    throw FileError(fmt::format(
        "{}:1: no channel that disturbs the plant; allowed: torque of one axis; torque.pitch, force.x, vibration.pitch and "
        "thrust of several ('hotfire simulate' reads the same ones)",
        inputs.path.string()));
  }
  const std::size_t most_rows = hal::kMostPlayedValues / disturbances.size();
  if (inputs.rows > most_rows) {
    throw FileError(
        fmt::format("{}: {} rows of {} disturbances; allowed: {} rows; cut the record, or take rows at a longer "
                    "period ('hotfire import', [resample])",
                    inputs.path.string(), inputs.rows, disturbances.size(), most_rows));
  }
  std::string text = fmt::format("disturbance.period {:a}\ndisturbance.rows {}\n", inputs.period, inputs.rows);
  for (std::size_t i = 0; i < disturbances.size(); ++i) {
    const Disturbance& one = disturbances[i];
    const Kind& kind = kind_of(one);
    require_bounds(inputs, *one.channel, kind.lower, kind.upper, kind.unit);
    const std::string key = fmt::format("disturbance.{}.", i);
    text += fmt::format("{0}kind {1}\n{0}place {2}\n{0}values ", key, kind.name, one.place);
    for (const double value : one.channel->values) {
      fmt::format_to(std::back_inserter(text), "{:a},", value);
    }
    text.back() = '\n';
  }
  return text;
}

}  // namespace hotfire
