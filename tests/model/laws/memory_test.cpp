// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/memory.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace hotfire::test {
namespace {

using model::Memory;
using Parameters = model::MemoryParameters<double>;

constexpr double kMemoryStep = 1e-3;
constexpr double kTurn = 2.0 * std::numbers::pi;

Parameters of(Memory kind) {
  Parameters parameters;
  parameters.kind = kind;
  return parameters;
}

/// Complex gain of a linear memory at a frequency [Hz], by correlation over the last ten of forty periods.
std::complex<double> gain_at(const Parameters& parameters, double frequency) {
  model::MemoryState<double> state;
  const auto period = static_cast<int>(std::lround(1.0 / (frequency * kMemoryStep)));
  std::complex<double> gain = 0.0;
  for (int n = 0; n < 40 * period; ++n) {
    // The argument is held over a step: its mean over the step is that of the middle.
    const double phase = kTurn * (n + 0.5) / period;
    const double output = state.step(parameters, std::sin(phase), kMemoryStep);
    if (n >= 30 * period) {
      gain += output * std::exp(std::complex<double>(0.0, -phase)) * std::complex<double>(0.0, 2.0) / (10.0 * period);
    }
  }
  return gain;
}

void check_gain(const Parameters& parameters, double frequency, std::complex<double> wanted) {
  const std::complex<double> gain = gain_at(parameters, frequency);
  // The hold and the mean over a step are wrong by the square of a step's share of a period: (2 pi f h)^2 / 12 of the gain,
  // and the midpoint rule by as much again in its frequency.
  const double error = 0.02;
  DOUBLES_EQUAL(wanted.real(), gain.real(), error);
  DOUBLES_EQUAL(wanted.imag(), gain.imag(), error);
}

}  // namespace

TEST_GROUP(TermMemory){};

TEST(TermMemory, LagAndWashoutAreFirstOrder) {
  for (const double frequency : {1.0, 5.0, 10.0}) {
    const std::complex<double> s(0.0, kTurn * frequency);
    Parameters parameters = of(Memory::lag);
    parameters.time = 0.03;
    check_gain(parameters, frequency, 1.0 / (1.0 + 0.03 * s));
    parameters.kind = Memory::washout;
    check_gain(parameters, frequency, 0.03 * s / (1.0 + 0.03 * s));
  }
}

TEST(TermMemory, ResonanceAndBandPassAreSecondOrder) {
  for (const double frequency : {1.0, 5.0, 10.0}) {
    const std::complex<double> s(0.0, kTurn * frequency);
    const double natural = kTurn * 6.0;
    Parameters parameters = of(Memory::resonance);
    parameters.frequency = 6.0;
    parameters.damping = 0.4;
    const std::complex<double> below = natural * natural + 0.8 * natural * s + s * s;
    check_gain(parameters, frequency, natural * natural / below);
    parameters.kind = Memory::band_pass;
    check_gain(parameters, frequency, 0.8 * natural * s / below);
  }
}

TEST(TermMemory, DelayReadsTheArgumentOfThenAtAnyLength) {
  for (const double delay : {0.4e-3, 3e-3, 17.3e-3, 0.25}) {
    Parameters parameters = of(Memory::delay);
    parameters.time = delay;
    model::MemoryState<double> state;
    double output = 0.0;
    for (int n = 0; n <= 600; ++n) {
      output = state.step(parameters, 5.0 * n * kMemoryStep, kMemoryStep);
    }
    DOUBLES_EQUAL(5.0 * (0.6 - delay), output, 1e-9);
  }
}

TEST(TermMemory, AStopFollowsTheArgumentWithinItsWidthAndTurnsAtOnce) {
  model::MemoryState<double> state;
  const std::array<double, 2> widths{0.5, 2.0};
  const auto last = [&](double argument) { return state.stop(widths, 2, argument); };
  last(0.0);
  const auto forth = last(1.0);
  DOUBLES_EQUAL(0.5, forth[0], 1e-15);
  DOUBLES_EQUAL(1.0, forth[1], 1e-15);
  const auto back = last(0.7);
  DOUBLES_EQUAL(0.2, back[0], 1e-15);
  DOUBLES_EQUAL(0.7, back[1], 1e-15);
}

TEST(TermMemory, APlayFollowsAtItsDistanceAndAStopIsTheRest) {
  model::MemoryState<double> play_state;
  model::MemoryState<double> stop_state;
  Parameters play = of(Memory::play);
  play.width = 0.5;
  Parameters stop = play;
  stop.kind = Memory::stop;
  const std::array<double, 5> arguments{0.0, 0.3, 2.0, 1.6, 0.2};
  const std::array<double, 5> followed{0.0, 0.0, 1.5, 1.5, 0.7};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    DOUBLES_EQUAL(followed[i], play_state.step(play, arguments[i], kMemoryStep), 1e-15);
    DOUBLES_EQUAL(arguments[i] - followed[i], stop_state.step(stop, arguments[i], kMemoryStep), 1e-15);
  }
}

// Two thousand turns: a phase that grew without end would lose its last digits in a float.
TEST(TermMemory, AnOscillatorAdvancesAtItsFrequencyAndItsArgument) {
  Parameters parameters = of(Memory::oscillator);
  parameters.frequency = 6.0;
  parameters.phase = 0.4;
  model::MemoryState<double> state;
  double turns = 0.0;
  for (int n = 0; n < 300000; ++n) {
    const double shift = 1.5 * std::sin(1e-4 * n);
    const double middle = turns + 0.5 * kMemoryStep * (6.0 + shift);
    turns += kMemoryStep * (6.0 + shift);
    DOUBLES_EQUAL(std::sin(kTurn * middle + 0.4), state.step(parameters, shift, kMemoryStep), 1e-8);
  }
}

TEST(TermMemory, SlewFollowsNoFasterThanItsLimit) {
  Parameters parameters = of(Memory::slew);
  parameters.width = 3.0;
  model::MemoryState<double> state;
  state.step(parameters, 0.0, kMemoryStep);
  for (int n = 1; n <= 100; ++n) {
    DOUBLES_EQUAL(n * 3.0 * kMemoryStep, state.step(parameters, 1.0, kMemoryStep), 1e-12);
  }
}

TEST(TermMemory, HoldKeepsTheSampleOfEveryPeriod) {
  Parameters parameters = of(Memory::hold);
  parameters.time = 5.0 * kMemoryStep;
  model::MemoryState<double> state;
  for (int n = 0; n < 50; ++n) {
    DOUBLES_EQUAL(n - n % 5, state.step(parameters, n, kMemoryStep), 1e-12);
  }
}

TEST(TermMemory, TheSamplesOfAHoldComeAsMuchEarlierAsHasPassedAtTheStart) {
  Parameters parameters = of(Memory::hold);
  parameters.time = 5.0 * kMemoryStep;
  parameters.phase = 2.0 * std::numbers::pi * 2.0 / 5.0;
  model::MemoryState<double> state;
  for (int n = 0; n < 50; ++n) {
    DOUBLES_EQUAL(n < 3 ? 0 : n - (n + 2) % 5, state.step(parameters, n, kMemoryStep), 1e-12);
  }
}

TEST(TermMemory, AHoldTakesItsSamplesBetweenTheStepsWhereTheyAreDue) {
  Parameters parameters = of(Memory::hold);
  parameters.time = 2.5 * kMemoryStep;
  model::MemoryState<double> state;
  for (int n = 0; n < 50; ++n) {
    DOUBLES_EQUAL(2.5 * std::floor(n / 2.5), state.step(parameters, n, kMemoryStep), 1e-12);
  }
}

TEST(TermMemory, AHoldOfMeansOverStepsTakesTheValueAtTheInstantOfTheSample) {
  Parameters parameters = of(Memory::hold);
  parameters.mean = 0.5;
  for (const double steps : {5.0, 2.5, 3.25}) {
    parameters.time = steps * kMemoryStep;
    model::MemoryState<double> state;
    for (int n = 0; n < 50; ++n) {
      const double held = state.step(parameters, n + 0.5, kMemoryStep);
      const double due = steps * std::floor(n / steps);
      // The mean over a step is known for half a step back: a sample that was due earlier takes that of the step before.
      DOUBLES_EQUAL(n < steps ? 0.5 : std::max(due, std::ceil(due) - 0.5), held, 1e-12);
    }
  }
}

TEST(TermMemory, MemorylessDistortionsAreWhatTheyAreCalled) {
  model::MemoryState<double> state;
  Parameters parameters = of(Memory::quantise);
  parameters.width = 0.4;
  DOUBLES_EQUAL(0.8, state.step(parameters, 0.93, kMemoryStep), 1e-12);
  parameters.kind = Memory::dead_zone;
  DOUBLES_EQUAL(-0.53, state.step(parameters, -0.93, kMemoryStep), 1e-12);
  parameters.kind = Memory::saturation;
  DOUBLES_EQUAL(-0.4, state.step(parameters, -0.93, kMemoryStep), 1e-12);
  parameters.kind = Memory::periodic;
  DOUBLES_EQUAL(0.13, state.step(parameters, 0.93, kMemoryStep), 1e-12);
}

TEST(TermMemory, APowerIsItsArgumentAtItsWidthAndGoesOnToFourTimesThat) {
  model::MemoryState<double> state;
  for (const Memory kind : {Memory::odd_power, Memory::even_power}) {
    Parameters parameters = of(kind);
    parameters.width = 0.4;
    parameters.exponent = 1.7;
    const double sign = kind == Memory::odd_power ? -1.0 : 1.0;
    DOUBLES_EQUAL(0.4, state.step(parameters, 0.4, kMemoryStep), 1e-12);
    DOUBLES_EQUAL(sign * 0.4 * std::pow(1.75, 1.7), state.step(parameters, -0.7, kMemoryStep), 1e-12);
    DOUBLES_EQUAL(sign * 0.4 * std::pow(4.0, 1.7), state.step(parameters, -1.7, kMemoryStep), 1e-12);
    DOUBLES_EQUAL(0.0, state.step(parameters, 0.0, kMemoryStep), 0.0);
  }
}

TEST(TermMemory, AMemoryThatHasNotStartedRestsUnderItsArgument) {
  for (std::size_t kind = 0; kind < model::kMemoryNames.size(); ++kind) {
    if (static_cast<Memory>(kind) == Memory::oscillator) {
      continue;  // never rests
    }
    Parameters parameters = of(static_cast<Memory>(kind));
    parameters.time = 0.05;
    parameters.width = 100.0;
    model::MemoryState<double> first;
    const double start = first.step(parameters, 0.7, kMemoryStep);
    double later = start;
    for (int n = 0; n < 200; ++n) {
      later = first.step(parameters, 0.7, kMemoryStep);
    }
    DOUBLES_EQUAL(start, later, 1e-12);
  }
}

}  // namespace hotfire::test
