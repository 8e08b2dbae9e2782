// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tools/explain/data/zeros.hpp"
#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// A fitted model with another constant in the curve of an unlisted term: the one with which the records have the least
/// zeros, in units of their prior (`data/zeros.hpp`). The records alone do not determine it, because every one of them has
/// zeros of its own, which take up whatever a curve adds everywhere. A curve in front of a memory that forgets constants is
/// zero at zero. `zeros` are those of the fitted model. The intervals of the curve are then those of its shape, the constant
/// given. Nothing where the candidate has no curve, or its constant moves nothing at rest.
std::optional<Fitted> with_chosen_constant(const Dataset& data, const Zeros& zeros, const Fitted& fitted,
                                           const Candidate& candidate);

}  // namespace hotfire::explain
