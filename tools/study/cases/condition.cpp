// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/condition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/files/text/error.hpp"

namespace hotfire::study {
namespace {

using Records = Condition::Records;

constexpr Condition kUsual{.name = ""};
constexpr std::array kHard{
    Condition{.name = "50-hertz", .period = 20e-3},
    Condition{.name = "5-kilohertz", .records = Records::one, .period = 2e-4},
    Condition{.name = "one-record", .records = Records::one},
    Condition{.name = "ten-records", .records = Records::ten},
    Condition{.name = "small-commands", .command_size = 0.2},
    // Less than half a second after a step, and in the middle of a sweep and of a ramp.
    Condition{.name = "moving-start", .cut = 5.4},
    Condition{.name = "closed-loop", .loop_gain = 0.3},
    Condition{.name = "coloured-noise", .noise_corner = 20.0},
    Condition{.name = "clock-offset", .engine_late = 2},
    Condition{.name = "mis-scaled", .engine_error = 0.05},
    Condition{.name = "mis-scaled-command", .command_error = -0.1},
    Condition{.name = "drop-outs", .drop_outs = 3},
    Condition{.name = "zeros", .zeros = 20.0},
    Condition{.name = "null-bias", .null_bias = 0.02},
    Condition{.name = "unequal-noise", .noise_ratio = 10.0},
};

/// Three profiles are given: the stream of the first three, and of those that follow.
constexpr std::uint64_t kProfilePart = 3;
constexpr std::uint64_t kFurtherProfilePart = 30;

/// Ten records of 6 to 28.5 s, sweeps, steps and ramps in turn.
std::vector<Profile> ten_profiles(const std::string& name, std::uint64_t seed) {
  std::vector<Profile> profiles;
  for (std::uint64_t i = 0; i < 10; ++i) {
    Profile profile = given_profiles(Random(name, seed, kFurtherProfilePart + i))[i % 3];
    const double seconds = 6.0 + 2.5 * static_cast<double>(i);
    profile.commands.resize(std::min(profile.commands.size(), static_cast<std::size_t>(std::lround(seconds / kSample))));
    profile.name += fmt::format("-{}", i);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

/// Every row of a slower record is held until the next; of a faster one, several rows hold one command.
std::vector<double> with_period(const std::vector<double>& commands, double period) {
  std::vector<double> rows;
  const auto count = static_cast<std::size_t>(std::lround(static_cast<double>(commands.size()) * kSample / period));
  rows.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // Half a row keeps a row's time off the edge of its neighbour.
    const double at = (static_cast<double>(i) * period + 0.5 * std::min(period, kSample)) / kSample;
    rows.push_back(commands[std::min(commands.size() - 1, static_cast<std::size_t>(at))]);
  }
  return rows;
}

}  // namespace

std::string_view Condition::fault() const {
  if (engine_late != 0) {
    return "sensor_delay";
  }
  return engine_error != 0.0 ? "sensor_scale" : command_error != 0.0 ? "command_scale" : "";
}

std::span<const Condition> hard_conditions() { return kHard; }

const Condition& condition_of(std::string_view name) {
  if (name.empty()) {
    return kUsual;
  }
  std::string names;
  for (const Condition& condition : kHard) {
    if (condition.name == name) {
      return condition;
    }
    names += fmt::format("{}{}", names.empty() ? "" : ", ", condition.name);
  }
  throw UsageError(fmt::format("\"{}\" is not a condition of the study; these are: {}", name, names));
}

std::vector<Profile> conditioned_profiles(const Condition& condition, const std::string& name, std::uint64_t seed) {
  std::vector<Profile> profiles =
      condition.records == Records::ten ? ten_profiles(name, seed) : given_profiles(Random(name, seed, kProfilePart));
  if (condition.records == Records::one) {
    profiles = {profiles[seed % profiles.size()]};
  }
  for (Profile& profile : profiles) {
    for (double& command : profile.commands) {
      command *= condition.command_size;
    }
    if (condition.period != kSample) {
      profile.commands = with_period(profile.commands, condition.period);
    }
  }
  return profiles;
}

}  // namespace hotfire::study
