#include "tools/explain/next_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "model/step_size.hpp"
#include "tools/explain/parallel.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180.0;
/// At rest before the profile begins, so that its first cycle counts.
constexpr double kLeadIn = 1.0;
/// Shares of the largest command that are tried as amplitude.
constexpr std::array kAmplitudes{0.1, 0.25, 0.5, 1.0};
constexpr std::array kFrequencies{0.1, 0.3, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0};
constexpr double kSweepSeconds = 20.0;
constexpr double kHoldSeconds = 2.0;
/// Longer has to tell this much more to be worth it.
constexpr double kWorthTheTime = 1.05;

/// A command over time about a bias.
struct Profile {
  std::string words;
  double seconds = 0.0;
  double bias = 0.0;
  std::function<double(double)> about_bias;
};

double triangle(double turns) {
  const double phase = turns - std::floor(turns);
  return phase < 0.25 ? 4.0 * phase : phase < 0.75 ? 2.0 - 4.0 * phase : 4.0 * phase - 4.0;
}

void add_profiles(std::vector<Profile>& profiles, double amplitude, double bias, double highest) {
  const std::string where = bias == 0.0 ? "" : fmt::format(" about {:.3g} deg", bias / kDegree);
  const double degrees = amplitude / kDegree;
  for (const double frequency : kFrequencies) {
    if (frequency > highest) {
      continue;
    }
    const double seconds = std::max(8.0, 2.0 / frequency);
    profiles.push_back({fmt::format("a sine of {:.3g} deg at {:.3g} Hz{}, for {:.0f} s", degrees, frequency, where, seconds),
                        seconds, bias, [=](double t) { return amplitude * std::sin(kTurn * frequency * t); }});
  }
  const double last = std::min(highest, kFrequencies.back());
  const double growth = std::log(last / 0.3) / kSweepSeconds;
  profiles.push_back(
      {fmt::format("a sweep of {:.3g} deg from 0.3 to {:.3g} Hz{}, for {:.0f} s", degrees, last, where, kSweepSeconds),
       kSweepSeconds, bias, [=](double t) { return amplitude * std::sin(kTurn * 0.3 * std::expm1(growth * t) / growth); }});
  profiles.push_back(
      {fmt::format("steps of {:.3g} deg up, back, down and back{}, {:.0f} s each", degrees, where, kHoldSeconds),
       4.0 * kHoldSeconds, bias, [=](double t) {
         constexpr std::array levels{1.0, 0.0, -1.0, 0.0};
         return amplitude * levels[std::min<std::size_t>(3, static_cast<std::size_t>(t / kHoldSeconds))];
       }});
  profiles.push_back({fmt::format("ramps between plus and minus {:.3g} deg at 0.1 Hz{}, for 10 s", degrees, where), 10.0,
                      bias, [=](double t) { return amplitude * triangle(0.1 * t); }});
}

std::vector<double> commands_of(const Profile& profile, double period) {
  std::vector<double> commands;
  const auto rows = static_cast<std::size_t>(std::lround((kLeadIn + profile.seconds) / period));
  commands.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double time = static_cast<double>(row) * period - kLeadIn;
    commands.push_back(profile.bias + (time < 0.0 ? 0.0 : profile.about_bias(time)));
  }
  return commands;
}

/// Rms difference over noise of the largest used channel; zero if one of them can't be simulated.
double separation_under(const std::vector<double>& commands, const Dataset& data, const model::Simplex<double>& one,
                        const model::Simplex<double>& other, int steps) {
  std::vector<std::array<double, 3>> rows;
  rows.reserve(commands.size());
  auto state = one.steady(commands.front());
  const bool ran = run(one, commands, state, steps, [&](std::size_t, const auto& readings) { rows.push_back(readings); });
  std::array<double, 3> square{};
  state = other.steady(commands.front());
  const bool other_ran = ran && run(other, commands, state, steps, [&](std::size_t row, const auto& readings) {
                           for (std::size_t c = 0; c < square.size(); ++c) {
                             const double difference = (readings[c] - rows[row][c]) / data.noise[c];
                             square[c] += data.used[c] ? difference * difference : 0.0;
                           }
                         });
  return other_ran ? std::sqrt(*std::max_element(square.begin(), square.end()) / static_cast<double>(commands.size())) : 0.0;
}

}  // namespace

NextExperiment best_separation(const Dataset& data, const Fitted<SimplexFamily>& one, const Fitted<SimplexFamily>& other,
                               unsigned threads) {
  double largest = 0.0;
  const double period = data.experiments.front().period;
  for (const Experiment& experiment : data.experiments) {
    for (const double command : experiment.input) {
      largest = std::max(largest, std::abs(command));
    }
  }
  std::vector<Profile> profiles;
  for (const double share : kAmplitudes) {
    add_profiles(profiles, share * largest, 0.0, 0.1 / period);
    if (share <= 0.5) {
      add_profiles(profiles, share * largest, 0.5 * largest, 0.1 / period);
    }
  }
  const int steps = model::steps_per_period(period);
  const auto plant_of = [&](const Fitted<SimplexFamily>& fitted) {
    return model::Simplex<double>(Evaluator<SimplexFamily>::with_values(fitted.base, fitted.free, fitted.u), period / steps);
  };
  const model::Simplex<double> first = plant_of(one);
  const model::Simplex<double> second = plant_of(other);
  std::vector<double> separation(profiles.size(), 0.0);
  parallel_for(profiles.size(), threads, [&](std::size_t i) {
    separation[i] = separation_under(commands_of(profiles[i], period), data, first, second, steps);
  });
  std::size_t best = 0;
  for (std::size_t i = 1; i < profiles.size(); ++i) {
    const double worth = profiles[i].seconds > profiles[best].seconds ? kWorthTheTime : 1.0 / kWorthTheTime;
    best = separation[i] > worth * separation[best] ? i : best;
  }
  NextExperiment next{profiles[best].words, separation[best], {}};
  next.command.name = "next_experiment.csv";
  next.command.path = next.command.name;
  next.command.period = period;
  next.command.channels.push_back({"command", "rad", commands_of(profiles[best], period)});
  next.command.rows = next.command.channels.front().values.size();
  return next;
}

}  // namespace hotfire::explain
