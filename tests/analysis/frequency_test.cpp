// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/analysis/resonance.hpp"
#include "tools/analysis/sines.hpp"
#include "tools/analysis/welch.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::analysis {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// A first-order lag with a corner at 5 Hz under input held over the sampling period: exact at any period.
std::vector<double> lagged(const std::vector<double>& input) {
  const double share = 1.0 - std::exp(-kTurn * 5.0 * kPeriod);
  std::vector<double> output;
  double state = 0.0;
  for (const double value : input) {
    output.push_back(state);
    state += share * (value - state);
  }
  return output;
}

/// Its response by the z-transform of that recursion.
std::complex<double> lag_response(double frequency) {
  const double share = 1.0 - std::exp(-kTurn * 5.0 * kPeriod);
  const std::complex<double> z = std::polar(1.0, kTurn * frequency * kPeriod);
  return share / (z - (1.0 - share));
}

std::vector<double> noise(std::size_t rows, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> values(rows);
  std::generate(values.begin(), values.end(), [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; });
  return values;
}

std::vector<double> sines(const std::vector<double>& frequencies, double amplitude) {
  std::vector<double> command;
  for (const double frequency : frequencies) {
    const auto rows = static_cast<std::size_t>(10.0 / frequency / kPeriod);
    for (std::size_t k = 0; k < rows; ++k) {
      command.push_back(amplitude * std::sin(kTurn * frequency * kPeriod * static_cast<double>(k)));
    }
  }
  command.push_back(0.0);
  return command;
}

/// Gain of a pair of zeros over a pair of well damped poles, sampled in frequency.
FrequencyResponse notched(double zero, double damping, double spacing) {
  FrequencyResponse response;
  for (double frequency = 4.0; frequency < 14.0; frequency += spacing) {
    const std::complex<double> s(0.0, frequency);
    response.push_back({frequency, (s * s + 2.0 * damping * zero * s + zero * zero) / (s * s + 10.0 * s + 36.0), 1.0});
  }
  return response;
}

}  // namespace

TEST_GROUP(FrequencyResponse){};

// The error of the mean of 60 overlapping segments without noise is leakage of the window, which the lag's smooth response
// keeps under a hundredth.
TEST(FrequencyResponse, WelchFindsALagInNoiseThatPassesIt) {
  const std::vector<double> input = noise(60000, 3);
  const FrequencyResponse response = welch_response(input, lagged(input), kPeriod, {2000}, 1.0, 50.0);
  LONGS_EQUAL(99, response.size());
  for (const ResponsePoint& point : response) {
    CHECK_TRUE(std::abs(point.gain - lag_response(point.frequency)) < 0.02 * std::abs(lag_response(point.frequency)));
    CHECK_TRUE(point.coherence > 0.99);
  }
}

// Lines 0.25 Hz apart beside a lag of 32 ms, which one repeat of 4 s settles: only rounding is left.
TEST(FrequencyResponse, OneRepeatOfAPeriodicInputGivesItsResponseExactlyAtEveryLineAndNowhereElse) {
  constexpr std::size_t kRows = 4000;
  std::vector<double> input;
  for (std::size_t k = 0; k < 2 * kRows; ++k) {
    double value = 0.3;
    for (const int line : {9, 12, 40}) {
      value += std::sin(kTurn * 0.25 * line * kPeriod * static_cast<double>(k) + line);
    }
    input.push_back(value);
  }
  const std::vector<double> output = lagged(input);
  const FrequencyResponse response =
      periodic_response(std::span(input).last(kRows), std::span(output).last(kRows), kPeriod, 2.5, 20.0);
  CHECK_EQUAL(2, response.size());
  for (const ResponsePoint& point : response) {
    CHECK_TRUE(std::abs(point.gain - lag_response(point.frequency)) < 1e-9);
  }
  DOUBLES_EQUAL(3.0, response.front().frequency, 1e-9);
  DOUBLES_EQUAL(10.0, response.back().frequency, 1e-9);
}

// As much independent noise as signal leaves half of the output's power to the input.
TEST(FrequencyResponse, CoherenceIsTheShareOfTheOutputThatTheInputMakes) {
  const std::vector<double> input = noise(200000, 4);
  const std::vector<double> other = noise(200000, 5);
  std::vector<double> output = input;
  for (std::size_t k = 0; k < output.size(); ++k) {
    output[k] += other[k];
  }
  double mean = 0.0;
  const FrequencyResponse response = welch_response(input, output, kPeriod, {2000}, 1.0, 100.0);
  for (const ResponsePoint& point : response) {
    mean += point.coherence / static_cast<double>(response.size());
  }
  DOUBLES_EQUAL(0.5, mean, 0.02);
}

// White noise of variance 1/3 over 500 Hz.
TEST(FrequencyResponse, ASpectrumHasThePowerOfItsSignal) {
  const Spectrum spectrum = welch_spectrum(noise(100000, 6), kPeriod, {1000});
  double power = 0.0;
  for (const double density : spectrum.density) {
    power += density * spectrum.resolution;
  }
  DOUBLES_EQUAL(1.0 / 3.0, power, 0.01);
}

TEST(FrequencyResponse, DwellsAreFoundInTheCommandItself) {
  const std::vector<double> frequencies{0.7, 2.0, 6.25, 7.0, 13.75, 14.0};
  std::vector<double> command(500, 0.0);
  const std::vector<double> sine = sines(frequencies, 0.01);
  command.insert(command.end(), sine.begin(), sine.end());
  const std::vector<Dwell> dwells = find_dwells(command, kPeriod);
  LONGS_EQUAL(frequencies.size(), dwells.size());
  for (std::size_t d = 0; d < dwells.size(); ++d) {
    DOUBLES_EQUAL(frequencies[d], dwells[d].frequency, 1e-3 * frequencies[d]);
    DOUBLES_EQUAL(0.01, dwells[d].amplitude, 1e-4);
    DOUBLES_EQUAL(10.0 / frequencies[d] / kPeriod, static_cast<double>(dwells[d].rows), 2.0);
  }
  LONGS_EQUAL(0, find_dwells(noise(5000, 1), kPeriod).size());
  LONGS_EQUAL(0, find_dwells(std::vector<double>(5000, 0.3), kPeriod).size());
}

// What the response has not settled to by half of its ten periods is e^-(2 pi 5 / (f / 5)) of it: nothing.
// At 9 Hz a quarter of a percent is a quarter of a row a period. A converter's steps of an amplitude's 400th move a crossing
// by a twentieth of a row.
TEST(FrequencyResponse, DwellsAQuarterOfAPercentApartAreToldApartInACommandThatIsReadInSteps) {
  for (const double step : {0.0, 1.0 / 400.0}) {
    std::vector<double> frequencies;
    for (int k = 0; k < 20; ++k) {
      frequencies.push_back(9.0 * std::pow(1.0025, k));
    }
    std::vector<double> command = sines(frequencies, 1.0);
    for (double& value : command) {
      value = step > 0.0 ? step * std::round(value / step) : value;
    }
    const std::vector<Dwell> dwells = find_dwells(command, kPeriod);
    CHECK_EQUAL(frequencies.size(), dwells.size());
    for (std::size_t k = 0; k < dwells.size(); ++k) {
      DOUBLES_EQUAL(frequencies[k], dwells[k].frequency, 1e-3 * frequencies[k]);
    }
  }
}

TEST(FrequencyResponse, SineBySineFindsTheLagAtEveryDwell) {
  const std::vector<double> command = sines({0.7, 2.0, 6.25, 7.0, 13.75, 14.0}, 0.01);
  const auto responses = sine_responses(command, lagged(command), kPeriod, find_dwells(command, kPeriod));
  LONGS_EQUAL(1, responses.size());
  LONGS_EQUAL(6, responses[0].response.size());
  for (const ResponsePoint& point : responses[0].response) {
    CHECK_TRUE(std::abs(point.gain - lag_response(point.frequency)) < 3e-3);
    CHECK_TRUE(point.coherence > 0.999);
  }
}

TEST(FrequencyResponse, ANotchIsFoundBetweenThePointsOfItsGrid) {
  for (const double zero : {7.76, 9.31, 9.5}) {
    const auto notch = find_notch(notched(zero, 0.01, 0.25), 4.0, 14.0);
    CHECK_TRUE(notch.has_value());
    DOUBLES_EQUAL(zero, notch->frequency, 0.005 * zero);
    CHECK_TRUE(notch->depth > 15.0);
  }
}

TEST(FrequencyResponse, ASmoothResponseHasNeitherNotchNorPeak) {
  FrequencyResponse lag;
  for (double frequency = 1.0; frequency < 20.0; frequency += 0.5) {
    lag.push_back({frequency, lag_response(frequency), 1.0});
  }
  CHECK_FALSE(find_notch(lag, 1.0, 20.0).has_value());
  CHECK_FALSE(find_peak(lag, 1.0, 20.0).has_value());
}

TEST(FrequencyResponse, APeakIsThatOfItsResonance) {
  FrequencyResponse response = notched(6.5, 0.02, 0.25);
  for (ResponsePoint& point : response) {
    const std::complex<double> s(0.0, point.frequency);
    point.gain = 1.0 / (s * s + 2.0 * 0.02 * 6.5 * s + 6.5 * 6.5);
  }
  DOUBLES_EQUAL(6.5, find_peak(response, 4.0, 14.0)->frequency, 0.02);
}

TEST_GROUP(Chart){};

TEST(Chart, IsOneSvgWithEveryPanelAndLeavesOutWhatIsNoNumber) {
  const std::string picture =
      svg({"a < b", "time [s]", false, {{"gain", {{"one", {0, 1, 2}, {1, std::nan(""), 3}}}}, {"phase", {}}}});
  STRCMP_CONTAINS("a &lt; b", picture.c_str());
  STRCMP_CONTAINS("phase", picture.c_str());
  CHECK_TRUE(picture.find("nan") == std::string::npos);
  CHECK_TRUE(picture.ends_with("</svg>\n"));
}

}  // namespace hotfire::analysis
