// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "model/declaration/each_number.hpp"

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

}  // namespace detail

/// The effects of a list that have a law of their own: those that run in lanes.
template <class List>
using ListedEffects = typename detail::Listed<List>::type;

/// Puts parameters or a state of plain numbers into one lane of the same in lanes, member by member. What is not a number in
/// lanes (an option, a count) is copied: it is the same in all lanes. Parameters of inactive effects,
/// and effects that the target does not have, are left out.
template <class From, class To>
void set_lane(int lane, const From& from, To& to) {
  model::each_number(
      to, [&](int) -> const auto& { return from; },
      [lane]<class T>(T& number, const auto& own) {
        if constexpr (model::are_lanes<T>) {
          number.set(lane, own(lane));
        } else if constexpr (std::is_arithmetic_v<T>) {
          number = own(lane);
        } else {
          number.set_lane(lane, own(lane));
        }
      });
}

}  // namespace hotfire
