// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/perturbed.hpp"

#include "model/effects/valve/valve_hysteresis.hpp"
#include "model/numerics/memory.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hotfire::model {
namespace {

using Number = Perturbed<4>;

/// A number with another one under each change.
Number number_of(double value, const std::array<double, Number::kChanges>& changed) {
  Number number(value);
  for (int change = 0; change < Number::kChanges; ++change) {
    number.set_changed(change, changed[static_cast<std::size_t>(change)]);
  }
  return number;
}

template <class S>
S expression(const S& x, const S& y) {
  using std::cos;
  using std::expm1;
  using std::log;
  using std::pow;
  using std::sin;
  const S z = (x + y) * x - y / x;
  return sin(z) + cos(y) * exp(x) + log(x) * sqrt(y) + expm1(x) - pow(y, x) + fading_exponential(S(x * y));
}

}  // namespace

TEST_GROUP(Perturbed){};

TEST(Perturbed, EveryLaneHasTheBitsThatItHasAlone) {
  const std::array<double, 3> x{0.71, 0.7000001, 0.69};
  const std::array<double, 3> y{2.3, 2.31, 2.2999};
  const Number both = expression(number_of(0.7, x), number_of(2.3, y));
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  CHECK_TRUE(bits(both.value()) == bits(expression(0.7, 2.3)));
  for (int change = 0; change < Number::kChanges; ++change) {
    const auto i = static_cast<std::size_t>(change);
    CHECK_TRUE(bits(both.changed(change)) == bits(expression(x[i], y[i])));
  }
}

// A quantity that the changes move across zero is one of either sign there.
TEST(Perturbed, APowerHasFiniteChangesWhereTheyChangeItsSign) {
  MemoryParameters<Number> parameters;
  parameters.kind = Memory::odd_power;
  MemoryState<Number> state;
  for (const double value : {1e-8, 1e-6, -1e-7}) {
    const Number power = state.step(parameters, number_of(value, {-1e-5, 1e-5, 0.0}), 1e-3);
    for (int change = 0; change < Number::kChanges; ++change) {
      CHECK_TRUE(std::abs(power.changed(change)) < 1e-9);  // as small as it is at a sign
    }
  }
}

// A command that rests but for rounding has changes that rest entirely.
TEST(Perturbed, AChangeThatLeavesTheDomainGoesAlongTheTangent) {
  const Number ratio = number_of(3e-17, {0.0, 4e-17, 6e-17}) / number_of(1e-17, {0.0, 0.0, 2e-17});
  DOUBLES_EQUAL(3.0 + (0.0 - 3e-17) / 1e-17 - 3.0 * (0.0 - 1e-17) / 1e-17, ratio.changed(0), 1e-12);
  DOUBLES_EQUAL(3.0 + (4e-17 - 3e-17) / 1e-17 - 3.0 * (0.0 - 1e-17) / 1e-17, ratio.changed(1), 1e-12);
  DOUBLES_EQUAL(3.0, ratio.changed(2), 1e-12);
  const Number root = sqrt(number_of(4e-6, {-1e-6, 9e-6, 0.0}));
  DOUBLES_EQUAL(2e-3 - 5e-6 / (2.0 * 2e-3), root.changed(0), 1e-12);
  DOUBLES_EQUAL(3e-3, root.changed(1), 1e-12);
  DOUBLES_EQUAL(0.0, root.changed(2), 1e-12);
  const Number power = pow(number_of(4e-6, {-1e-6, 9e-6, 0.0}), Number(0.5));
  DOUBLES_EQUAL(root.changed(0), power.changed(0), 1e-12);
  DOUBLES_EQUAL(root.changed(1), power.changed(1), 1e-12);
  CHECK_FALSE(
      std::isfinite((Number(1.0) / number_of(0.0, {1.0, 0.0, 2.0})).value()));  // a number that is not finite stays so
}

TEST(Perturbed, APlayOfACommandThatRestsButForRoundingHasFiniteChanges) {
  ValveHysteresis::Params<Number> play;
  play.half_width = Number(0.02);
  ValveHysteresis::State<Number> state;
  ValveHysteresis::come_from(state, Number(0.1));
  const Number value = ValveHysteresis::step(play, state, {Number(0.1), 1e-3, {}, number_of(1e-17, {0.0, 1e-17, -1e-17})});
  for (int change = 0; change < Number::kChanges; ++change) {
    DOUBLES_EQUAL(0.1, value.changed(change), 1e-15);
  }
}

TEST(Perturbed, EveryChoiceIsThatOfTheNumber) {
  // The second change is beyond the limit, and has another sign and another whole part.
  const Number x = number_of(0.9, {0.8, 1.2, -0.1});
  CHECK_TRUE(x < Number(1.0));
  CHECK_FALSE(x > Number(1.0));
  const Number limited = clamp_symmetric<Number>(x, Number(1.0));
  DOUBLES_EQUAL(1.2, limited.changed(1), 0.0);
  DOUBLES_EQUAL(-0.1, abs(x).changed(2), 0.0);
  DOUBLES_EQUAL(0.0, floor(x).changed(1), 0.0);
  DOUBLES_EQUAL(0.9, value_of(x), 0.0);
  DOUBLES_EQUAL(1.0, sign_of(x), 0.0);
}

}  // namespace hotfire::model
