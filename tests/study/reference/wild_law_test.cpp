// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/wild_law.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::study {
namespace {

constexpr double kSample = 2e-3;
constexpr double kTolerance = 1e-9;
constexpr double kAngle = 0.02;
constexpr std::size_t kRest = 25;  ///< rows before the command moves

double time_of(std::size_t row) { return static_cast<double>(row + 1) * kSample; }

std::vector<double> step_command() {
  std::vector<double> commands(300, kAngle);
  std::fill_n(commands.begin(), kRest, 0.0);
  return commands;
}

std::vector<double> sine_command(double frequency = 1.5) {
  std::vector<double> commands(600, 0.0);
  for (std::size_t i = kRest; i < commands.size(); ++i) {
    const double t = static_cast<double>(i - kRest) * kSample;
    commands[i] = kAngle * std::sin(2.0 * std::numbers::pi * frequency * t);
  }
  return commands;
}

ReferenceRows rows_with(ReferenceAxis axis, const WildLaw& law, const std::vector<double>& commands) {
  axis.wild = std::make_shared<const WildLaw>(law);
  return integrate_reference(axis, commands, kSample, 0.0, kTolerance);
}

ReferenceRows rows_of(const ReferenceAxis& axis, const std::vector<double>& commands) {
  return integrate_reference(axis, commands, kSample, 0.0, kTolerance);
}

/// What a memory over the command, in units of `kAngle`, adds to the engine's reading.
std::vector<double> output_of(const WildMemory& memory, const std::vector<double>& commands) {
  WildLaw law;
  law.site = WildSite::engine_sensor;
  law.argument = WildArgument::command;
  law.scale = kAngle;
  law.memory = memory;
  law.amplitude = 1.0;
  const ReferenceRows with = rows_with({}, law, commands);
  const ReferenceRows without = rows_of({}, commands);
  std::vector<double> output;
  for (std::size_t i = 0; i < with.size(); ++i) {
    output.push_back(with[i][1] - without[i][1]);
  }
  return output;
}

WildLaw line(WildSite site, WildArgument argument, double amplitude) {
  WildLaw law;
  law.site = site;
  law.argument = argument;
  law.amplitude = amplitude;
  return law;
}

/// Of how much two runs differ, as a part of the motion, and how much that motion is changed by the law itself.
void check_same(const ReferenceRows& a, const ReferenceRows& b, const ReferenceRows& plain) {
  double apart = 0.0;
  double moved = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    apart = std::max(apart, std::abs(a[i][1] - b[i][1]));
    moved = std::max(moved, std::abs(a[i][1] - plain[i][1]));
  }
  CHECK_TRUE_TEXT(moved > 1e-5, "the law does something");
  CHECK_TRUE_TEXT(apart < 1e-3 * moved, "and what the declared parameter does");
}

}  // namespace

TEST_GROUP(WildMemories){};

TEST(WildMemories, AFirstOrderLagAndItsWashoutAddUpToTheirInput) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::first_order;
  memory.time = 0.08;
  const auto lagged = output_of(memory, step_command());
  memory.kind = WildMemory::Kind::washout;
  const auto washed = output_of(memory, step_command());
  for (std::size_t i = 0; i < lagged.size(); ++i) {
    const double since = time_of(i) - kRest * kSample;
    DOUBLES_EQUAL(since > 0.0 ? -std::expm1(-since / memory.time) : 0.0, lagged[i], 1e-6);
    DOUBLES_EQUAL(since > 1e-9 ? 1.0 : 0.0, lagged[i] + washed[i], 1e-6);
  }
}

// 1 - e^{-a t} (cos(b t) + a / b sin(b t)) with a = zeta w, b = w sqrt(1 - zeta^2).
TEST(WildMemories, ASecondOrderLagAnswersAStepByItsClosedForm) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::second_order;
  memory.frequency = 4.0;
  memory.damping = 0.3;
  const double natural = 2.0 * std::numbers::pi * memory.frequency;
  const double a = memory.damping * natural;
  const double b = natural * std::sqrt(1.0 - memory.damping * memory.damping);
  const auto output = output_of(memory, step_command());
  for (std::size_t i = kRest; i < output.size(); ++i) {
    const double t = time_of(i) - kRest * kSample;
    DOUBLES_EQUAL(1.0 - std::exp(-a * t) * (std::cos(b * t) + a / b * std::sin(b * t)), output[i], 1e-5);
  }
}

TEST(WildMemories, ALeakyIntegralOfAStepRisesToItsTimeConstant) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::leaky_integral;
  memory.time = 0.2;
  const auto output = output_of(memory, step_command());
  DOUBLES_EQUAL(-memory.time * std::expm1(-(time_of(299) - kRest * kSample) / memory.time), output.back(), 1e-6);
}

TEST(WildMemories, ADelayGivesWhatEnteredThatLongAgo) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::delay;
  memory.time = 20 * kSample;
  const auto commands = sine_command();
  const auto output = output_of(memory, commands);
  for (std::size_t i = 60; i < output.size(); ++i) {
    // Row i is read at the end of its command, 20 rows after row i - 19 began.
    DOUBLES_EQUAL(commands[i - 19] / kAngle, output[i], 1e-6);
  }
}

TEST(WildMemories, AHoldKeepsEveryTenthRow) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::hold;
  memory.rows = 10;
  const auto commands = sine_command();
  const auto output = output_of(memory, commands);
  for (std::size_t i = 0; i < output.size(); ++i) {
    DOUBLES_EQUAL(commands[i - i % 10] / kAngle, output[i], 1e-6);
  }
}

// At 1.5 Hz the signal moves by 9.4 a second, so that an output that follows at 1e4 per second is 1e-3 behind.
TEST(WildMemories, APlayStopsUntilItIsTakenUpAndAStopIsTheRestOfAPlay) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::plays;
  memory.plays = {{0.3, 1.0}};
  const auto commands = sine_command();
  const auto play = output_of(memory, commands);
  memory.kind = WildMemory::Kind::stops;
  const auto stop = output_of(memory, commands);
  double followed = 0.0;
  for (std::size_t i = 0; i < play.size(); ++i) {
    const double input = commands[i] / kAngle;
    followed = std::clamp(followed, input - 0.3, input + 0.3);
    DOUBLES_EQUAL(followed, play[i], 2e-3);
    DOUBLES_EQUAL(input - followed, stop[i], 2e-3);
  }
}

TEST(WildMemories, ARateLimitFollowsAtItsRate) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::rate_limit;
  memory.limit = 4.0;
  const auto output = output_of(memory, step_command());
  for (std::size_t i = kRest; i < output.size(); ++i) {
    DOUBLES_EQUAL(std::min(1.0, memory.limit * (time_of(i) - kRest * kSample)), output[i], 1e-3);
  }
}

TEST(WildMemories, ASwingHasTheFrequencyThatItsInputAsksFor) {
  WildMemory memory;
  memory.kind = WildMemory::Kind::swing;
  memory.frequency = 3.0;
  memory.damping = 0.5;
  const auto output = output_of(memory, step_command());
  const double step = kRest * kSample;
  const double later = 3.0 * (1.0 + 0.5 * std::tanh(1.0));
  for (std::size_t i = 0; i < output.size(); ++i) {
    const double t = time_of(i);
    const double turns = 3.0 * std::min(t, step) + later * std::max(0.0, t - step);
    DOUBLES_EQUAL(std::sin(2.0 * std::numbers::pi * turns), output[i], 1e-4);
  }
}

TEST_GROUP(WildSites){};

// A law that is a gain is a change of what the axis has: each site is where the equations have that parameter.
TEST(WildSites, AGainOverItsOwnArgumentIsADeclaredParameter) {
  const auto commands = sine_command();
  const ReferenceAxis axis;
  const ReferenceRows plain = rows_of(axis, commands);

  ReferenceAxis ducts = axis;
  ducts.duct_stiffness += 5e5;
  check_same(rows_with(axis, line(WildSite::engine_torque, WildArgument::angle, -5e5), commands), rows_of(ducts, commands),
             plain);
  ReferenceAxis damped = axis;
  damped.piston_damping += 1e5;
  check_same(rows_with(axis, line(WildSite::piston, WildArgument::rate, -1e5), commands), rows_of(damped, commands), plain);
  ReferenceAxis open = axis;
  open.rated_flow *= 1.3;
  check_same(rows_with(axis, line(WildSite::valve, WildArgument::spool, 0.3), commands), rows_of(open, commands), plain);
  ReferenceAxis leaky = axis;
  leaky.laminar_leak = 1e-10;
  check_same(rows_with(axis, line(WildSite::flow, WildArgument::pressure, -1e-10), commands), rows_of(leaky, commands),
             plain);
  ReferenceAxis stiff = axis;
  stiff.load_stiffness *= 1.2;
  stiff.actuator_stiffness *= 1.2;
  check_same(rows_with(axis, line(WildSite::load_spring, WildArgument::deflection, 0.2), commands), rows_of(stiff, commands),
             plain);
}

// Why they are right for each other in the study.
TEST(WildSites, CommandAndValveCommandAreOneSiteAndFlowAndPressureAreOne) {
  const auto commands = sine_command();
  const ReferenceAxis axis;
  const ReferenceRows plain = rows_of(axis, commands);
  WildLaw law = line(WildSite::command, WildArgument::rate, 0.02);
  law.curve.shape = WildCurve::Shape::even_power;
  law.curve.parts = {{2.0, 0.0, 0.0}};
  WildLaw same = law;
  same.site = WildSite::valve_command;
  same.amplitude *= axis.position_gain * axis.arm;
  check_same(rows_with(axis, law, commands), rows_with(axis, same, commands), plain);
  law.site = WildSite::flow;
  law.amplitude = 1e-3;
  same = law;
  same.site = WildSite::pressure;
  same.amplitude *= 4.0 * axis.bulk_modulus / axis.volume;
  check_same(rows_with(axis, law, commands), rows_with(axis, same, commands), plain);
}

// A run is given up for its work alone, so what an axis takes has to be far below; and not so far that it goes on for long.
TEST(WildSites, AnAxisWithoutALawTakesATenthOfTheWorkAtWhichOneIsGivenUp) {
  const auto commands = sine_command();
  long evaluations = 0;
  integrate_reference({}, commands, kSample, 0.0, 1e-8, &evaluations);
  const double share = static_cast<double>(evaluations) / static_cast<double>(commands.size()) / kMostEvaluations;
  CHECK_TRUE(share > 0.02 && share < 0.2);
}

TEST(WildSites, ALawThatIsUnstableIsGivenUp) {
  CHECK_THROWS(std::runtime_error, rows_with({}, line(WildSite::pressure, WildArgument::pressure, 1e7), sine_command()));
}

}  // namespace hotfire::study
