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

namespace hotfire::model {

/// Parameters or a state in lanes beside the same in plain numbers, one of them in each lane.
///
/// `each_number(lanes, plain, f)` calls `f(number, own)` for every member that is a number in lanes, and `f(shared, own)`
/// for every one that is not (an option, a count) and so is the same in all lanes. `plain(lane)` is the struct of plain
/// numbers in a lane, and `own(lane)` the member of it. A `DelayLine` is given to `f` as a whole. The effects of `lanes` may
/// be a part of those of `plain`. Parameters of effects that are inactive in lane 0 are left out.
template <class InLanes, class Plain, class F>
[[gnu::always_inline]] inline void each_number(InLanes& lanes, const Plain& plain, const F& f);

namespace detail {

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};

template <class T>
struct IsMatrix : std::false_type {};
template <class T, int Rows, int Columns>
struct IsMatrix<Eigen::Matrix<T, Rows, Columns>> : std::true_type {};

template <class T>
struct IsEffectParameters : std::false_type {};
template <class S, class List>
struct IsEffectParameters<EffectParameters<S, List>> : std::true_type {
  using Effects = List;
};

template <class T>
struct IsEffectStates : std::false_type {};
template <class S, class List>
struct IsEffectStates<EffectStates<S, List>> : std::true_type {
  using Effects = List;
};

template <class T>
struct IsDelayLine : std::false_type {};
template <class S, std::size_t Capacity>
struct IsDelayLine<DelayLine<S, Capacity>> : std::true_type {};

/// The place of an effect in a list.
template <class List, class E>
constexpr std::size_t place_of() {
  std::size_t place = List::size;
  List::for_each([&]<class Own, std::size_t I>() { place = std::is_same_v<Own, E> ? I : place; });
  return place;
}

template <class T>
struct IsClock : std::false_type {};
template <class S>
struct IsClock<Clock<S>> : std::true_type {};

template <class InLanes, class Plain, class F>
[[gnu::always_inline]] inline void each_member(InLanes& lanes, const Plain& plain, const F& f) {
  auto members = tied(lanes);
  [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
    (each_number(
         std::get<I>(members),
         [&](int lane) __attribute__((always_inline))->auto& { return std::get<I>(tied(plain(lane))); }, f),
     ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(members)>>{});
}

/// The state of effect E and its last output.
template <class E, std::size_t I, class InLanes, class Plain, class F>
[[gnu::always_inline]] inline void each_of_effect(InLanes& lanes, const Plain& plain, const F& f) {
  constexpr std::size_t kPlace = place_of<typename IsEffectStates<std::remove_cvref_t<decltype(plain(0))>>::Effects, E>();
  each_number(
      std::get<I>(lanes.values),
      [&](int lane) __attribute__((always_inline))->auto& { return std::get<kPlace>(plain(lane).values); }, f);
  f(
      lanes.outputs[I], [&](int lane) __attribute__((always_inline))->auto& { return plain(lane).outputs[kPlace]; });
}

}  // namespace detail

template <class InLanes, class Plain, class F>
[[gnu::always_inline]] inline void each_number(InLanes& lanes, const Plain& plain, const F& f) {
  using Type = std::remove_const_t<InLanes>;
  if constexpr (are_lanes<Type> || detail::IsDelayLine<Type>::value) {
    f(lanes, plain);
  } else if constexpr (std::is_arithmetic_v<Type>) {
    static_assert(std::is_integral_v<Type>, "a number of its own in each lane belongs into the scalar of the model");
    f(lanes, plain);
  } else if constexpr (detail::IsMatrix<Type>::value) {
    for (Eigen::Index i = 0; i < lanes.size(); ++i) {
      each_number(
          lanes.data()[i], [&](int lane) __attribute__((always_inline))->auto& { return plain(lane).data()[i]; }, f);
    }
  } else if constexpr (detail::IsArray<Type>::value) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      each_number(
          lanes[i], [&](int lane) __attribute__((always_inline))->auto& { return plain(lane)[i]; }, f);
    }
  } else if constexpr (detail::IsEffectParameters<Type>::value) {
    using From = typename detail::IsEffectParameters<std::remove_cvref_t<decltype(plain(0))>>::Effects;
    detail::IsEffectParameters<Type>::Effects::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
      constexpr std::size_t kPlace = detail::place_of<From, E>();
      each_number(
          lanes.active[I], [&](int lane) __attribute__((always_inline))->auto& { return plain(lane).active[kPlace]; }, f);
      if (plain(0).active[kPlace]) {
        each_number(
            std::get<I>(lanes.values),
            [&](int lane) __attribute__((always_inline))->auto& { return std::get<kPlace>(plain(lane).values); }, f);
      }
    });
  } else if constexpr (detail::IsEffectStates<Type>::value) {
    detail::IsEffectStates<Type>::Effects::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
      detail::each_of_effect<E, I>(lanes, plain, f);
    });
  } else if constexpr (detail::IsClock<Type>::value) {
    f(
        lanes.start, [&](int lane) __attribute__((always_inline))->auto& { return plain(lane).start; });
    f(
        lanes.steps, [&](int lane) __attribute__((always_inline))->auto& { return plain(lane).steps; });
  } else {
    static_assert(std::is_aggregate_v<Type>, "give each_number a case for this type");
    detail::each_member(lanes, plain, f);
  }
}

/// The same for the states of the effects that act.
template <class InLanes, class List, class Plain, class F>
[[gnu::always_inline]] inline void each_number(InLanes& lanes, const ActingEffects<List>& acting, const Plain& plain,
                                               const F& f) {
  List::for_each([&]<class E, std::size_t I>() __attribute__((always_inline)) {
    if (acting.template has<I>()) {
      detail::each_of_effect<E, I>(lanes, plain, f);
    }
  });
}

/// For `each_number`: takes every plain number into its lane. What the lanes share is that of lane 0.
struct IntoLanes {
  template <class T, class Own>
  [[gnu::always_inline]] void operator()(T& number, const Own& own) const noexcept {
    if constexpr (are_lanes<T>) {
      number = T::by_lane(own);
    } else {
      number = own(0);
    }
  }
};

/// For `each_number`: gives every lane to its plain number.
template <int Count>
struct OutOfLanes {
  template <class T, class Own>
  [[gnu::always_inline]] void operator()(const T& number, const Own& own) const noexcept {
    for (int lane = 0; lane < Count; ++lane) {
      if constexpr (are_lanes<T>) {
        own(lane) = number[lane];
      } else {
        own(lane) = number;
      }
    }
  }
};

/// For `each_number`: clears `alike` if what the lanes would share is not the same in all plain structs.
template <int Count>
struct CompareShared {
  bool& alike;
  template <class T, class Own>
  void operator()(const T&, const Own& own) const noexcept {
    for (int lane = 0; lane < Count && !are_lanes<T>; ++lane) {
      alike = alike && own(lane) == own(0);
    }
  }
};

}  // namespace hotfire::model
