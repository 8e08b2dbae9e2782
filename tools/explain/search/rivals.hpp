// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

/// Gives an effect of a search that was kept another law, files why, and takes the model with it, if that could be
/// simulated.
void give_law(SearchResult& result, Candidate& candidate, OfLaw other, int round, words::LawChange why);

/// The candidates that explained the records as well as an effect that was kept, when nothing later was found. A later
/// effect may separate the two.
class Rivals {
 public:
  /// Works on `result`; all are to outlive it.
  Rivals(const Refiner& refiner, const Watch& watch, SearchResult& result)
      : refiner_(refiner), watch_(watch), result_(result) {}

  /// A later effect is kept: the rival of the last one is to be compared again.
  void set_aside();
  /// Compares those that were set aside with the effects that are kept now. A better one takes the place of its effect, and
  /// one that is still as good is the search's rival.
  void compare_again();

  /// Those that were set aside, of what is kept now.
  const std::vector<Rival>& aside() const { return aside_; }
  /// Goes back to those of other effects that are kept again.
  void restore(std::vector<Rival> aside) { aside_ = std::move(aside); }

 private:
  void compare_again(const Rival& rival);

  const Refiner& refiner_;
  const Watch& watch_;
  SearchResult& result_;
  std::vector<Rival> aside_;
};

}  // namespace hotfire::explain
