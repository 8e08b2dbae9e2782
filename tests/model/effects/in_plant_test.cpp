// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/model/support/plants.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::test {
namespace {

constexpr double kSample = 1e-3;

/// The serial effects of a list in their order, and behind them the additive ones turned round.
template <class Serial, class Additive, class... Es>
struct Turned;
template <class... Serial, class... Additive>
struct Turned<model::EffectList<Serial...>, model::EffectList<Additive...>> {
  using type = model::EffectList<Serial..., Additive...>;
};
template <class... Serial, class... Additive, class E, class... Rest>
struct Turned<model::EffectList<Serial...>, model::EffectList<Additive...>, E, Rest...>
    : std::conditional_t<model::is_serial(E::site),
                         Turned<model::EffectList<Serial..., E>, model::EffectList<Additive...>, Rest...>,
                         Turned<model::EffectList<Serial...>, model::EffectList<E, Additive...>, Rest...>> {};
template <class... Es>
typename Turned<model::EffectList<>, model::EffectList<>, Es...>::type turned(const model::EffectList<Es...>&);

/// Every effect of the plant active at its typical values.
template <class Plant>
typename Plant::Parameters all_active() {
  typename Plant::Parameters parameters = reference_parameters<Plant>();
  Plant::Effects::for_each(
      [&]<class E, std::size_t>() { activate<E, Plant>(parameters, typical<E, typename Plant::Scalar>(0)); });
  return parameters;
}

template <class Plant, class PlantTurned>
void check_order_of_additive_effects() {
  const auto rows = record<Plant>(all_active<Plant>(), 1.0, kSample, 2);
  const auto turned_rows = record<PlantTurned>(all_active<PlantTurned>(), 1.0, kSample, 2);
  for (std::size_t channel = 0; channel < Plant::channels.size(); ++channel) {
    // 2,000 steps of rounding 1e-16, magnified by the loop's condition (pressure from a difference of flows), at most 1e4.
    CHECK_TRUE(relative_rms(turned_rows, rows, channel) < 1e-9);
  }
}

template <class Plant>
std::uint64_t allocations_of_stepping() {
  const Plant plant(all_active<Plant>(), 5e-4);
  auto state = rest(plant);
  const AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    plant.step(state, lively_input(plant, 5e-4 * k));
  }
  return guard.allocations();
}

}  // namespace

TEST_GROUP(EffectInPlant){};

// Rounding: a run of 1,000 samples, 2,000 steps of 1e-16 each, with the same factor of 1e4 as above. An effect that carries
// another one finds the speed of that one's slip by iterating, where it takes the last pass's otherwise: both are within the
// error of the step, 1e-5 by agreement with CVODE.
TEST(EffectInPlant, LeavesThePlantAsItWasWhenNeutral) {
  for_each_planted_law([]<class Plant, class E>(int option) {
    typename Plant::Parameters parameters = parameters_around<Plant, E>();
    const auto without = record<Plant>(parameters, 1.0, kSample, 2);
    activate<E, Plant>(parameters, neutral<E, double>(option));
    const auto with = record<Plant>(parameters, 1.0, kSample, 2);
    for (std::size_t channel = 0; channel < Plant::channels.size(); ++channel) {
      CHECK_TRUE_TEXT(relative_rms(with, without, channel) < (carries_another<E>() ? 2e-5 : 1e-9), label<E>(option).c_str());
    }
  });
}

TEST(EffectInPlant, ShowsInThePlantAtItsTypicalValues) {
  for_each_planted_law([]<class Plant, class E>(int option) {
    typename Plant::Parameters parameters = parameters_around<Plant, E>();
    const auto without = record<Plant>(parameters, 1.0, kSample, 2);
    activate<E, Plant>(parameters, typical<E, double>(option));
    const auto with = record<Plant>(parameters, 1.0, kSample, 2);
    double largest = 0.0;
    for (std::size_t channel = 0; channel < Plant::channels.size(); ++channel) {
      largest = std::max(largest, relative_rms(with, without, channel));
    }
    // A hundredth of a percent: below that no record could tell the effect, and a search could not start there.
    CHECK_TRUE_TEXT(largest > 1e-4, label<E>(option).c_str());
  });
}

// Against a run with 32 steps a sample, a first-order method at 2 and at 8 steps stands at (1/2 - 1/32) : (1/8 - 1/32) = 5
// : 1. Half is asked: stick and slip set in at instants that a coarse step moves by up to itself. Below 5e-6 of the signal,
// a thousandth of what is allowed, that scatter is all there is.
TEST(EffectInPlant, ConvergesWhenTheStepIsHalved) {
  for_each_planted_law([]<class Plant, class E>(int option) {
    if (jumps<E>(option)) {
      return;
    }
    typename Plant::Parameters parameters = parameters_around<Plant, E>();
    activate<E, Plant>(parameters, typical<E, double>(option));
    const auto reference = record<Plant>(parameters, 1.0, kSample, 32);
    const double coarse = relative_rms(record<Plant>(parameters, 1.0, kSample, 2), reference, 0);
    const double fine = relative_rms(record<Plant>(parameters, 1.0, kSample, 8), reference, 0);
    if (!(fine < 0.5 * coarse || fine < 5e-6)) {
      FAIL((label<E>(option).append(": ").append(std::to_string(coarse)).append(" -> ").append(std::to_string(fine)))
               .c_str());
    }
    // At the two steps a sample of 1 kHz that the tools take, every effect alone is below half a percent.
    CHECK_TRUE_TEXT(coarse < 5e-3, label<E>(option).c_str());
  });
}

TEST(EffectInPlant, AddsUpInAnyOrderAtAdditiveSites) {
  check_order_of_additive_effects<model::Simplex<double>,
                                  model::Simplex<double, decltype(turned(model::SimplexEffects{}))>>();
  check_order_of_additive_effects<model::Direct<double>, model::Direct<double, decltype(turned(model::DirectEffects{}))>>();
}

TEST(EffectInPlant, TakesNothingFromTheHeapWhileThePlantSteps) {
  LONGS_EQUAL(0, allocations_of_stepping<model::Simplex<double>>());
  LONGS_EQUAL(0, allocations_of_stepping<model::Direct<double>>());
  LONGS_EQUAL(0, allocations_of_stepping<model::Electromechanical<double>>());
}

}  // namespace hotfire::test
