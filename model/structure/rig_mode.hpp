// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "model/declaration/field.hpp"

namespace hotfire::model {

/// Most modes of a `modal` model.
inline constexpr std::size_t kRigModes = 6;

inline constexpr std::array<std::string_view, kRigModes> kRigModeNames{"mode1", "mode2", "mode3", "mode4", "mode5", "mode6"};

/// Mode number `Index` of a `modal` model. Its coordinate is its motion at the first place. A mode with zero mobility is not
/// there. Units are whatever consistent set the record has.
template <class S, std::size_t Index>
struct RigMode {
  using Scalar = S;
  static constexpr std::string_view name = kRigModeNames[Index];
  S frequency{1.0};
  S damping_ratio{0.01};
  S mobility{0.0};
  S drive{1.0};
  S joint{0.0};
  S place2{0.0};
  S place3{0.0};
  static constexpr auto fields() {
    using P = RigMode;
    return std::array{
        Field<P>{"frequency", "Hz", 0.0, 1e5, 1.0, "undamped natural frequency; 0: a rigid body", &P::frequency},
        Field<P>{"damping_ratio", "1", 0.0, 0.99, 0.01, "damping ratio", &P::damping_ratio},
        Field<P>{"mobility", "position/force/time^2", 0.0, 1e15, 1.0, "reciprocal of the modal mass; 0: no such mode",
                 &P::mobility},
        Field<P>{"drive", "1", -1e6, 1e6, 1.0, "shape at the driven place, over that at the first place", &P::drive},
        Field<P>{"joint", "1", -1e6, 1e6, 1.0, "shape across the joint, over that at the first place", &P::joint},
        Field<P>{"place2", "1", -1e6, 1e6, 1.0, "shape at the second place, over that at the first place", &P::place2},
        Field<P>{"place3", "1", -1e6, 1e6, 1.0, "shape at the third place, over that at the first place", &P::place3}};
  }
};

}  // namespace hotfire::model
