// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/direct.hpp"
#include "model/simplex.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire::explain {

/// The plants the finder works on, as families over the scalar. The finder is written once and instantiated for each.
struct SimplexFamily {
  template <class S>
  using Plant = model::Simplex<S>;
};
struct DirectFamily {
  template <class S>
  using Plant = model::Direct<S>;
};

template <class Family>
using PlainParameters = typename Family::template Plant<double>::Parameters;

}  // namespace hotfire::explain
