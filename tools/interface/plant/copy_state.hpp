// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "model/numerics/delay_line.hpp"
#include "model/numerics/memory.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::plant {

namespace detail {

/// Represents a member of any type when the members of an aggregate are counted.
struct AnyMember {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): the conversion is what counts the members
};

/// How many members an aggregate has: as many as its braces take.
template <class T, class... Members>
constexpr std::size_t members_of() {
  if constexpr (requires { T{Members{}..., AnyMember{}}; }) {
    return members_of<T, Members..., AnyMember>();
  } else {
    return sizeof...(Members);
  }
}

/// The members of an aggregate as a tuple of references.
template <class T>
constexpr auto tied(T& value) {
  constexpr std::size_t kMembers = members_of<std::remove_const_t<T>>();
  static_assert(kMembers <= 8, "give `tied` a case for this many members");
  if constexpr (kMembers == 0) {
    return std::tuple<>();
  } else if constexpr (kMembers == 1) {
    auto& [a] = value;
    return std::tie(a);
  } else if constexpr (kMembers == 2) {
    auto& [a, b] = value;
    return std::tie(a, b);
  } else if constexpr (kMembers == 3) {
    auto& [a, b, c] = value;
    return std::tie(a, b, c);
  } else if constexpr (kMembers == 4) {
    auto& [a, b, c, d] = value;
    return std::tie(a, b, c, d);
  } else if constexpr (kMembers == 5) {
    auto& [a, b, c, d, e] = value;
    return std::tie(a, b, c, d, e);
  } else if constexpr (kMembers == 6) {
    auto& [a, b, c, d, e, f] = value;
    return std::tie(a, b, c, d, e, f);
  } else if constexpr (kMembers == 7) {
    auto& [a, b, c, d, e, f, g] = value;
    return std::tie(a, b, c, d, e, f, g);
  } else {
    auto& [a, b, c, d, e, f, g, h] = value;
    return std::tie(a, b, c, d, e, f, g, h);
  }
}

}  // namespace detail

/// Copies a plant's state in one scalar into the same state in another, value by value; the derivatives of a dual number
/// become zero. Goes through the members of every aggregate, so that a state needs no list of its members.
template <class From, class To>
void copy_state(const From& from, To& to);

template <class From, class To, int Rows, int Columns>
void copy_state(const Eigen::Matrix<From, Rows, Columns>& from, Eigen::Matrix<To, Rows, Columns>& to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    to.data()[i] = To(model::value_of(from.data()[i]));
  }
}

template <class From, class To, std::size_t N>
void copy_state(const std::array<From, N>& from, std::array<To, N>& to) {
  for (std::size_t i = 0; i < N; ++i) {
    copy_state(from[i], to[i]);
  }
}

template <class... From, class... To>
void copy_state(const std::tuple<From...>& from, std::tuple<To...>& to) {
  [&]<std::size_t... I>(std::index_sequence<I...>) { (copy_state(std::get<I>(from), std::get<I>(to)), ...); }
  (std::index_sequence_for<From...>{});
}

template <class From, class To, std::size_t Capacity>
void copy_state(const model::DelayLine<From, Capacity>& from, model::DelayLine<To, Capacity>& to) {
  to = model::DelayLine<To, Capacity>(from);
}

template <class From, class To>
void copy_state(const model::MemoryState<From>& from, model::MemoryState<To>& to) {
  to = model::MemoryState<To>(from);
}

template <class From, class To>
void copy_state(const From& from, To& to) {
  if constexpr (std::is_arithmetic_v<From>) {
    to = To(from);
  } else {
    static_assert(std::is_aggregate_v<From>, "give copy_state an overload for this type");
    auto source = detail::tied(from);
    auto target = detail::tied(to);
    [&]<std::size_t... I>(std::index_sequence<I...>) { (copy_state(std::get<I>(source), std::get<I>(target)), ...); }
    (std::make_index_sequence<std::tuple_size_v<decltype(source)>>{});
  }
}

}  // namespace hotfire::plant
