// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/search/screening.hpp"
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
template <class Family>
void compare(Trial& trial, const Assessed<Family>& with, const Assessed<Family>& without,
             const std::vector<ChannelFit>& effective) {
  trial.refined = true;
  trial.delta_criterion = criterion_change(with, without, effective);
  trial.held_out_ratio = held_out_ratio(with, without);
}

/// The screened candidates that are fitted jointly: the best names, each with its close variants.
template <class Family>
std::vector<std::size_t> finalists_of(const std::vector<Screened<Family>>& screened) {
  std::vector<std::pair<std::string, double>> best_of_name;
  std::vector<std::size_t> finalists;
  for (std::size_t i = 0; i < screened.size() && screened[i].criterion < -policy().strong_evidence; ++i) {
    const std::string& name = screened[i].candidate.name;
    const auto known =
        std::find_if(best_of_name.begin(), best_of_name.end(), [&](const auto& n) { return n.first == name; });
    if (known == best_of_name.end() && best_of_name.size() < kFinalists) {
      best_of_name.emplace_back(name, screened[i].criterion);
      finalists.push_back(i);
    } else if (known != best_of_name.end() && screened[i].criterion < kCloseVariant * known->second) {
      finalists.push_back(i);
    }
  }
  return finalists;
}

/// Names in the order of their best law, the laws of one name from the simplest on.
template <class Family>
std::vector<std::size_t> simplest_laws_first(const std::vector<std::size_t>& order,
                                             const std::vector<Screened<Family>>& screened) {
  const auto rank_of = [&](std::size_t i) {
    return std::find_if(order.begin(), order.end(),
                        [&](std::size_t k) { return screened[k].candidate.name == screened[i].candidate.name; });
  };
  std::vector<std::size_t> sorted = order;
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(rank_of(a), screened[a].fitted.free.size()) < std::pair(rank_of(b), screened[b].fitted.free.size());
  });
  return sorted;
}

/// The finalists that may win yet where none reaches the noise: of each name the law that leaves least, if that is less than
/// what is clearly more than the best of all.
template <class Family>
std::vector<std::size_t> contenders_of(const std::vector<std::size_t>& order, const std::vector<Screened<Family>>& screened,
                                       const std::vector<Assessed<Family>>& finalists) {
  const auto left = [&](std::size_t i) { return Goodness::combined(finalists[i].goodness.fitted); };
  std::vector<std::size_t> closest;
  std::copy_if(order.begin(), order.end(), std::back_inserter(closest), [&](std::size_t i) { return finalists[i].good(); });
  std::stable_sort(closest.begin(), closest.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
  std::vector<std::size_t> contenders;
  for (const std::size_t i : closest) {
    const bool has_better_law = std::any_of(contenders.begin(), contenders.end(), [&](std::size_t k) {
      return screened[k].candidate.name == screened[i].candidate.name;
    });
    if (!has_better_law && policy().clearly_less * left(i) < left(closest.front())) {
      contenders.push_back(i);
    }
  }
  return contenders;
}

/// How many of the screened terms of unknown law, the best first, are fitted jointly: those that look strong. Screening
/// weighs a channel that is at its noise by all its rows, one that is far off and slow by the few that it has independent;
/// since something is missing, the best are fitted all the same where none looks strong.
template <class Family>
std::size_t unlisted_finalists(const std::vector<Screened<Family>>& screened) {
  const auto strong =
      static_cast<std::size_t>(std::count_if(screened.begin(), screened.end(), [](const Screened<Family>& candidate) {
        return candidate.criterion <= -policy().strong_evidence;
      }));
  return std::min(kUnlistedFinalists, strong == 0 ? screened.size() : strong);
}

}  // namespace hotfire::explain
