// SPDX-License-Identifier: Apache-2.0
#include "model/simplex.hpp"

#include <CppUTest/TestHarness.h>

#include <complex>
#include <cstring>
#include <numbers>
#include <optional>
#include <string>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Plant = model::Simplex<double>;
using Complex = std::complex<double>;

constexpr double kStep = 5e-4;

double load_spring(const Plant::Parameters& p) { return 1.0 / (1.0 / p.actuator.stiffness + 1.0 / p.structure.stiffness); }

/// Undamped frequency of the zero pair of command -> piston, the roots of J s^2 + D s + K_n + K_T R^2 [Hz].
double analytic_zero(const Plant::Parameters& p) {
  const double arm = p.actuator.moment_arm;
  const double stiffness = p.engine.duct_stiffness + load_spring(p) * arm * arm;
  return std::sqrt(stiffness / p.engine.inertia) / (2.0 * std::numbers::pi);
}

struct Response {
  double piston;  ///< magnitude of piston over commanded stroke
  double engine;  ///< magnitude of engine over commanded angle
};

/// Steady response to a sine of 0.001 deg, by a discrete Fourier sum at its own frequency over a whole number of cycles:
/// `cycles` in 100,000 steps, which is 50 s. 5 s before it let the start die out (slowest mode 6.3 1/s: e^-31).
Response response(const Plant& plant, int cycles) {
  constexpr int window = 100'000;
  constexpr double amplitude = 1.7e-5;
  Plant::State state = plant.steady(0.0);
  Complex piston{};
  Complex engine{};
  for (int k = -10'000; k < window; ++k) {
    const double phase = 2.0 * std::numbers::pi * cycles * k / window;
    plant.step(state, amplitude * std::sin(phase));
    if (k >= 0) {
      piston += state.y(Plant::kPiston) * std::polar(1.0, -phase);
      engine += state.y(Plant::kAngle) * std::polar(1.0, -phase);
    }
  }
  const double scale = 2.0 / (window * amplitude);
  return {std::abs(piston) * scale / plant.parameters().actuator.moment_arm, std::abs(engine) * scale};
}

double frequency(int cycles) { return cycles / (100'000 * kStep); }

/// Stored energy of an axis whose valve is shut: engine, ducts, load spring, piston, oil.
double stored_energy(const Plant::Parameters& p, const Plant::State& state) {
  const auto& y = state.y;
  const double stretch = y(Plant::kPiston) - p.actuator.moment_arm * y(Plant::kAngle);
  return 0.5 * (p.engine.inertia * y(Plant::kAngleRate) * y(Plant::kAngleRate) +
                p.engine.duct_stiffness * y(Plant::kAngle) * y(Plant::kAngle) + load_spring(p) * stretch * stretch +
                p.actuator.piston_mass * y(Plant::kPistonRate) * y(Plant::kPistonRate) +
                y(Plant::kPressure) * y(Plant::kPressure) * p.actuator.trapped_volume / (4.0 * p.actuator.bulk_modulus));
}

/// Order of convergence that halving the step shows, mean of three halvings: the flow's root has a corner where the spool
/// passes zero, so that a single halving scatters.
double observed_order(const Plant::Parameters& parameters) {
  const auto change = [&](int parts) {
    return relative_rms(record<Plant>(parameters, 1.0, 1e-3, parts), record<Plant>(parameters, 1.0, 1e-3, 2 * parts), 0);
  };
  return std::log2(change(1) / change(8)) / 3.0;
}

Plant::Parameters three_effects() {
  Plant::Parameters parameters;
  activate<model::GimbalFriction, Plant>(parameters, typical<model::GimbalFriction, double>(2));
  activate<model::SoftStiffness, Plant>(parameters, typical<model::SoftStiffness, double>(0));
  activate<model::ValveDeadband, Plant>(parameters, typical<model::ValveDeadband, double>(0));
  return parameters;
}

/// Equal number by number; there is no NaN, and a zero of the other sign would show in the steps that follow.
bool same_numbers(const Plant::State& a, const Plant::State& b) {
  return a.y == b.y && a.inputs == b.inputs && a.measured == b.measured && a.effects.outputs == b.effects.outputs;
}

/// Largest difference of the piston [m] between oil that is more compressible by a share of the declared and oil of the bulk
/// modulus that is left, through a second of commands, at a step [s].
double difference_of_oils(double share, double step) {
  Plant::Parameters softer;
  softer.actuator.bulk_modulus /= 1.0 + share;
  Plant::Parameters aerated;
  ParamsOf<model::UnlistedPressure, double> table;
  table.table.points = 2;
  table.table.x = {-1e6, 1e6};
  table.table.y = {share, share};
  activate<model::UnlistedPressure, Plant>(aerated, table);
  const Plant one(softer, step);
  const Plant other(aerated, step);
  Plant::State first = one.steady(0.0);
  Plant::State second = other.steady(0.0);
  double largest = 0.0;
  for (int k = 0; k * step < 1.0; ++k) {
    const double command = 0.02 * std::sin(25.0 * k * step);
    one.step(first, command);
    other.step(second, command);
    largest = std::max(largest, std::abs(first.y(Plant::kPiston) - second.y(Plant::kPiston)));
  }
  return largest;
}

}  // namespace

TEST_GROUP(Simplex){};

// 21 frequencies 0.02 Hz apart around the zero; the least of |H|^2 by a parabola through the lowest three. The zero's
// damping ratio is 0.013, so the slope of the rest of the loop moves the minimum by no more than its square, 2e-4.
TEST(Simplex, HasItsPistonNotchAtTheAnalyticZero) {
  const Plant plant(Plant::Parameters{}, kStep);
  const double zero = analytic_zero(plant.parameters());
  const int middle = static_cast<int>(std::lround(zero / frequency(1)));
  std::array<double, 21> squared{};
  for (int i = 0; i < 21; ++i) {
    const double magnitude = response(plant, middle - 10 + i).piston;
    squared[static_cast<std::size_t>(i)] = magnitude * magnitude;
  }
  const auto least = std::min_element(squared.begin() + 1, squared.end() - 1);
  const double offset = 0.5 * (least[-1] - least[1]) / (least[-1] - 2.0 * least[0] + least[1]);
  const double notch = frequency(1) * (middle - 10 + static_cast<double>(least - squared.begin()) + offset);
  DOUBLES_EQUAL(zero, notch, 0.005 * zero);
}

TEST(Simplex, HasANotchInThePistonAndNoneInTheEngine) {
  const Plant plant(Plant::Parameters{}, kStep);
  const int at = static_cast<int>(std::lround(analytic_zero(plant.parameters()) / frequency(1)));
  const Response below = response(plant, at * 3 / 4);
  const Response here = response(plant, at);
  const Response above = response(plant, at * 5 / 4);
  // A zero of damping ratio 0.013 stands 2 * 0.013 / (1 - 0.75^2) = 0.06 below its shoulders.
  CHECK_TRUE(here.piston < 0.1 * std::min(below.piston, above.piston));
  CHECK_TRUE(here.engine > std::min(below.engine, above.engine));
}

// Wherever the loop is, engine and piston are tied by the engine's own equation: |piston / engine| at the zero is
// D w / (K_T R), and far below it (K_n + K_T R^2) / (K_T R).
TEST(Simplex, KeepsTheEnginesEquationBetweenPistonAndEngine) {
  const Plant plant(Plant::Parameters{}, kStep);
  const Plant::Parameters& p = plant.parameters();
  const double arm = p.actuator.moment_arm;
  for (const int cycles : {20, 100, 250, 388, 500}) {
    const Response measured = response(plant, cycles);
    const Complex s(0.0, 2.0 * std::numbers::pi * frequency(cycles));
    const Complex ratio =
        (p.engine.inertia * s * s + p.engine.viscous_damping * s + p.engine.duct_stiffness + load_spring(p) * arm * arm) /
        (load_spring(p) * arm * arm);
    // The sine is held over each step alike for both: what is left is rounding over 110,000 steps.
    DOUBLES_EQUAL(std::abs(ratio), measured.piston / measured.engine, 1e-6);
  }
}

// Full spool gives Q_r / A; the loop is within 2 % of it once the oil is moving and far from the end of the step.
TEST(Simplex, MovesNoFasterThanTheSaturatedValveLets) {
  const Plant plant(Plant::Parameters{}, kStep);
  Plant::State state = plant.steady(0.0);
  const double fastest = plant.parameters().servovalve.rated_flow / plant.parameters().actuator.piston_area;
  double at_start = 0.0;
  for (int k = 0; k < 1200; ++k) {
    if (k == 400) {
      at_start = state.y(Plant::kPiston);
    }
    plant.step(state, 0.3);
  }
  const double rate = (state.y(Plant::kPiston) - at_start) / (800 * kStep);
  CHECK_TRUE(rate < fastest);
  CHECK_TRUE(rate > 0.9 * fastest);
}

// 0.5 s from the steady state; 1e-9 of the largest value of each channel is rounding magnified by the loop (condition 1e4).
TEST(Simplex, StaysInItsSteadyStateWhateverTheEffect) {
  for_each_law([]<class E>(int option) {
    if constexpr (index_in<E>(Plant::Effects{}) < Plant::Effects::size) {
      if (depends_on_time<E>(option)) {
        return;
      }
      for (const double command : {0.0, 0.001, 0.05, -0.05}) {
        Plant::Parameters parameters;
        activate<model::TorqueOffset, Plant>(parameters, {0, 3e3});
        activate<E, Plant>(parameters, typical<E, double>(option));
        const Plant plant(parameters, kStep);
        Plant::State state = plant.steady(command);
        const auto start = Plant::measured(state);
        constexpr std::array<double, 3> scale{0.05, 0.05, 1e6};
        for (int k = 0; k < 1000; ++k) {
          plant.step(state, command);
        }
        for (std::size_t channel = 0; channel < 3; ++channel) {
          if (!(std::abs(state.measured[channel] - start[channel]) <= 1e-9 * scale[channel])) {
            FAIL((label<E>(option) + " at " + std::to_string(command) + " moves " +
                  std::to_string((state.measured[channel] - start[channel]) / scale[channel]))
                     .c_str());
          }
        }
      }
    }
  });
}

// With the valve shut nothing feeds the axis. The exact hold keeps or loses energy to rounding; friction only takes.
TEST(Simplex, LosesEnergyWhenItsValveIsShut) {
  for (const bool with_friction : {false, true}) {
    Plant::Parameters parameters;
    parameters.servovalve.rated_flow = 0.0;
    if (with_friction) {
      activate<model::GimbalFriction, Plant>(parameters, {1, 8e3, 1e7, 1.0, 0.01, 0.0});
    }
    const Plant plant(parameters, kStep);
    Plant::State state = plant.steady(0.0);
    state.y(Plant::kAngleRate) = 0.3;
    const double first = stored_energy(parameters, state);
    double last = first;
    for (int k = 0; k < 4000; ++k) {
      plant.step(state, 0.0);
      const double now = stored_energy(parameters, state);
      // The bristle stores a little, level^2 / (2 sigma0) = 3.2 J, and may give that back.
      CHECK_TRUE(now <= last + 1e-12 * first + (with_friction ? 3.2 : 0.0));
      last = now;
    }
    CHECK_TRUE(last < 0.1 * first);
  }
}

TEST(Simplex, ConvergesWithTheSecondOrderWhereItIsSmooth) {
  Plant::Parameters parameters;
  activate<model::SoftStiffness, Plant>(parameters, typical<model::SoftStiffness, double>(0));
  activate<model::DuctHardening, Plant>(parameters, typical<model::DuctHardening, double>(0));
  CHECK_TRUE(observed_order(parameters) > 1.8);
}

TEST(Simplex, ConvergesWithTheFirstOrderWithFriction) {
  Plant::Parameters parameters;
  for (const int law : {1, 2}) {
    activate<model::GimbalFriction, Plant>(parameters, typical<model::GimbalFriction, double>(law));
    CHECK_TRUE(observed_order(parameters) > 1.0);
  }
}

// The one solves the oil exactly, the other as the effect that it is: of second order in the step, and below a sensor's
// noise (8 um) at the rig's.
TEST(Simplex, OilThatIsMoreCompressibleByAShareIsOilOfASmallerBulkModulus) {
  for (const double share : {-0.4, 0.5, 4.0}) {
    const double at_step = difference_of_oils(share, kStep);
    CHECK_TRUE(at_step < 8e-6);
    CHECK_TRUE(difference_of_oils(share, kStep / 2) < at_step / 3.0);
  }
}

TEST(Simplex, GivesTheSameBitsWhenItIsRepeated) {
  const Plant plant(three_effects(), kStep);
  Plant::State first = plant.steady(0.0);
  Plant::State second = plant.steady(0.0);
  for (int k = 0; k < 2000; ++k) {
    const double command = lively_input(plant, k * kStep);
    plant.step(first, command);
    plant.step(second, command);
  }
  CHECK_TRUE(same_numbers(first, second));
}

// std::tuple and Eigen's matrices declare their own copies, so the language does not call the state trivially copyable. It
// holds no pointer: a copy of its bytes goes on as the original does, which is what a checkpoint needs.
TEST(Simplex, GoesOnFromACopyOfTheBytesOfItsState) {
  const Plant plant(three_effects(), kStep);
  Plant::State state = plant.steady(0.0);
  for (int k = 0; k < 500; ++k) {
    plant.step(state, lively_input(plant, k * kStep));
  }
  alignas(Plant::State) std::array<unsigned char, sizeof(Plant::State)> bytes{};
  std::memcpy(bytes.data(), &state, bytes.size());
  Plant::State copy = plant.steady(0.01);
  std::memcpy(static_cast<void*>(&copy), bytes.data(), bytes.size());
  for (int k = 500; k < 1000; ++k) {
    plant.step(state, lively_input(plant, k * kStep));
    plant.step(copy, lively_input(plant, k * kStep));
  }
  CHECK_TRUE(same_numbers(state, copy));
}

// Every piston position is a rest at which the spool needs no more than the play: an interval of twice the play over the
// gain of the loop, of which `steady`, which comes from the middle of the play, is an end.
TEST(Simplex, AnAxisWithAPlayInItsValveRestsWhereItsPistonWasSeenAsFarAsThePlayGoes) {
  constexpr double kCommand = 0.01;
  Plant::Parameters parameters;
  activate<model::ValveHysteresis, Plant>(parameters, {0, 0.02});
  activate<model::TorqueOffset, Plant>(parameters, {0, -2e4});
  const Plant plant(parameters, kStep);
  const auto piston_at_rest = [&](double seen) { return plant.resting(kCommand, seen).y(Plant::kPiston); };
  const double low = piston_at_rest(-1.0);
  const double high = piston_at_rest(1.0);
  DOUBLES_EQUAL(2.0 * 0.02 / parameters.servovalve.position_gain, high - low, 0.01 * (high - low));
  const double from_middle = plant.steady(kCommand).y(Plant::kPiston);
  CHECK_TRUE(std::min(high - from_middle, from_middle - low) < 1e-9);
  for (const double share : {0.01, 0.3, 0.99}) {
    const double seen = low + share * (high - low);
    Plant::State state = plant.resting(kCommand, seen);
    DOUBLES_EQUAL(seen, state.y(Plant::kPiston), 1e-12);
    for (int k = 0; k < 4000; ++k) {
      plant.step(state, kCommand);
    }
    DOUBLES_EQUAL(seen, state.y(Plant::kPiston), 1e-8);
  }
}

TEST(Simplex, WithoutAPlayInItsValveAnAxisRestsWhereItsCommandSays) {
  const Plant plant(three_effects(), kStep);
  CHECK_TRUE(same_numbers(plant.steady(0.01), plant.resting(0.01, 0.03)));
  CHECK_TRUE(same_numbers(plant.steady(0.01), plant.resting(0.01, std::nullopt)));
}

}  // namespace hotfire::test
