// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "tools/files/model/model_file.hpp"

namespace hotfire {

/// The plant that runs the parameters of a model file, in any scalar.
template <class Parameters>
struct PlantOfParameters;
template <>
struct PlantOfParameters<SimplexParameters> {
  template <class S>
  using Plant = model::Simplex<S>;
};
template <>
struct PlantOfParameters<DirectParameters> {
  template <class S>
  using Plant = model::Direct<S>;
};
template <>
struct PlantOfParameters<ImposedMotionParameters> {
  template <class S>
  using Plant = model::ImposedMotion<S>;
};
template <>
struct PlantOfParameters<ModalParameters> {
  template <class S>
  using Plant = model::Modal<S>;
};
template <>
struct PlantOfParameters<ElectromechanicalParameters> {
  template <class S>
  using Plant = model::Electromechanical<S>;
};

/// `PlantOf<SimplexParameters, S>` is `model::Simplex<S>`.
template <class Parameters, class S>
using PlantOf = typename PlantOfParameters<std::remove_cvref_t<Parameters>>::template Plant<S>;

}  // namespace hotfire
