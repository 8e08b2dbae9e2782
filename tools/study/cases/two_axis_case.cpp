// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tools/study/cases/case_parts.hpp"

namespace hotfire::study {
namespace {

constexpr std::array<const char*, 2> kAxes{"pitch", "yaw"};

using Axes = std::array<ReferenceAxis, 2>;
using AxisRows = std::array<ReferenceRows, 2>;

/// Commands of both axes, one a sample.
struct TwoProfiles {
  std::string name;
  std::array<std::vector<double>, 2> commands;
};

/// Pitch as a single axis is driven; yaw by the profile of another random stream, backwards and cut or filled with zeros to
/// the same length, so that the two never do the same at the same time.
TwoProfiles beside(const Profile& pitch, const Profile& yaw) {
  std::vector<double> other(yaw.commands.rbegin(), yaw.commands.rend());
  other.resize(pitch.commands.size(), 0.0);
  return {pitch.name, {pitch.commands, other}};
}

AxisRows run(const Axes& axes, const TwoProfiles& profiles) {
  return integrate_reference_pair(axes, {one_row_later(profiles.commands[0]), one_row_later(profiles.commands[1])}, kSample,
                                  kSettling, kIntegratorTolerance);
}

/// A torque from the other axis of either sign; every second seed has damping as well.
void plan_cross_axis(Plan& plan, Random& random, std::uint64_t seed) {
  plan.axis.cross_stiffness = random.sign() * random.log_uniform(1e5, 1.5e6);
  plan.values["stiffness"] = plan.axis.cross_stiffness;
  if (seed % 2 == 0) {
    plan.axis.cross_damping = random.sign() * random.log_uniform(3e3, 4e4);
    plan.values["damping"] = plan.axis.cross_damping;
  }
}

/// A hose that hangs until the other axis has turned far enough one way, and pulls from there.
void plan_cross_hose(Plan& plan, Random& random, std::uint64_t) {
  plan.axis.unlisted.hose = random.sign() * random.log_uniform(2e5, 2e6);
  plan.axis.unlisted.hose_slack = random.uniform(-0.005, 0.015);
  plan.values["hose"] = plan.axis.unlisted.hose;
  plan.values["hose_slack"] = plan.axis.unlisted.hose_slack;
}

std::map<std::string, double> difference(const AxisRows& a, const AxisRows& b, double noise_factor) {
  std::map<std::string, double> sizes;
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    for (std::size_t c = 0; c < 2; ++c) {
      sizes[fmt::format("{}.{}", kSensorGrades[c].channel, kAxes[axis])] =
          rms_of_difference(a[axis], b[axis], c) / (kSensorGrades[c].noise * noise_factor);
    }
  }
  return sizes;
}

/// Puts an effect into the plan of its axis, with the first of the drawn magnitudes that shows as it should.
void add_effect(const std::string& name, const CaseOrder& order, const TwoProfiles& unseen, const AxisRows& plain_rows,
                std::array<Plan, 2>& plans) {
  const auto dot = name.rfind('.');
  const std::string effect = name.substr(0, dot);
  const std::size_t which = name.substr(dot + 1) == kAxes[0] ? 0 : 1;
  const auto plan_effect = effect == "cross_axis" ? plan_cross_axis
                           : effect == kCrossHose ? plan_cross_hose
                                                  : studied_effect(effect).plan;
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    Random random(name + "/" + order.name, order.seed, 100 + draw);
    std::array<Plan, 2> tried = plans;
    tried[which].values.clear();
    plan_effect(tried[which], random, order.seed);
    const auto size = difference(run({tried[0].axis, tried[1].axis}, unseen), plain_rows, order.noise_factor);
    const double largest =
        std::max_element(size.begin(), size.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->second;
    if (largest >= kSmallestEffect && largest <= kLargestEffect) {
      for (const auto& [key, value] : plans[which].values) {
        tried[which].values.insert({key, value});
      }
      plans = tried;
      return;
    }
  }
  throw std::runtime_error(fmt::format("{} with seed {}: no magnitude of {} drawn shows at {} to {} times the sensor noise",
                                       order.name, order.seed, name, kSmallestEffect, kLargestEffect));
}

Record record_of(const TwoProfiles& profiles, const AxisRows& rows, std::size_t channels) {
  Record record;
  record.name = profiles.name + ".csv";
  record.period = kSample;
  record.rows = rows[0].size();
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    record.channels.push_back({fmt::format("command.{}", kAxes[axis]), "rad", profiles.commands[axis]});
    for (std::size_t c = 0; c < channels; ++c) {
      Channel channel{fmt::format("{}.{}", kSensorGrades[c].channel, kAxes[axis]), kSensorGrades[c].unit, {}};
      for (const auto& row : rows[axis]) {
        channel.values.push_back(row[c]);
      }
      record.channels.push_back(std::move(channel));
    }
  }
  return record;
}

}  // namespace

StudyCase make_two_axis_case(const CaseOrder& order) {
  StudyCase made;
  made.order = order;
  std::array<Plan, 2> plans;
  for (std::size_t axis = 0; axis < plans.size(); ++axis) {
    plans[axis].axis = plans[axis].without = scattered_axis(order, 1 + 10 * axis);
  }
  const TwoProfiles unseen =
      beside(unseen_profile(Random(order.name, order.seed, 2)), unseen_profile(Random(order.name, order.seed, 12)));
  const AxisRows plain_rows = run({plans[0].axis, plans[1].axis}, unseen);
  for (const std::string& name : order.effects) {
    add_effect(name, order, unseen, plain_rows, plans);
  }
  const Axes axes{plans[0].axis, plans[1].axis};
  const std::size_t channels = measures_load_pressure(order) ? 3 : 2;
  const AxisRows truth = order.effects.empty() ? plain_rows : run(axes, unseen);
  made.unseen = record_of(unseen, truth, channels);
  made.effect_size = difference(truth, plain_rows, order.noise_factor);
  made.plan = plans[0];
  made.yaw = plans[1].axis;
  made.plan.values.clear();
  made.plan.law.clear();
  for (std::size_t axis = 0; axis < plans.size(); ++axis) {
    made.plan.law += plans[axis].law;
    for (const auto& [key, value] : plans[axis].values) {
      made.plan.values[fmt::format("{}.{}", kAxes[axis], key)] = value;
    }
  }

  const std::vector<Profile> pitch = given_profiles(Random(order.name, order.seed, 3));
  const std::vector<Profile> yaw = given_profiles(Random(order.name, order.seed, 13));
  Random noise(order.name, order.seed, 4);
  for (std::size_t i = 0; i < pitch.size(); ++i) {
    const TwoProfiles profiles = beside(pitch[i], yaw[pitch.size() - 1 - i]);
    made.given.push_back(record_of(profiles, run(axes, profiles), channels));
    for (Channel& channel : made.given.back().channels) {
      const auto grade = std::find_if(kSensorGrades.begin(), kSensorGrades.end(),
                                      [&](const SensorGrade& g) { return channel.name.starts_with(g.channel); });
      for (double& value : channel.values) {
        value = grade == kSensorGrades.end() ? value : noisy(value, *grade, order.noise_factor, noise);
      }
    }
  }
  made.declared = model_toml({}, order, "");
  return made;
}

}  // namespace hotfire::study
