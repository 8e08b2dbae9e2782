// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/study/cases/case_parts.hpp"

namespace hotfire::study {
namespace {

/// Random streams of a case.
constexpr std::uint64_t kNoisePart = 4;
constexpr std::uint64_t kControllerPart = 5;
constexpr std::uint64_t kDropOutPart = 6;
constexpr std::uint64_t kZeroPart = 40;
/// The channel that a controller reads and that most faults of a condition are in.
constexpr std::size_t kEngine = 1;

Record record_of(const std::string& name, double period, const std::vector<double>& commands, const ReferenceRows& rows,
                 std::size_t channels) {
  Record record;
  record.name = name + ".csv";
  record.period = period;
  record.rows = rows.size();
  record.channels.push_back({"command", "rad", commands});
  for (std::size_t c = 0; c < channels; ++c) {
    Channel channel{kSensorGrades[c].channel, kSensorGrades[c].unit, {}};
    for (const auto& row : rows) {
      channel.values.push_back(row[c]);
    }
    record.channels.push_back(std::move(channel));
  }
  return record;
}

std::vector<double>& readings(Record& record, std::size_t channel) { return record.channels[channel + 1].values; }

void add_fault(const Condition& condition, Record& record) {
  std::vector<double>& engine = readings(record, kEngine);
  for (double& value : engine) {
    value *= 1.0 + condition.engine_error;
  }
  for (double& value : record.channels.front().values) {
    value *= 1.0 + condition.command_error;
  }
  // Every record starts at rest.
  std::rotate(engine.rbegin(), engine.rbegin() + condition.engine_late, engine.rend());
  std::fill_n(engine.begin(), condition.engine_late, engine[static_cast<std::size_t>(condition.engine_late)]);
}

/// A sensor's readings of a channel.
void read_channel(const Condition& condition, const SensorGrade& grade, double factor, double period,
                  std::vector<double>& values, Random& random) {
  if (condition.noise_corner == 0.0) {
    for (double& value : values) {
      value = noisy(value, grade, factor, random);
    }
    return;
  }
  // First-order autoregression, stationary from the first row on.
  const double stays = std::exp(-2.0 * std::numbers::pi * condition.noise_corner * period);
  double noise = random.normal();
  for (double& value : values) {
    value = quantised(value + grade.noise * factor * noise, grade);
    noise = stays * noise + std::sqrt(1.0 - stays * stays) * random.normal();
  }
}

/// Each channel reads off by a zero of its own.
void add_zeros(const Condition& condition, double factor, Record& record, std::size_t channels, Random& random) {
  for (std::size_t c = 0; c < channels; ++c) {
    const double zero = condition.zeros * factor * kSensorGrades[c].noise * random.normal();
    for (double& value : readings(record, c)) {
      value += zero;
    }
  }
}

void drop_out(const Condition& condition, Record& record, Random& random, std::vector<std::string>& exclusions) {
  const double length = static_cast<double>(record.rows) * record.period;
  for (int i = 0; i < condition.drop_outs; ++i) {
    const double from = random.uniform(0.1, 0.9) * length;
    const double to = std::min(length, from + random.uniform(0.3, 1.5));
    const auto row_at = [&](double time) { return static_cast<std::ptrdiff_t>(std::ceil(time / record.period)); };
    for (std::size_t c = 0; c + 1 < record.channels.size(); ++c) {
      std::vector<double>& values = readings(record, c);
      std::fill(values.begin() + row_at(from), values.begin() + std::min(row_at(to), std::ssize(values)), 0.0);
    }
    // A user names a little more than what is wrong.
    exclusions.push_back(fmt::format("{}@{:.3f}-{:.3f}", record.name, from - 0.05, to + 0.05));
  }
}

void cut_start(const Condition& condition, Record& record) {
  const std::ptrdiff_t rows = std::lround(condition.cut / record.period);
  for (Channel& channel : record.channels) {
    channel.values.erase(channel.values.begin(), channel.values.begin() + rows);
  }
  record.rows -= static_cast<std::size_t>(rows);
  record.start += static_cast<double>(rows) * record.period;
}

/// Rows read at the times of the commands, the first in equilibrium.
ReferenceRows rows_of(const ReferenceAxis& axis, const Profile& profile, double period, const Controller& controller = {},
                      QuantityRows* quantities = nullptr) {
  return integrate_reference(axis, one_row_later(profile.commands), period, kSettling, kIntegratorTolerance, nullptr,
                             controller, quantities);
}

/// An axis with a controller about it that reads the engine's sensor; the record has the commands that were sent.
Record recorded_in_a_loop(const CaseOrder& order, const ReferenceAxis& axis, const Profile& profile, std::uint64_t record,
                          std::size_t channels) {
  const Condition& condition = condition_of(order.condition);
  Random random(order.name, order.seed, kControllerPart + 100 * record);
  std::vector<double> read;
  std::vector<double> sent;
  const Controller controller = [&](double asked, const std::array<double, 3>& reading) {
    read.push_back(noisy(reading[kEngine], kSensorGrades[kEngine], order.noise_factor, random));
    sent.push_back(asked + condition.loop_gain * (asked - read.back()));
    return sent.back();
  };
  const ReferenceRows rows = rows_of(axis, profile, condition.period, controller);
  controller(profile.commands.back(), rows.back());
  // What is sent on a row's reading is that row's command; the first one sent was before the first row.
  sent.erase(sent.begin());
  read.erase(read.begin());
  Record looped = record_of(profile.name, condition.period, sent, rows, channels);
  readings(looped, kEngine) = read;
  return looped;
}

std::size_t channels_of(const CaseOrder& order) { return measures_load_pressure(order) ? 3 : 2; }

}  // namespace

ReferenceRows run(const ReferenceAxis& axis, const Profile& profile, QuantityRows* quantities) {
  return rows_of(axis, profile, kSample, {}, quantities);
}

Record unseen_record(const CaseOrder& order, const Profile& profile, const ReferenceRows& rows) {
  return record_of(profile.name, kSample, profile.commands, rows, channels_of(order));
}

Given recorded(const CaseOrder& order, const ReferenceAxis& axis, const std::vector<Profile>& profiles) {
  const Condition& condition = condition_of(order.condition);
  const std::size_t channels = channels_of(order);
  Given given;
  Random noise(order.name, order.seed, kNoisePart);
  Random drop_outs(order.name, order.seed, kDropOutPart);
  Random zeros(order.name, order.seed, kZeroPart);
  for (const Profile& profile : profiles) {
    const bool in_a_loop = condition.loop_gain != 0.0;
    Record record;
    if (in_a_loop) {
      record = recorded_in_a_loop(order, axis, profile, given.records.size(), channels);
    } else {
      const ReferenceRows rows = rows_of(axis, profile, condition.period);
      record = record_of(profile.name, condition.period, profile.commands, rows, channels);
      add_fault(condition, record);
    }
    for (std::size_t c = 0; c < channels; ++c) {
      if (!in_a_loop || c != kEngine) {
        const double louder = given.records.empty() ? condition.noise_ratio : 1.0;
        read_channel(condition, kSensorGrades[c], louder * order.noise_factor, record.period, readings(record, c), noise);
      }
    }
    add_zeros(condition, order.noise_factor, record, channels, zeros);
    drop_out(condition, record, drop_outs, given.exclusions);
    cut_start(condition, record);
    given.records.push_back(std::move(record));
  }
  return given;
}

}  // namespace hotfire::study
