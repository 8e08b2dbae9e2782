// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/experiment/test_profiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hotfire::explain {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180.0;
/// A lab's cycle, within which a step is asked for [s].
constexpr double kCycle = 1e-3;
/// Shares of the largest command that are tried as amplitude and as bias.
constexpr std::array kAmplitudes{0.1, 0.25, 0.5, 1.0};
constexpr std::array kBiases{0.0, 0.5, -0.5};
constexpr std::array kFrequencies{0.1, 0.3, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0};
constexpr double kFewestPeriods = 2.0;
constexpr double kSweepFrom = 0.3;
constexpr std::array kSineSeconds{4.0, 8.0, 20.0};
constexpr std::array kSweepSeconds{10.0, 20.0, 40.0};
constexpr std::array kHoldSeconds{1.0, 2.0, 5.0};
constexpr std::array kRampSeconds{5.0, 10.0, 20.0};

/// One amplitude about one bias, and what is tried there.
class AboutABias {
 public:
  AboutABias(const CommandLimits& limits, double amplitude, double bias, double highest_frequency)
      : limits_(limits), amplitude_(amplitude), bias_(bias), highest_frequency_(highest_frequency) {}

  bool is_within_limits() const { return bias_ + amplitude_ <= limits_.highest && bias_ - amplitude_ >= limits_.lowest; }

  void add_to(std::vector<TestProfile>& profiles) const {
    for (const double frequency : kFrequencies) {
      double last = 0.0;
      for (const double seconds : kSineSeconds) {
        const double periods = std::max(kFewestPeriods, std::ceil(seconds * frequency));
        if (is_slow_enough(frequency) && periods > last) {
          profiles.push_back(sine(frequency, periods));
        }
        last = periods;
      }
    }
    const double last = std::min({highest_frequency_, kFrequencies.back(), limits_.rate / (kTurn * amplitude_)});
    for (std::size_t i = 0; i < kSweepSeconds.size(); ++i) {
      if (last > kSweepFrom) {
        profiles.push_back(sweep(last, kSweepSeconds[i]));
      }
      if (amplitude_ / kCycle <= limits_.rate) {
        profiles.push_back(steps(kHoldSeconds[i]));
      }
      if (4.0 * amplitude_ / kRampSeconds[i] <= limits_.rate) {
        profiles.push_back(ramps(kRampSeconds[i]));
      }
    }
  }

 private:
  bool is_slow_enough(double frequency) const {
    return frequency <= highest_frequency_ && kTurn * frequency * amplitude_ <= limits_.rate;
  }

  std::string about() const { return bias_ == 0.0 ? "" : fmt::format(" about {:.3g} deg", bias_ / kDegree); }

  TestProfile made(const std::string& words, double seconds, std::function<double(double)> about_bias,
                   const std::string& part) const {
    const std::string rest = fmt::format("[[profile]]\nkind = \"table\"\ntimes = [0, {}]\ncommands = [{}, {}]\n",
                                         TestProfile::kLeadIn, bias_, bias_);
    return {words, seconds, bias_, std::move(about_bias), rest + "[[profile]]\n" + part};
  }

  TestProfile sine(double frequency, double periods) const {
    const double seconds = periods / frequency;
    return made(
        fmt::format("a sine of {:.3g} deg at {:.3g} Hz{}, for {:.3g} s", amplitude_ / kDegree, frequency, about(), seconds),
        seconds, [=, a = amplitude_](double t) { return a * std::sin(kTurn * frequency * t); },
        fmt::format("kind = \"sines\"\namplitudes = [{}]\nfrequencies = [{}]\nperiods = {}\nbias = {}\n", amplitude_,
                    frequency, static_cast<int>(periods), bias_));
  }

  TestProfile sweep(double last, double seconds) const {
    const double growth = std::log(last / kSweepFrom) / seconds;
    return made(
        fmt::format("a sweep of {:.3g} deg from {:.3g} to {:.3g} Hz{}, for {:.3g} s", amplitude_ / kDegree, kSweepFrom, last,
                    about(), seconds),
        seconds,
        [=, a = amplitude_](double t) { return a * std::sin(kTurn * kSweepFrom * std::expm1(growth * t) / growth); },
        fmt::format("kind = \"sweep\"\namplitude = {}\nfrom = {}\nto = {}\nduration = {}\nbias = {}\n", amplitude_,
                    kSweepFrom, last, seconds, bias_));
  }

  TestProfile steps(double hold) const {
    const double a = amplitude_;
    const double b = bias_;
    return made(
        fmt::format("steps of {:.3g} deg up, back, down and back{}, {:.3g} s each", a / kDegree, about(), hold), 4.0 * hold,
        [=](double t) {
          constexpr std::array levels{1.0, 0.0, -1.0, 0.0};
          return a * levels[std::min<std::size_t>(3, static_cast<std::size_t>(t / hold))];
        },
        fmt::format("kind = \"steps\"\nlevels = [{}, {}, {}, {}]\nhold = {}\n", b + a, b, b - a, b, hold));
  }

  TestProfile ramps(double seconds) const {
    const double a = amplitude_;
    const double b = bias_;
    return made(
        fmt::format("a triangle of {:.3g} deg up and down{}, for {:.3g} s", a / kDegree, about(), seconds), seconds,
        [=](double t) {
          const double phase = std::min(1.0, t / seconds);
          return a * (phase < 0.25 ? 4.0 * phase : phase < 0.75 ? 2.0 - 4.0 * phase : 4.0 * phase - 4.0);
        },
        fmt::format("kind = \"table\"\ntimes = [0, {}, {}, {}]\ncommands = [{}, {}, {}, {}]\n", 0.25 * seconds,
                    0.75 * seconds, seconds, b, b + a, b - a, b));
  }

  CommandLimits limits_;
  double amplitude_;
  double bias_;
  double highest_frequency_;
};

}  // namespace

std::vector<double> TestProfile::commands(double period) const {
  std::vector<double> commands;
  const auto rows = static_cast<std::size_t>(std::lround((kLeadIn + seconds) / period));
  commands.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double time = static_cast<double>(row) * period - kLeadIn;
    commands.push_back(bias + (time < 0.0 ? 0.0 : about_bias(time)));
  }
  return commands;
}

std::vector<TestProfile> test_profiles(const CommandLimits& limits, double highest_frequency) {
  const double largest = std::max(std::abs(limits.lowest), std::abs(limits.highest));
  std::vector<TestProfile> profiles;
  for (const double amplitude : kAmplitudes) {
    for (const double bias : kBiases) {
      const AboutABias family(limits, amplitude * largest, bias * largest, highest_frequency);
      if (family.is_within_limits()) {
        family.add_to(profiles);
      }
    }
  }
  return profiles;
}

}  // namespace hotfire::explain
