// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "model/numerics/delay_line.hpp"
#include "model/numerics/members.hpp"
#include "model/numerics/memory.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::plant {

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
    auto source = model::tied(from);
    auto target = model::tied(to);
    [&]<std::size_t... I>(std::index_sequence<I...>) { (copy_state(std::get<I>(source), std::get<I>(target)), ...); }
    (std::make_index_sequence<std::tuple_size_v<decltype(source)>>{});
  }
}

}  // namespace hotfire::plant
