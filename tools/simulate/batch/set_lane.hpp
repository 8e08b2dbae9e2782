// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "model/declaration/effect.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/delay_line.hpp"
#include "model/numerics/lanes.hpp"
#include "model/numerics/members.hpp"

namespace hotfire {

namespace detail {

template <class E>
constexpr bool is_listed() {
  return !requires { E::is_unlisted; };
}

template <class... Lists>
struct Joined;
template <class... Es>
struct Joined<model::EffectList<Es...>> {
  using type = model::EffectList<Es...>;
};
template <class... First, class... Second, class... More>
struct Joined<model::EffectList<First...>, model::EffectList<Second...>, More...>
    : Joined<model::EffectList<First..., Second...>, More...> {};

template <class List>
struct Listed;
template <class... Es>
struct Listed<model::EffectList<Es...>>
    : Joined<model::EffectList<>, std::conditional_t<is_listed<Es>(), model::EffectList<Es>, model::EffectList<>>...> {};

/// The place of an effect in a list.
template <class List, class E>
constexpr std::size_t place_of() {
  std::size_t place = List::size;
  List::for_each([&]<class Own, std::size_t I>() { place = std::is_same_v<Own, E> ? I : place; });
  return place;
}

}  // namespace detail

/// The effects of a list that have a law of their own: those that run in lanes.
template <class List>
using ListedEffects = typename detail::Listed<List>::type;

/// Puts parameters or a state of plain numbers into one lane of the same in lanes, member by member. What is not a number in
/// lanes (an option, a count) is copied: it is the same in all lanes. Effects that the target does not have are left out.
template <class From, class To>
void set_lane(int lane, const From& from, To& to);

template <class From, class To, int Rows, int Columns>
void set_lane(int lane, const Eigen::Matrix<From, Rows, Columns>& from, Eigen::Matrix<To, Rows, Columns>& to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    to.data()[i].set(lane, from.data()[i]);
  }
}

template <class From, class To, std::size_t N>
void set_lane(int lane, const std::array<From, N>& from, std::array<To, N>& to) {
  for (std::size_t i = 0; i < N; ++i) {
    set_lane(lane, from[i], to[i]);
  }
}

template <class From, class To, std::size_t Capacity>
void set_lane(int lane, const model::DelayLine<From, Capacity>& from, model::DelayLine<To, Capacity>& to) {
  to.set_lane(lane, from);
}

template <class S, class T>
void set_lane(int lane, const model::Clock<S>& from, model::Clock<T>& to) {
  to.start.set(lane, from.start);
  to.steps = from.steps;
}

template <class S, class T, class From, class To>
void set_lane(int lane, const model::EffectStates<S, From>& from, model::EffectStates<T, To>& to) {
  To::for_each([&]<class E, std::size_t I>() {
    constexpr std::size_t kPlace = detail::place_of<From, E>();
    set_lane(lane, std::get<kPlace>(from.values), std::get<I>(to.values));
    set_lane(lane, from.outputs[kPlace], to.outputs[I]);
  });
}

template <class S, class T, class From, class To>
void set_lane(int lane, const model::EffectParameters<S, From>& from, model::EffectParameters<T, To>& to) {
  To::for_each([&]<class E, std::size_t I>() {
    constexpr std::size_t kPlace = detail::place_of<From, E>();
    set_lane(lane, std::get<kPlace>(from.values), std::get<I>(to.values));
    to.active[I] = from.active[kPlace];
  });
}

template <class From, class To>
void set_lane(int lane, const From& from, To& to) {
  if constexpr (model::are_lanes<To>) {
    to.set(lane, from);
  } else if constexpr (std::is_arithmetic_v<From>) {
    static_assert(std::is_integral_v<From>, "a number of its own in each run belongs into the scalar of the model");
    to = from;
  } else {
    static_assert(std::is_aggregate_v<From>, "give set_lane an overload for this type");
    auto source = model::tied(from);
    auto target = model::tied(to);
    [&]<std::size_t... I>(std::index_sequence<I...>) { (set_lane(lane, std::get<I>(source), std::get<I>(target)), ...); }
    (std::make_index_sequence<std::tuple_size_v<decltype(source)>>{});
  }
}

}  // namespace hotfire
