// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/profiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace hotfire::study {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Commands in parts that follow each other.
class Commands {
 public:
  void hold(double seconds, double angle = 0.0) {
    append(seconds, [=](double) { return angle; });
  }
  void sine(double seconds, double amplitude, double frequency) {
    append(seconds, [=](double t) { return amplitude * std::sin(kTurn * frequency * t); });
  }
  /// The frequency grows by the same factor in the same time.
  void sweep(double seconds, double amplitude, double from, double to) {
    const double rate = std::log(to / from) / seconds;
    append(seconds, [=](double t) { return amplitude * std::sin(kTurn * from * std::expm1(rate * t) / rate); });
  }
  void triangle(double seconds, double amplitude, double period) {
    append(seconds, [=](double t) {
      const double phase = t / period - std::floor(t / period);
      return amplitude * (phase < 0.25 ? 4.0 * phase : phase < 0.75 ? 2.0 - 4.0 * phase : 4.0 * phase - 4.0);
    });
  }
  void append(double seconds, const std::function<double(double)>& angle) {
    const long rows = std::lround(seconds / kSample);
    for (long i = 0; i < rows; ++i) {
      angles_.push_back(angle(static_cast<double>(i) * kSample));
    }
  }
  std::vector<double> take() { return std::move(angles_); }

 private:
  std::vector<double> angles_;
};

}  // namespace

std::vector<Profile> given_profiles(Random random) {
  const auto about = [&](double value) { return value * random.uniform(0.9, 1.1); };
  std::vector<Profile> profiles;

  Commands sweep;
  sweep.hold(1.0);
  sweep.sweep(30.0, about(0.4) * kDegree, about(0.4), about(6.2));
  sweep.hold(1.0);
  sweep.sweep(20.0, about(0.8) * kDegree, about(7.0), about(14.0));
  profiles.push_back({"sweep", sweep.take()});

  Commands steps;
  steps.hold(1.0);
  for (const double size : {0.6, 0.4, 0.2}) {
    const double angle = about(size) * kDegree;
    for (const double level : {angle, 0.0, -angle, 0.0}) {
      steps.hold(2.0, level);
    }
  }
  profiles.push_back({"steps", steps.take()});

  Commands ramps;
  ramps.hold(1.0);
  ramps.triangle(20.0, about(0.5) * kDegree, 10.0);
  ramps.hold(1.5);
  ramps.triangle(10.0, std::min(6.0, about(6.0)) * kDegree, 10.0);
  ramps.hold(1.5);
  ramps.sine(8.0, about(2.0) * kDegree, 0.5);
  ramps.hold(1.0);
  ramps.sweep(11.0, about(0.1) * kDegree, 0.4, about(12.0));
  profiles.push_back({"ramps", ramps.take()});
  return profiles;
}

Profile unseen_profile(Random random) {
  struct Line {
    double amplitude = 0.0;
    double frequency = 0.0;
    double phase = 0.0;
  };
  std::array<Line, 12> lines{};
  for (Line& line : lines) {
    line = {random.uniform(0.1, 0.25) * kDegree, random.log_uniform(0.3, 8.0), random.uniform(0.0, kTurn)};
  }
  Commands commands;
  commands.hold(1.0);
  commands.append(24.0, [&](double t) {
    double angle = 0.0;
    for (const Line& line : lines) {
      angle += line.amplitude * std::sin(kTurn * line.frequency * t + line.phase);
    }
    // Faded in and out, so that its ends are no steps.
    return angle * std::min({1.0, t, 24.0 - t});
  });
  commands.hold(1.0);
  for (const double size : {0.5, -0.3, 0.15, 1.2}) {
    commands.hold(2.4, size * random.uniform(0.9, 1.1) * kDegree);
  }
  commands.hold(3.4);
  commands.sweep(11.0, 0.25 * kDegree, 0.5, 12.0);
  commands.hold(1.0);
  commands.triangle(8.0, 6.0 * kDegree, 8.0);
  return {"score_noisefree", commands.take()};
}

}  // namespace hotfire::study
