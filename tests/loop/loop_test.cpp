// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/files/scratch.hpp"
#include "tools/files/text/error.hpp"
#include "tools/linear/plant/plant.hpp"
#include "tools/loop/controller.hpp"
#include "tools/loop/cycle_check.hpp"
#include "tools/loop/flight.hpp"
#include "tools/loop/margins.hpp"
#include "tools/loop/stage.hpp"
#include "tools/loop/vehicle_loop.hpp"
#include "tools/trials/profiles.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::loop {
namespace {

const Complex kImaginary(0.0, 1.0);

/// Gain / (s (s + 1) (s + 2)): on the stability limit with a gain of 6, at the root of 2 rad/s.
Complex third_order(double gain, double frequency) {
  const Complex s = kImaginary * kTurn * frequency;
  return gain / (s * (s + 1.0) * (s + 2.0));
}

/// Describing function of a dead zone of half-width 1 and slope 1 [Gelb and Vander Velde 1968, table 2.3].
double dead_zone(double amplitude) {
  if (amplitude <= 1.0) {
    return 0.0;
  }
  const double ratio = 1.0 / amplitude;
  return 1.0 - 2.0 / std::numbers::pi * (std::asin(ratio) + ratio * std::sqrt(1.0 - ratio * ratio));
}

std::vector<MarginsAt> margins_by_amplitude(const DescribedLoop& loop, const std::vector<double>& amplitudes) {
  std::vector<MarginsAt> all;
  all.reserve(amplitudes.size());
  for (const double amplitude : amplitudes) {
    all.push_back({amplitude, margins_of([&](double f) { return loop(f, amplitude); }, trials::spaced(0.01, 3.0, 40))});
  }
  return all;
}

std::string controller_text(const std::string& more) {
  return "schema = 1\naxis = \"pitch\"\nperiod = 0.02\ngain = 2.0\nrate_gain = 1.5\nintegral_gain = 0.4\n" + more;
}

std::string refused(const std::string& text) {
  const test::Scratch scratch;
  try {
    load_controller(scratch.write("c.toml", text));
  } catch (const FileError& error) {
    return error.what();
  }
  return "not refused";
}

void check_refused(const std::string& text, const std::string& part) {
  const std::string message = refused(text);
  CHECK_TEXT(message.find(part) != std::string::npos, message.c_str());
}

/// Gives every engine of a vehicle its thrust, and the stage a rigid body and a bending mode of a frequency [Hz].
FlightModes thrust_with_modes(MasvParameters& vehicle, double bending) {
  for (auto& gimbal : vehicle.gimbals) {
    gimbal.bearing.thrust = 1e6;
  }
  FlightModes modes;
  modes.frequency = Eigen::Vector2d(0.0, bending);
  modes.damping_ratio = Eigen::Vector2d(0.0, 0.02);
  modes.side = Eigen::MatrixXd::Constant(8, 2, 1e-3);
  modes.sensor = Eigen::MatrixXd::Constant(2, 2, 4e-5);
  return modes;
}

}  // namespace

TEST_GROUP(Loop){};

TEST(Loop, MarginsOfAnIntegratorWithADelayAreThoseOfTheFormula) {
  constexpr double kGain = 2.0;
  constexpr double kDelay = 0.3;
  const auto loop = [&](double frequency) {
    const double w = kTurn * frequency;
    return std::optional<Complex>(kGain / (kImaginary * w) * std::exp(-kImaginary * w * kDelay));
  };
  const Margins margins = margins_of(loop, trials::spaced(0.02, 1.5, 10));
  LONGS_EQUAL(1, margins.phase.size());
  DOUBLES_EQUAL(kGain / kTurn, margins.phase[0].frequency, 1e-9);
  DOUBLES_EQUAL(90.0 - kGain * kDelay * 360.0 / kTurn, margins.phase[0].degrees, 1e-9);
  LONGS_EQUAL(1, margins.gain.size());
  DOUBLES_EQUAL(20.0 * std::log10(std::numbers::pi / (2.0 * kDelay * kGain)), margins.gain[0].decibels, 1e-9);
}

TEST(Loop, ARelayKeepsUpTheLimitCycleOfTheFormula) {
  const DescribedLoop loop = [](double frequency, double amplitude) {
    return std::optional<Complex>(4.0 / (std::numbers::pi * amplitude) * third_order(3.0, frequency));
  };
  const auto cycles = predicted_limit_cycles(loop, margins_by_amplitude(loop, {0.1, 0.3, 1.0, 3.0}));
  LONGS_EQUAL(1, cycles.size());
  DOUBLES_EQUAL(std::sqrt(2.0) / kTurn, cycles[0].frequency, 1e-4);
  DOUBLES_EQUAL(4.0 / std::numbers::pi * 3.0 / 6.0, cycles[0].amplitude, 1e-4);
  CHECK_TRUE(cycles[0].stable);
}

TEST(Loop, ALoopThatOnlyLargeMotionsDestabiliseHasALimitCycleThatPartsThem) {
  const DescribedLoop loop = [](double frequency, double amplitude) {
    return std::optional<Complex>(dead_zone(amplitude) * third_order(9.0, frequency));
  };
  const auto cycles = predicted_limit_cycles(loop, margins_by_amplitude(loop, {1.2, 1.5, 2.0, 4.0, 8.0}));
  LONGS_EQUAL(1, cycles.size());
  DOUBLES_EQUAL(2.0 / 3.0, dead_zone(cycles[0].amplitude), 1e-3);
  CHECK_FALSE(cycles[0].stable);
}

TEST(Loop, AStableLinearLoopHasNoLimitCycle) {
  const DescribedLoop loop = [](double frequency, double) { return std::optional<Complex>(third_order(3.0, frequency)); };
  LONGS_EQUAL(0, predicted_limit_cycles(loop, margins_by_amplitude(loop, {0.1, 1.0, 10.0})).size());
}

TEST(Loop, AnOscillationIsJudgedByWhatItsLastThirdsDo) {
  const auto judged = [](double growth) {
    std::vector<double> samples;
    for (int k = 0; k < 6000; ++k) {
      const double t = 0.01 * k;
      samples.push_back(0.3 + std::exp(growth * t) * (2.0 * std::sin(kTurn * 0.7 * t) + 0.2 * std::sin(kTurn * 2.1 * t)));
    }
    return oscillation_of(samples, 0.01, 1e-3);
  };
  const Oscillation steady = judged(0.0);
  CHECK_TRUE(steady.outcome == Outcome::oscillates);
  DOUBLES_EQUAL(0.7, steady.frequency, 1e-3);
  DOUBLES_EQUAL(2.0, steady.amplitude, 4e-3);
  CHECK_TRUE(judged(0.1).outcome == Outcome::grows);
  CHECK_TRUE(judged(-0.1).outcome == Outcome::decays);
  CHECK_TRUE(judged(-0.4).outcome == Outcome::decays);
}

TEST(Loop, ALawInTimeHasTheResponseOfItsFilters) {
  const test::Scratch scratch;
  const Controller controller = load_controller(scratch.write(
      "c.toml", controller_text("[[filter]]\nkind = \"notch\"\nfrequency = 3\ndamping_ratio = 0.4\n[[filter]]\nkind = "
                                "\"low_pass\"\nfrequency = 6\ndamping_ratio = 0.7\n")));
  LONGS_EQUAL(2, controller.sections.size());
  const Controller::Law law = controller.law();
  Eigen::VectorXd memory = Eigen::VectorXd::Zero(law.a.rows());
  constexpr double kFrequency = 2.0;
  constexpr int kSettling = 2000;
  constexpr int kCycle = 25;  // samples
  Complex sum{0.0};
  for (int k = 0; k < kSettling + kCycle; ++k) {
    const Complex turn = std::polar(1.0, kTurn * kFrequency * controller.period * k);
    const Eigen::Vector2d y(turn.imag(), 3.0 * turn.real());  // attitude, rate
    const double signal = law.c.dot(memory) + law.d.dot(y);
    memory = (law.a * memory + law.b * y).eval();
    sum += k >= kSettling ? signal * std::conj(turn) * (2.0 / kCycle) : Complex(0.0);
  }
  const Complex expected = controller.response(kFrequency, -kImaginary, 3.0);
  DOUBLES_EQUAL(0.0, std::abs(sum - expected) / std::abs(expected), 1e-9);
  // A notch passes nothing at its frequency.
  CHECK_TRUE(std::abs(controller.response(3.0, 1.0, 0.0)) < 1e-9);
}

TEST(Loop, AControllerThatIsWrittenWronglyIsRefusedWithLineAndRemedy) {
  check_refused("schema = 1\naxis = \"roll\"\nperiod = 0.02\ngain = 1\n", "c.toml:2");
  check_refused(controller_text("gian = 2\n"), "gian");
  check_refused("schema = 1\naxis = \"pitch\"\ngain = 1\n", "period");
  check_refused(controller_text("[[filter]]\nkind = \"notsh\"\n"), "notch");
  check_refused(controller_text("[[filter]]\nkind = \"lag\"\nfrequency = 40\n"), "c.toml:9");
  check_refused(controller_text("measured = \"m.csv\"\n"), "remedy");
}

TEST(Loop, AMeasuredControllerIsTheLineBetweenItsPoints) {
  const test::Scratch scratch;
  scratch.write("m.csv", "frequency[Hz],gain[dB],phase[deg]\n1,0,-170\n4,-12,170\n");
  const Controller controller =
      load_controller(scratch.write("c.toml", "schema = 1\naxis = \"yaw\"\nperiod = 0.02\nmeasured = \"m.csv\"\n"));
  const Complex middle = controller.response(2.0, 1.0, 0.0);
  DOUBLES_EQUAL(-6.0, 20.0 * std::log10(std::abs(middle)), 1e-9);
  DOUBLES_EQUAL(0.0, std::abs(std::arg(-middle)), 1e-9);
  scratch.write("m.csv", "frequency[Hz],gain[dB],phase[deg]\n1,0,-170\n0.5,-12,170\n");
  CHECK_THROWS(FileError, load_controller(scratch.path("c.toml")));
}

TEST(Loop, APredictedCycleIsKeptIfItsSimulationEndsNearestToIt) {
  const std::vector<LimitCycle> predicted{{0.150, 0.35, true}, {0.159, 0.32, true}, {0.5, 2.0, false}};
  const auto checks = [&](const Oscillation& end) {
    std::vector<Check> all;
    for (const CheckedCycle& own : checked(predicted, [&](const LimitCycle&) { return end; })) {
      all.push_back(own.check);
    }
    return all;
  };
  const auto expected = [](Check first, Check second) { return std::vector<Check>{first, second, Check::none}; };
  CHECK_TRUE(checks({Outcome::oscillates, 0.151, 0.345}) == expected(Check::stays, Check::leaves));
  // Within the bound of both: the nearer one.
  CHECK_TRUE(checks({Outcome::oscillates, 0.153, 0.336}) == expected(Check::stays, Check::leaves));
  CHECK_TRUE(checks({Outcome::oscillates, 0.157, 0.324}) == expected(Check::leaves, Check::stays));
  CHECK_TRUE(checks({Outcome::oscillates, 0.130, 0.35}) == expected(Check::leaves, Check::leaves));
  CHECK_TRUE(checks({Outcome::decays, 0.150, 0.35}) == expected(Check::leaves, Check::leaves));
  CHECK_TRUE(checks({Outcome::unsettled, 0.150, 0.35}) == expected(Check::unsettled, Check::unsettled));
  for (const CheckedCycle& own : checked(predicted, {})) {
    CHECK_TRUE(own.check == Check::none);
  }
}

TEST(Loop, AFlightThatStartsOnTheCycleOfALoopAtItsLimitGoesOnWithIt) {
  model::InstrumentedVehicle<model::Masv<double>> instrumented;
  MasvParameters& vehicle = instrumented.vehicle;
  FlightModes modes = thrust_with_modes(vehicle, 3.0);
  modes.sensor(0, 1) = 1e-6;
  const Stage stage(vehicle, modes, "pitch");
  Controller controller;
  controller.axis = "pitch";
  controller.period = 0.02;
  controller.delay = 0.03;
  controller.gain = 2.5;
  controller.rate_gain = 1.5;
  controller.integral_gain = 0.3;
  // y(k) = 0.1 x(k) + 0.9 y(k-1): a memory of ten samples.
  controller.sections.push_back({{0.1, 0.0, 0.0}, {-0.9, 0.0}});
  const plant::AnyParameters parameters = instrumented;
  const auto linear = linear::make_plant(parameters, controller.period, {});
  const VehicleLoop loop(*linear, stage, controller);
  const Margins margins =
      margins_of([&](double f) { return std::optional(loop.small_signal(f)); }, trials::spaced(0.15, 8.0, 60));
  CHECK_TRUE(!margins.gain.empty());
  const double factor = std::pow(10.0, margins.gain.front().decibels / 20.0);
  controller.gain *= factor;
  controller.rate_gain *= factor;
  controller.integral_gain *= factor;

  // On the limit a linear loop goes on with any amplitude, and with what a wrong start adds to it. Motions this small are
  // linear.
  const LimitCycle cycle{margins.gain.front().frequency, 1e-5, true};
  constexpr double kCycles = 12.0;
  const auto end_of = [&](const LimitCycle& on) {
    const FlightRecord record = fly(parameters, stage, controller, {0.0, kCycles / cycle.frequency, on});
    return oscillation_of(record.command, controller.period, 1e-6);
  };
  const Oscillation end = end_of(cycle);
  CHECK_TRUE(end.outcome == Outcome::oscillates);
  DOUBLES_EQUAL(1.0, end.amplitude / cycle.amplitude, 2e-3);
  DOUBLES_EQUAL(1.0, end.frequency / cycle.frequency, 2e-3);

  controller.gain *= 0.8;
  controller.rate_gain *= 0.8;
  CHECK_TRUE(end_of(cycle).outcome == Outcome::decays);
}

TEST(Loop, AStageInTimeHasTheResponseOfItsModes) {
  MasvParameters vehicle;
  FlightModes modes = thrust_with_modes(vehicle, 1.5);
  const Stage stage(vehicle, modes, "pitch");
  constexpr double kStep = 5e-4;
  constexpr double kFrequency = 0.8;
  const Stage::Step step = stage.step(kStep);
  const Complex turn = std::polar(1.0, kTurn * kFrequency * kStep);
  const Eigen::VectorXcd angles = Eigen::VectorXcd::Constant(8, 0.5 * (1.0 + turn));
  const Eigen::MatrixXcd dynamics = turn * Eigen::MatrixXcd::Identity(4, 4) - step.by_state.cast<Complex>();
  const Eigen::VectorXcd sampled = step.read * dynamics.partialPivLu().solve(step.by_angle * angles);
  const Eigen::VectorXcd continuous = stage.response(kFrequency) * Eigen::VectorXcd::Ones(8);
  for (int k = 0; k < 2; ++k) {
    DOUBLES_EQUAL(0.0, std::abs(sampled(k) / continuous(k) - 1.0), 1e-5);
  }
  DOUBLES_EQUAL(0.01, (step.read * stage.turned(0.01))(0), 1e-15);
  modes.frequency(0) = 0.2;
  CHECK_THROWS(UsageError, Stage(vehicle, modes, "pitch"));
  CHECK_THROWS(UsageError, Stage(vehicle, FlightModes{}, "pitch"));
}

}  // namespace hotfire::loop
