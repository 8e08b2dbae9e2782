// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <string_view>
#include <tuple>

#include "tests/model/support/every_effect.hpp"

namespace hotfire::test {
namespace {

constexpr double kEnergyStep = 1e-3;
constexpr double kPeriod = 1.0;

/// Effects whose force or flow takes energy and stores it at most: friction and leakage. The springs at `mass_force` and
/// `engine_torque` store energy and are tested as conservative; `position_damping`, by its law, damps on one side and drives
/// on the other; an offset is a source.
template <class E>
constexpr bool is_dissipative = std::is_same_v<E, model::Leakage> || std::is_same_v<E, model::PistonFriction> ||
                                std::is_same_v<E, model::GimbalFriction> || std::is_same_v<E, model::SlidingFriction> ||
                                std::is_same_v<E, model::MotorFriction> || std::is_same_v<E, model::QuadraticDamping>;
template <class E>
constexpr bool is_conservative = std::is_same_v<E, model::DuctHardening> || std::is_same_v<E, model::QuadraticStiffness> ||
                                 std::is_same_v<E, model::CubicStiffness>;

/// A motion of period 1 s whose velocity is imposed (no compliance), exact between the ends of each step.
model::Motion<double> imposed_motion(double amplitude, double third, int k) {
  const auto position = [&](double t) {
    constexpr double w = 2.0 * std::numbers::pi / kPeriod;
    return amplitude * (std::sin(w * t) + third * std::sin(3.0 * w * t + 0.5));
  };
  const double start = position(k * kEnergyStep);
  const double end = position((k + 1) * kEnergyStep);
  const double velocity = (end - start) / kEnergyStep;
  return {0.5 * (start + end), velocity, velocity, 1e-30, kEnergyStep};
}

/// Friction values within a factor of ten of the typical ones, so that stick, slip and what lies between are all met.
template <class E>
ParamsOf<E, double> near_typical(Random& random, int option) {
  auto params = typical<E, double>(option);
  for (const auto& field : ParamsOf<E, double>::fields()) {
    if (used_by(field, option)) {
      params.*field.member = std::clamp(field.typical * random.logarithmic(0.1, 10.0), field.lower, field.upper);
    }
  }
  // The textbook LuGre law makes energy where its viscous slope is too small; [Astrom and Canudas de Wit 2008] p. 107.
  if constexpr (std::is_same_v<E, model::SlidingFriction> || std::is_same_v<E, model::MotorFriction>) {
    const double needed = params.damping * (params.static_ratio - 1.0);
    params.viscous_forward = std::max(params.viscous_forward, 1.01 * needed);
    params.viscous_backward = std::max(params.viscous_backward, 1.01 * needed);
  }
  return params;
}

struct Work {
  double least = 0.0;   ///< smallest running total from rest
  double cycle = 0.0;   ///< of the third cycle, when the law has forgotten where it started
  double traded = 0.0;  ///< sum of magnitudes, the scale of rounding
};

template <class E>
Work work_over_cycles(const ParamsOf<E, double>& params, double amplitude, double third) {
  StateOf<E, double> state{};
  Work work;
  double total = 0.0;
  const int steps = static_cast<int>(kPeriod / kEnergyStep);
  for (int k = 0; k < 3 * steps; ++k) {
    const auto motion = imposed_motion(amplitude, third, k);
    const double done = E::step(params, state, motion) * motion.velocity * kEnergyStep;
    total += done;
    work.least = std::min(work.least, total);
    work.traded += std::abs(done);
    work.cycle += k >= 2 * steps ? done : 0.0;
  }
  return work;
}

}  // namespace

TEST_GROUP(Energy){};

// From rest, with nothing stored, a passive law cannot have given back more than it was given, at any time.
TEST(Energy, IsNotCreatedByFriction) {
  for_each_law([]<class E>(int option) {
    if constexpr (is_dissipative<E> && std::is_same_v<InputOf<E, double>, model::Motion<double>>) {
      Random random(5);
      for (int i = 0; i < 200; ++i) {
        const auto params = near_typical<E>(random, option);
        const Work work = work_over_cycles<E>(params, random.logarithmic(1e-5, 1.0), random.uniform(0.0, 1.0));
        CHECK_TRUE_TEXT(work.cycle >= -1e-12 * work.traded, label<E>(option).c_str());
        if (work.least < -1e-12 * work.traded) {
          FAIL((label<E>(option) + ": gave " + std::to_string(-work.least / work.traded) + " of what it traded").c_str());
        }
      }
    }
  });
}

TEST(Energy, IsLostInLeakageAtEveryInstant) {
  for_each_law([]<class E>(int option) {
    if constexpr (std::is_same_v<E, model::Leakage>) {
      Random random(6);
      for (int i = 0; i < 1000; ++i) {
        const auto params = random_params<E>(random, option);
        const auto input = random_input<E>(random, kEnergyStep);
        StateOf<E, double> state{};
        CHECK_TRUE_TEXT(E::step(params, state, input) * input.load_pressure <= 0.0, label<E>(option).c_str());
      }
    }
  });
}

// Sampled at the middle of chords, the work of k x^n around a cycle of 1,000 steps is zero but for the chord's error,
// (w h)^2 / 12 = 3e-6 of the energy traded, and three times that for the third harmonic's share, squared: 3e-5.
TEST(Energy, IsGivenBackByNonlinearSprings) {
  for_each_law([]<class E>(int option) {
    if constexpr (is_conservative<E>) {
      const Work work = work_over_cycles<E>(typical<E, double>(option), 0.1, 0.3);
      CHECK_TRUE_TEXT(work.traded > 0.0, label<E>(option).c_str());
      CHECK_TRUE_TEXT(std::abs(work.cycle) <= 3e-5 * work.traded, label<E>(option).c_str());
    }
  });
}

// A spring whose force follows from its deflection alone has a potential: same deflection, same force, and never one that
// points the other way.
TEST(Energy, IsStoredByTheSoftSpringAndTheBacklash) {
  for_each_law([]<class E>(int option) {
    if constexpr (std::is_same_v<E, model::SoftStiffness> || std::is_same_v<E, model::Backlash>) {
      const auto params = typical<E, double>(option);
      StateOf<E, double> state{};
      double last = -1.0;
      for (int k = -400; k <= 400; ++k) {
        const auto input = reference_spring(2e-6 * k, 0.0, kEnergyStep);
        // The smooth laws are found by iteration from the last force: a second call is at rest.
        static_cast<void>(E::step(params, state, input));
        const double force = E::step(params, state, input).deflection;
        CHECK_TRUE_TEXT(force >= last, label<E>(option).c_str());
        CHECK_TRUE_TEXT(force * input.deflection >= 0.0, label<E>(option).c_str());
        last = force;
        StateOf<E, double> fresh{};
        for (int i = 0; i < 4; ++i) {
          static_cast<void>(E::step(params, fresh, input));
        }
        DOUBLES_EQUAL_TEXT(force, E::step(params, fresh, input).deflection, 1e-15, label<E>(option).c_str());
      }
    }
  });
}

// A share s that relaxes with a time constant T, in series (creep) or in parallel (a Maxwell element), takes
// pi s K a^2 w T / (1 + (w T)^2) out of a cycle of amplitude a at w. The deflection is sampled at the middle of 1,000 chords
// a cycle: 2e-5; the mean of what relaxes over a step is that of its ends: (h / T)^2 / 12 = 1e-3 at worst.
TEST(Energy, IsLostInASpringThatRelaxesAsItsTimeConstantSays) {
  using E = model::UnlistedDeflection;
  for (const auto& [law, share, time] : {std::tuple{"creep", &ParamsOf<E, double>::creep_share, 0.5},
                                         std::tuple{"deflection_rate", &ParamsOf<E, double>::damping_share, 0.01}}) {
    const int option = law == std::string_view("creep") ? option_named<E>("creep") : option_named<E>("deflection_rate");
    const auto params = typical<E, double>(option);
    constexpr double a = 2e-4;
    constexpr double w = 2.0 * std::numbers::pi / kPeriod;
    StateOf<E, double> state{};
    double work = 0.0;
    double stiffness = 0.0;
    const int rows = static_cast<int>(kPeriod / kEnergyStep);
    // What it remembers of its start is gone after ten time constants.
    for (int k = 0; k < 11 * rows; ++k) {
      const double from = a * std::sin(w * kEnergyStep * k);
      const double to = a * std::sin(w * kEnergyStep * (k + 1));
      const auto input = reference_spring(0.5 * (from + to), 0.0, kEnergyStep);
      stiffness = input.stiffness;
      const double force = stiffness * E::step(params, state, input).deflection;
      work += k >= 10 * rows ? force * (to - from) : 0.0;
    }
    const double expected = std::numbers::pi * params.*share * stiffness * a * a * w * time / (1.0 + w * time * w * time);
    DOUBLES_EQUAL_TEXT(expected, work, 2e-3 * expected, law);
  }
}

// A joint that sticks over a stretch w with a stiffness s K and slips beyond takes 4 s K w (a - w) out of a cycle of
// amplitude a > w, however long that takes (Jenkins element; Iwan 1966). Sampled at 1,000 chords a cycle: it turns and slips
// within a chord, 4e-3 of the amplitude at worst.
TEST(Energy, IsLostInAJointThatSlipsByTheAreaOfItsLoop) {
  using E = model::UnlistedDeflection;
  const auto params = typical<E, double>(option_named<E>("slip"));
  const double a = 3.0 * params.slip_width;
  for (const double period : {kPeriod, 4.0 * kPeriod}) {
    StateOf<E, double> state{};
    double work = 0.0;
    double stiffness = 0.0;
    const int rows = static_cast<int>(period / kEnergyStep);
    const auto at = [&](int k) { return a * std::sin(2.0 * std::numbers::pi * k / rows); };
    for (int k = 0; k < 2 * rows; ++k) {
      const auto input = reference_spring(0.5 * (at(k) + at(k + 1)), 0.0, kEnergyStep);
      stiffness = input.stiffness;
      const double force = stiffness * E::step(params, state, input).deflection;
      work += k >= rows ? force * (at(k + 1) - at(k)) : 0.0;
    }
    const double expected = 4.0 * params.slip_share * stiffness * params.slip_width * (a - params.slip_width);
    DOUBLES_EQUAL(expected, work, 4e-3 * expected);
  }
}

// Virtual work: the arm that turns force into torque is the slope of the stroke. Central difference over 1e-4 rad; the
// stroke is a cubic, whose third derivative 2 R quadratic gives an error of 1e-8 R.
TEST(Energy, IsTheSameInStrokeAndTorqueOfAVariableArm) {
  using E = model::VariableMomentArm;
  const auto params = typical<E, double>(0);
  StateOf<E, double> state{};
  constexpr double d = 1e-4;
  for (double angle = -0.2; angle <= 0.2; angle += 0.01) {
    const double up = E::step(params, state, reference_spring(1e-3, angle + d, kEnergyStep)).deflection;
    const double down = E::step(params, state, reference_spring(1e-3, angle - d, kEnergyStep)).deflection;
    const double arm = E::step(params, state, reference_spring(1e-3, angle, kEnergyStep)).arm;
    DOUBLES_EQUAL(arm - 0.7544, -(up - down) / (2.0 * d), 1e-8);
  }
}

// The mode is advanced exactly under a held force, so its energy balance holds to rounding: what the force has put in is
// stored or lost, never less than nothing.
TEST(Energy, IsNotCreatedByAStructuralMode) {
  using E = model::StructuralMode;
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const auto params = near_typical<E>(random, 0);
    StateOf<E, double> state{};
    double total = 0.0;
    double traded = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const double force = 3e4 * std::sin(random.uniform(0.1, 40.0) * k * kEnergyStep);
      const double before = state.displacement;
      static_cast<void>(E::step(params, state, model::AttachPoint<double>{force, kEnergyStep}));
      const double done = force * params.shape * (state.displacement - before);
      total += done;
      traded += std::abs(done);
      CHECK_TRUE(total >= -1e-12 * traded);
    }
  }
}

}  // namespace hotfire::test
