// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "model/checks.hpp"
#include "tests/model/support/every_effect.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::test {
namespace {

constexpr double kStep = 5e-4;

/// Largest difference between two outputs, relative to the larger of them.
double relative_difference(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double scale = std::max({std::abs(a[i]), std::abs(b[i]), std::numeric_limits<double>::min()});
    worst = std::max(worst, std::abs(a[i] - b[i]) / scale);
  }
  return worst;
}

/// True if a name can be a configuration key: lower case, digits, underscores.
bool is_key(std::string_view name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

template <class T>
std::array<unsigned char, sizeof(T)> bytes_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::array<unsigned char, sizeof(T)> bytes{};
  if constexpr (!std::is_empty_v<T>) {
    std::memcpy(bytes.data(), &value, sizeof(T));
  }
  return bytes;
}

}  // namespace

TEST_GROUP(EveryEffect){};

TEST(EveryEffect, HasItsDefaultsAndItsTypicalValuesInsideTheBounds) {
  for_each_law([]<class E>(int option) {
    const auto params = neutral<E, double>(option);
    for (const auto& field : ParamsOf<E, double>::fields()) {
      const std::string where = label<E>(option) + " " + std::string(field.name);
      CHECK_TRUE_TEXT(field.lower < field.upper, where.c_str());
      CHECK_TRUE_TEXT(model::is_inside(field, params.*field.member), where.c_str());
      CHECK_TRUE_TEXT(model::is_inside(field, field.typical), where.c_str());
    }
  });
}

TEST(EveryEffect, RefusesANumberThatIsNotOneInAnyField) {
  for_each_law([]<class E>(int option) {
    for (const auto& field : ParamsOf<E, double>::fields()) {
      const std::string where = label<E>(option) + " " + std::string(field.name);
      CHECK_FALSE_TEXT(model::is_inside(field, std::numeric_limits<double>::quiet_NaN()), where.c_str());
      CHECK_FALSE_TEXT(model::is_inside(field, std::numeric_limits<double>::infinity()), where.c_str());
      CHECK_FALSE_TEXT(model::is_inside(field, -std::numeric_limits<double>::infinity()), where.c_str());
    }
  });
}

TEST(EveryEffect, HasNamesThatAreKeysAndSaysWhatEachMeans) {
  const auto check_list = []<class List>(const List&) {
    std::set<std::string_view> effects;
    List::for_each([&]<class E, std::size_t>() {
      CHECK_TRUE(is_key(E::name));
      CHECK_TRUE_TEXT(effects.insert(E::name).second, std::string(E::name).c_str());
      std::set<std::string_view> names{"option"};
      for (const auto& field : ParamsOf<E, double>::fields()) {
        const std::string where = label<E>(0) + " " + std::string(field.name);
        CHECK_TRUE_TEXT(is_key(field.name) && names.insert(field.name).second, where.c_str());
        CHECK_FALSE_TEXT(field.meaning.empty(), where.c_str());
      }
      for (const std::string_view option : E::options) {
        CHECK_TRUE_TEXT(is_key(option) && names.insert(option).second, std::string(option).c_str());
      }
    });
  };
  check_list(model::SimplexEffects{});
  check_list(model::DirectEffects{});
}

TEST(EveryEffect, HasAParameterForEachOfItsLaws) {
  for_each_law([]<class E>(int option) {
    bool used = false;
    for (const auto& field : ParamsOf<E, double>::fields()) {
      used = used || used_by(field, option);
    }
    if constexpr (requires { ParamsOf<E, double>::tables(); }) {
      for (const auto& table : ParamsOf<E, double>::tables()) {
        used = used || used_by(table, option);
      }
    }
    CHECK_TRUE_TEXT(used, label<E>(option).c_str());
  });
}

// Additive: exactly zero. Serial: exactly the input, but for the soft spring, which solves for its force and so comes back
// with the rounding of that solution.
TEST(EveryEffect, ChangesNothingAtItsNeutralParameters) {
  for_each_law([]<class E>(int option) {
    Random random(1);
    const auto params = neutral<E, double>(option);
    StateOf<E, double> state{};
    constexpr double tolerance = std::is_same_v<E, model::SoftStiffness> ? 1e-12 : 0.0;
    for (int i = 0; i < 1000; ++i) {
      const auto input = random_input<E>(random, kStep);
      const auto output = plain(E::step(params, state, input));
      std::array<double, 2> expected{0.0, 0.0};
      if constexpr (model::is_serial(E::site)) {
        expected = untouched(input);
      }
      CHECK_TRUE_TEXT(relative_difference(output, expected) <= tolerance, label<E>(option).c_str());
    }
  });
}

TEST(EveryEffect, IgnoresTheFieldsOfItsOtherLaws) {
  for_each_law([]<class E>(int option) {
    const auto own = typical<E, double>(option);
    auto with_others = own;
    for (const auto& field : ParamsOf<E, double>::fields()) {
      if (!used_by(field, option)) {
        with_others.*field.member = field.typical;
      }
    }
    StateOf<E, double> state{};
    StateOf<E, double> other_state{};
    for (int k = 0; k < 2000; ++k) {
      const auto input = smooth_input<E>(k * kStep, kStep);
      const auto output = plain(E::step(own, state, input));
      CHECK_TRUE_TEXT(output == plain(E::step(with_others, other_state, input)), label<E>(option).c_str());
    }
  });
}

TEST(EveryEffect, StaysFiniteForAnyParametersInsideTheBounds) {
  for_each_law([]<class E>(int option) {
    Random random(2);
    for (int i = 0; i < 500; ++i) {
      const auto params = random_params<E>(random, option);
      const double h = random.logarithmic(2e-5, 2e-3);
      StateOf<E, double> state{};
      for (int k = 0; k < 40; ++k) {
        const auto output = plain(E::step(params, state, random_input<E>(random, h)));
        CHECK_TRUE_TEXT(std::isfinite(output[0]) && std::isfinite(output[1]), label<E>(option).c_str());
      }
    }
  });
}

TEST(EveryEffect, TakesNothingFromTheHeap) {
  for_each_law([]<class E>(int option) {
    Random random(4);
    const auto params = random_params<E>(random, option);
    StateOf<E, double> state{};
    const AllocationGuard guard;
    for (int k = 0; k < 100; ++k) {
      static_cast<void>(E::step(params, state, random_input<E>(random, kStep)));
    }
    const std::uint64_t allocations = guard.allocations();
    LONGS_EQUAL_TEXT(0, allocations, label<E>(option).c_str());
  });
}

TEST(EveryEffect, GivesTheSameBitsFromACopyOfItsState) {
  for_each_law([]<class E>(int option) {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
      const auto params = random_params<E>(random, option);
      StateOf<E, double> state{};
      for (int k = 0; k < 20; ++k) {
        const auto input = random_input<E>(random, kStep);
        StateOf<E, double> copy = state;
        const auto output = plain(E::step(params, state, input));
        const auto again = plain(E::step(params, copy, input));
        CHECK_TRUE_TEXT(bytes_of(output) == bytes_of(again), label<E>(option).c_str());
        CHECK_TRUE_TEXT(bytes_of(state) == bytes_of(copy), label<E>(option).c_str());
      }
    }
  });
}

// A smooth motion of 1 s. Rounding of float is 6e-8; a bristle, a lag and a mode add up a few hundred roundings of the state
// they remember, and a friction force near reversal magnifies them by the ratio of level to stiffness times state, about 10.
TEST(EveryEffect, AgreesInFloatAndDouble) {
  for_each_law([]<class E>(int option) {
    const auto in_double = typical<E, double>(option);
    const auto in_float = typical<E, float>(option);
    StateOf<E, double> state{};
    StateOf<E, float> small_state{};
    double largest = 0.0;
    double difference = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const auto input = smooth_input<E>(k * kStep, kStep);
      const auto output = plain(E::step(in_double, state, input));
      const auto small = plain(E::step(in_float, small_state, converted<float>(input)));
      largest = std::max(largest, std::abs(output[0]));
      difference = std::max({difference, std::abs(output[0] - small[0]), std::abs(output[1] - small[1])});
    }
    CHECK_TRUE_TEXT(largest > 0.0 || carries_another<E>(), label<E>(option).c_str());
    if (difference > 1e-4 * largest) {
      FAIL((label<E>(option) + ": relative difference " + std::to_string(difference / largest)).c_str());
    }
  });
}

// What a command or a force that has always been there leaves behind is what stepping from it keeps.
TEST(EveryEffect, StaysWhereSettlingPutsIt) {
  for_each_law([]<class E>(int option) {
    if constexpr (requires(const ParamsOf<E, double>& params, StateOf<E, double>& state, const InputOf<E, double>& input) {
                    E::settle(params, state, input);
                  }) {
      if (depends_on_time<E>(option)) {
        return;
      }
      const auto params = typical<E, double>(option);
      const auto input = smooth_input<E>(0.1, kStep);
      StateOf<E, double> state{};
      E::settle(params, state, input);
      const auto first = plain(E::step(params, state, input));
      for (int k = 0; k < 1000; ++k) {
        const auto next = plain(E::step(params, state, input));
        CHECK_TRUE_TEXT(relative_difference(first, next) < 1e-12, label<E>(option).c_str());
      }
    }
  });
}

TEST(EveryEffect, OfAWiperThatSticksTheReadingFollowsAtTheHalfWidthOfItsPlay) {
  using E = model::UnlistedWiperPlay;
  const auto params = typical<E, double>(option_named<E>("piston"));
  StateOf<E, double> state{};
  E::settle(params, state, model::Signal<double>{0.01, kStep});
  double reading = 0.0;
  const auto go = [&](double from, double to) {
    for (int k = 0; k <= 100; ++k) {
      reading = E::step(params, state, model::Signal<double>{from + (to - from) * k / 100.0, kStep});
    }
  };
  go(0.01, 0.01 + 0.9 * params.half_width);
  DOUBLES_EQUAL(0.01, reading, 1e-15);
  go(0.01 + 0.9 * params.half_width, 0.02);
  DOUBLES_EQUAL(0.02 - params.half_width, reading, 1e-15);
  go(0.02, 0.0);
  DOUBLES_EQUAL(params.half_width, reading, 1e-15);
}

}  // namespace hotfire::test
