// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "model/declaration/field.hpp"
#include "model/declaration/sites.hpp"

namespace hotfire::model {

/// An effect is what may be missing in a declared model: one file, one name, one site, a few parameters.
///
/// - `Params<S>`: neutral by default, one scalar a field, and `option` (an index into `options`) if the effect has laws or
///   channels to choose from. `enum class Law` has them in the same order; `law_of<E>(params)` is the chosen one.
/// - `State<S>`: what it remembers.
/// - `step(params, state, input)`: advances the state over one step and returns the site's output. It never throws,
///   allocates or blocks.
///
/// An effect may carry another one of the same additive site: `carries` is that one's name, and `carry(params, state, input,
/// step)` evaluates it by `step(input)`, on what it sees through the carrier. Such an effect adds nothing of its own.
///
/// Optional: `remembers_a_guess` marks an effect whose state is only where its solver starts: every evaluation keeps it.
/// `needs_other_axis` marks an effect that acts only where the engine has another axis, `options_of_two_axes` (a
/// bit each) such laws; `settle(params, state, input)` puts the state where a constant input leaves it;
/// `broken_relation(params)` names a relation between fields that the values break, empty if none.
template <class E, class S>
concept Effect = requires(const typename E::template Params<S>& params, typename E::template State<S>& state,
                          const typename SiteInput<E::site, S>::type& input) {
  { E::name } -> std::convertible_to<std::string_view>;
  { E::options.size() } -> std::convertible_to<std::size_t>;
  { E::template Params<S>::fields().size() } -> std::convertible_to<std::size_t>;
  { E::step(params, state, input) }
  noexcept;
};

/// True for an effect that acts only where the engine has another axis.
template <class E>
constexpr bool needs_other_axis() noexcept {
  return requires { E::needs_other_axis; };
}

/// The same for one of its laws, which alone is another of them.
template <class E>
constexpr bool needs_other_axis(int option) noexcept {
  if constexpr (requires { E::options_of_two_axes; }) {
    return (E::options_of_two_axes >> static_cast<unsigned>(option) & 1U) != 0;
  } else {
    return needs_other_axis<E>();
  }
}

/// For effects that have nothing to choose.
using NoOptions = std::array<std::string_view, 0>;

/// A compile-time list of effects. The order is the order of application at serial sites; elsewhere it has no meaning.
template <class... Es>
struct EffectList {
  static constexpr std::size_t size = sizeof...(Es);

  /// Calls `f.template operator()<E, index>()` for every effect.
  template <class F>
  [[gnu::always_inline]] static constexpr void for_each(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
      (f.template operator()<Es, I>(), ...);
    }
    (std::make_index_sequence<size>{});
  }
};

/// Parameters of every effect of a list, and which of them are active.
template <class S, class List>
struct EffectParameters;

template <class S, class... Es>
struct EffectParameters<S, EffectList<Es...>> {
  static_assert((Effect<Es, S> && ...));
  std::tuple<typename Es::template Params<S>...> values{};
  std::array<bool, sizeof...(Es)> active{};
};

/// The active effects of a list, one bit each: a constant of a run. A site without an active effect costs one test.
template <class List>
class ActingEffects {
 public:
  explicit constexpr ActingEffects(const std::array<bool, List::size>& active) noexcept {
    static_assert(List::size <= 64);
    for (std::size_t i = 0; i < List::size; ++i) {
      bits_ |= std::uint64_t{active[i]} << i;
    }
  }

  template <std::size_t I>
  constexpr bool has() const noexcept {
    return (bits_ >> I & 1U) != 0;
  }

  template <Site site>
  constexpr bool any() const noexcept {
    return (bits_ & kAt<site>) != 0;
  }

 private:
  template <Site site>
  static constexpr std::uint64_t kAt = [] {
    std::uint64_t bits = 0;
    List::for_each([&]<class E, std::size_t I>() { bits |= std::uint64_t{E::site == site} << I; });
    return bits;
  }();

  std::uint64_t bits_ = 0;
};

/// States of every effect of a list, and the output each one gave last (the first guess of the next step).
template <class S, class List>
struct EffectStates;

template <class S, class... Es>
struct EffectStates<S, EffectList<Es...>> {
  std::tuple<typename Es::template State<S>...> values{};
  std::array<S, sizeof...(Es)> outputs{};
};

/// Whether an evaluation keeps its final states. A step evaluates its effects more than once and keeps the states of the
/// last evaluation.
enum class Keep { no, yes };

namespace detail {

/// The channel that a sensor's effect acts on: its option, unless it is made for one.
template <class E, class Params>
constexpr int channel_of(const Params& params) noexcept {
  if constexpr (requires { E::sensor_channel; }) {
    return E::sensor_channel;
  } else {
    return params.option;
  }
}

}  // namespace detail

namespace detail {

template <class S>
void pass_on(Signal<S>& input, const S& output) noexcept {
  input.value = output;
}
template <class S>
void pass_on(Spring<S>& input, const Spring<S>& output) noexcept {
  input = output;
}

/// Sets the motion of the body without the force that an effect gave last; other sites have no such motion.
template <class S>
void take_force_out(Motion<S>& input, const S& force) noexcept {
  input.free_velocity = input.velocity + input.compliance * force;
}
template <class Input, class S>
void take_force_out(const Input&, const S&) noexcept {}

/// True for an effect whose state is only the start of a solver and changes no result.
template <class E>
constexpr bool remembers_a_guess() noexcept {
  return requires { E::remembers_a_guess; };
}

template <class E, class Params, class State, class Input>
auto evaluate_in_place(const Params& params, State& state, const Input& input, Keep keep) noexcept {
  if (remembers_a_guess<E>() || keep == Keep::yes) {
    return E::step(params, state, input);
  }
  State trial = state;
  return E::step(params, trial, input);
}

template <class E, class Params, class State, class Input>
[[gnu::noinline]] auto evaluate_apart(const Params& params, State& state, const Input& input, Keep keep) noexcept {
  return evaluate_in_place<E>(params, state, input, keep);
}

/// Terms of unknown law are most of the code of a step, and few plants have one. They are not inlined, so that the rest of a
/// step is contiguous in memory.
template <class E, class Params, class State, class Input>
auto evaluate(const Params& params, State& state, const Input& input, Keep keep) noexcept {
  if constexpr (requires { E::is_unlisted; }) {
    return evaluate_apart<E>(params, state, input, keep);
  } else {
    return evaluate_in_place<E>(params, state, input, keep);
  }
}

}  // namespace detail

namespace detail {

/// Calls `f.template operator()<Carrier, index>()` for the effect of the list that carries E, if there is one.
template <class E, class List, class F>
void with_carrier(F&& f) noexcept {
  List::for_each([&]<class C, std::size_t I>() {
    if constexpr (requires { C::carries; }) {
      if constexpr (C::carries == E::name) {
        f.template operator()<C, I>();
      }
    }
  });
}

/// The output of one effect of an additive site, through its carrier if that is active.
template <class E, std::size_t I, class S, class List, class Input>
S output_of(const EffectParameters<S, List>& parameters, const ActingEffects<List>& acting, EffectStates<S, List>& states,
            const Input& input, Keep keep) noexcept {
  bool carried = false;
  S output{0.0};
  with_carrier<E, List>([&]<class C, std::size_t K>() {
    if (acting.template has<K>()) {
      auto own = std::get<I>(states.values);
      auto carrier = std::get<K>(states.values);
      carried = true;
      output = C::carry(std::get<K>(parameters.values), carrier, input, [&](const Input& seen) {
        own = std::get<I>(states.values);
        return E::step(std::get<I>(parameters.values), own, seen);
      });
      if (keep == Keep::yes) {
        std::get<I>(states.values) = own;
        std::get<K>(states.values) = carrier;
      }
    }
  });
  return carried ? output : evaluate<E>(std::get<I>(parameters.values), std::get<I>(states.values), input, keep);
}

}  // namespace detail

namespace detail {

template <Site site, class S, class List>
[[gnu::always_inline]] inline void pass_through_acting(const EffectParameters<S, List>& parameters,
                                                       const ActingEffects<List>& acting, EffectStates<S, List>& states,
                                                       typename SiteInput<site, S>::type& value, Keep keep) noexcept {
  List::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
    if constexpr (E::site == site) {
      if (acting.template has<I>()) {
        pass_on(value, evaluate<E>(std::get<I>(parameters.values), std::get<I>(states.values), value, keep));
      }
    }
  });
}

template <Site site, class S, class List>
[[gnu::always_inline]] inline S sum_over_acting(const EffectParameters<S, List>& parameters,
                                                const ActingEffects<List>& acting, EffectStates<S, List>& states,
                                                typename SiteInput<site, S>::type& input, Keep keep) noexcept {
  S total{0.0};
  List::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
    if constexpr (E::site == site) {
      if (acting.template has<I>()) {
        take_force_out(input, states.outputs[I]);
        states.outputs[I] = output_of<E, I>(parameters, acting, states, input, keep);
        total += states.outputs[I];
      }
    }
  });
  return total;
}

}  // namespace detail

// Both are inlined into the step, so that a site at which nothing acts costs one test. Apart from the test, the walks above
// leave the compiler a step that is 1 % shorter than with the walk in the same function.

/// Passes `value` through the active effects of a serial site, in the order of the list.
template <Site site, class S, class List>
[[gnu::always_inline]] inline void pass_through(const EffectParameters<S, List>& parameters,
                                                const ActingEffects<List>& acting, EffectStates<S, List>& states,
                                                typename SiteInput<site, S>::type& value, Keep keep) noexcept {
  static_assert(is_serial(site) && site != Site::sensor);
  if (acting.template any<site>()) {
    detail::pass_through_acting<site, S, List>(parameters, acting, states, value, keep);
  }
}

/// Sum of the active effects of an additive site. At sites with a motion, `input` is left with the free velocity of the
/// last effect.
template <Site site, class S, class List>
[[gnu::always_inline]] inline S sum_over(const EffectParameters<S, List>& parameters, const ActingEffects<List>& acting,
                                         EffectStates<S, List>& states, typename SiteInput<site, S>::type& input,
                                         Keep keep) noexcept {
  static_assert(!is_serial(site));
  return acting.template any<site>() ? detail::sum_over_acting<site, S, List>(parameters, acting, states, input, keep)
                                     : S{0.0};
}

/// Share of a step after which the effects give their force at its end: short enough that nothing else moves, long enough
/// that a body at rest shows where it would go.
inline constexpr double kInstant = 1e-3;

/// The force at the end of a step: that of a short further step from the motion there. `body`: that motion, with the change
/// of velocity by a unit of force in a second as its compliance. `acceleration`: without the effects. Friction that holds a
/// body balances the other forces at that instant.
template <Site site, class S, class List>
S sum_at_end(const EffectParameters<S, List>& parameters, const ActingEffects<List>& acting, EffectStates<S, List>& states,
             Motion<S> body, const S& acceleration) noexcept {
  if (!acting.template any<site>()) {
    return S{0.0};
  }
  const auto outputs = states.outputs;
  S last{0.0};
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == site) {
      last += acting.template has<I>() ? outputs[I] : S{0.0};
    }
  });
  body.h *= kInstant;
  body.velocity += body.h * (acceleration - body.compliance * last);
  body.free_velocity = body.velocity;
  body.compliance *= body.h;
  S total = detail::sum_over_acting<site, S, List>(parameters, acting, states, body, Keep::no);
  states.outputs = outputs;
  return total;
}

/// Passes a measured value through the active sensor effects of one channel.
template <class S, class List>
S pass_through_sensor(int channel, const EffectParameters<S, List>& parameters, const ActingEffects<List>& acting,
                      EffectStates<S, List>& states, Signal<S> input) noexcept {
  List::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
    if constexpr (E::site == Site::sensor) {
      if (acting.template has<I>() && detail::channel_of<E>(std::get<I>(parameters.values)) == channel) {
        input.value = E::step(std::get<I>(parameters.values), std::get<I>(states.values), input);
      }
    }
  });
  return input.value;
}

/// Sets the states of the active sensor effects of one channel to their values under a constant reading, each under the
/// steady output of the one before it.
template <class S, class List>
void settle_channel(int channel, const EffectParameters<S, List>& parameters, EffectStates<S, List>& states,
                    Signal<S> input) noexcept {
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == Site::sensor) {
      if (parameters.active[I] && detail::channel_of<E>(std::get<I>(parameters.values)) == channel) {
        if constexpr (requires { E::settle(std::get<I>(parameters.values), std::get<I>(states.values), input); }) {
          E::settle(std::get<I>(parameters.values), std::get<I>(states.values), input);
        }
        // On a copy: the first reading is the first step of the state.
        auto state = std::get<I>(states.values);
        input.value = E::step(std::get<I>(parameters.values), state, input);
      }
    }
  });
}

/// Sets the states of the active effects of one site to their values under a constant input.
template <Site site, class S, class List>
void settle(const EffectParameters<S, List>& parameters, EffectStates<S, List>& states,
            const typename SiteInput<site, S>::type& input) noexcept {
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == site &&
                  requires { E::settle(std::get<I>(parameters.values), std::get<I>(states.values), input); }) {
      if (parameters.active[I]) {
        E::settle(std::get<I>(parameters.values), std::get<I>(states.values), input);
      }
    }
  });
}

/// Lets the active effects of one site that have a play come from the input `before`. Returns whether there is one.
template <Site site, class S, class List>
bool come_from(const EffectParameters<S, List>& parameters, EffectStates<S, List>& states, const S& before) noexcept {
  bool any = false;
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == site && requires { E::come_from(std::get<I>(states.values), before); }) {
      if (parameters.active[I]) {
        E::come_from(std::get<I>(states.values), before);
        any = true;
      }
    }
  });
  return any;
}

/// True if an active effect of the list enters at `site`.
template <Site site, class S, class List>
bool any_active(const EffectParameters<S, List>& parameters) noexcept {
  bool any = false;
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == site) {
      any = any || parameters.active[I];
    }
  });
  return any;
}

}  // namespace hotfire::model
