// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/finalists.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

void compare(Trial& trial, const Assessed& with, const Assessed& without, const std::vector<ChannelFit>& effective) {
  trial.refined = true;
  trial.delta_criterion = criterion_change(with, without, effective);
  trial.held_out_ratio = held_out_ratio(with, without);
}

std::vector<std::size_t> finalists_of(const std::vector<Screened>& screened) {
  std::vector<std::pair<std::string, double>> best_of_name;
  std::vector<std::size_t> finalists;
  for (std::size_t i = 0; i < screened.size(); ++i) {
    if (screened[i].criterion >= -policy().strong_evidence && screened[i].left >= policy().clearly_less) {
      continue;
    }
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

std::vector<std::size_t> simplest_laws_first(const std::vector<std::size_t>& order, const std::vector<Screened>& screened) {
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

std::vector<std::size_t> contenders_of(const std::vector<std::size_t>& order, const std::vector<Screened>& screened,
                                       const std::vector<Assessed>& finalists) {
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

std::size_t unlisted_finalists(const std::vector<Screened>& screened) {
  const auto strong =
      static_cast<std::size_t>(std::count_if(screened.begin(), screened.end(), [](const Screened& candidate) {
        return candidate.criterion <= -policy().strong_evidence;
      }));
  return std::min(kUnlistedFinalists, strong == 0 ? screened.size() : strong);
}

}  // namespace hotfire::explain
