// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tools/explain/refine/screening.hpp"
#include "tools/explain/terms/assessed.hpp"
#include "tools/explain/terms/trial.hpp"

namespace hotfire::explain {

/// How many effects of a round are fitted jointly with everything else.
inline constexpr std::size_t kFinalists = 3;
/// How many terms of unknown law are.
inline constexpr std::size_t kUnlistedFinalists = 4;
/// A variant (law) of a finalist is fitted too if it reached this share of the best variant's gain in screening.
inline constexpr double kCloseVariant = 0.9;

/// Sets how a model does against another, on given effective samples.
void compare(Trial& trial, const Assessed& with, const Assessed& without, const std::vector<ChannelFit>& effective);

/// The screened candidates that are fitted jointly: the best names, each with its close variants. They have evidence or
/// leave clearly less: where the current model leaves a slow residual of few independent rows, nothing has evidence against
/// it.
std::vector<std::size_t> finalists_of(const std::vector<Screened>& screened);

/// Names in the order of their best law, the laws of one name from the simplest on.
std::vector<std::size_t> simplest_laws_first(const std::vector<std::size_t>& order, const std::vector<Screened>& screened);

/// The finalists that may win yet where none reaches the noise: of each name the law that leaves least, if that is less than
/// what is clearly more than the best of all.
std::vector<std::size_t> contenders_of(const std::vector<std::size_t>& order, const std::vector<Screened>& screened,
                                       const std::vector<Assessed>& finalists);

/// How many of the screened terms of unknown law, the best first, are fitted jointly: those that look strong. Screening
/// weighs a channel that is at its noise by all its rows, one that is far off and slow by the few that it has independent;
/// since something is missing, the best are fitted all the same where none looks strong.
std::size_t unlisted_finalists(const std::vector<Screened>& screened);

}  // namespace hotfire::explain
