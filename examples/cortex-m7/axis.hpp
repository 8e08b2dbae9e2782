// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "axis_image.hpp"
#include "model/image.hpp"
#include "model/simplex.hpp"

/// The plant of this example: one axis with the effects that its model file declares, and no others. An effect that is not
/// in the list costs neither flash nor RAM.
namespace example {

template <class Real>
using Axis =
    hotfire::model::Simplex<Real, hotfire::model::EffectList<hotfire::model::SoftStiffness, hotfire::model::GimbalFriction>>;

/// The model file as constants; the compiler has read and checked them.
template <class Real>
inline constexpr
    typename Axis<Real>::Parameters kAxis = hotfire::model::parameters_of<typename Axis<Real>::Parameters>(kAxisImage);

constexpr double kStep = 5e-4;           ///< s; the model's longest is 0.5 ms
constexpr std::size_t kStepsPerRow = 2;  ///< a command every 1 ms
constexpr std::size_t kChannels = Axis<float>::channels.size();

}  // namespace example
