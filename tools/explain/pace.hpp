// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "tools/explain/refine/watch.hpp"

namespace hotfire::explain {

/// Shares of the whole work that are done, each 0 to 1. The search itself finds out how many effects are missing, so there
/// are two.
struct ShareDone {
  double expected = 0.0;  ///< if this round is the last one
  double least = 0.0;     ///< if each round that is allowed finds an effect, and then terms of unknown law are searched for
};

/// How much of a search is done, by what it says that it does. Both shares fall when a round begins that was not expected.
class Pace {
 public:
  /// `most_effects`: rounds that are allowed; 0: the declared parameters are calibrated only.
  explicit Pace(int most_effects) : most_rounds_(most_effects) {}

  /// The shares that are done, when this is being done.
  ShareDone done(const Doing& doing) {
    // What is left is also located for the report, behind the rounds.
    const bool is_for_report = doing.work == Work::locating && work_ >= index(Work::settling);
    const std::size_t work = is_for_report ? work_ : index(doing.work);
    const double share = is_for_report ? share_ : doing.share;
    if (work != work_) {
      before_ += kCosts[work_];
      begin(work);
    } else if (share < share_) {
      // The same once more, in another round.
      before_ += share_ * kCosts[work];
      begin(work);
    }
    share_ = std::clamp(share, share_, 1.0);
    const double now = before_ + share_ * kCosts[work];
    const auto to_come = static_cast<double>(doing.searches_to_come);
    const double expected = (1.0 - share_) * kCosts[work] + expected_from(work + 1) + to_come * expected_from(0);
    const double more = most_rounds_ == 0
                            ? 0.0
                            : more_rounds() * cost_of_round() + (is_past_unlisted_ ? 0.0 : cost(Work::unlisted)) +
                                  to_come * ((most_rounds_ - 1) * cost_of_round() + cost(Work::unlisted));
    return {now / (now + expected), now / (now + expected + more)};
  }

 private:
  /// Seconds of each work on two processors: searches of the cases `friction` and `soft` of tests/data/challenge, and for
  /// terms of unknown law one of the study. Only their ratios count.
  static constexpr std::array<double, 8> kCosts{6.0, 9.0, 7.0, 15.0, 2.0, 5.0, 30.0, 9.0};

  static constexpr std::size_t index(Work work) { return static_cast<std::size_t>(work); }
  static constexpr double cost(Work work) { return kCosts[index(work)]; }

  /// Another round: what is left is located, its candidates are screened and fitted, and each effect is tried without.
  static constexpr double cost_of_round() {
    return cost(Work::locating) + cost(Work::screening) + cost(Work::fitting) + cost(Work::deciding);
  }

  /// What a search is expected to do from a work on: terms of unknown law are the exception.
  double expected_from(std::size_t work) const {
    double sum = 0.0;
    for (std::size_t i = work; i < kCosts.size(); ++i) {
      const bool is_calibration = i == index(Work::calibrating) || i == index(Work::concluding);
      sum += is_calibration || (most_rounds_ > 0 && i != index(Work::unlisted)) ? kCosts[i] : 0.0;
    }
    return sum;
  }

  void begin(std::size_t work) {
    if (work == index(Work::calibrating)) {
      // The search of another axis.
      rounds_ = 0;
      is_past_unlisted_ = false;
    }
    const bool is_first_of_round = work == index(Work::locating) || work == index(Work::screening);
    rounds_ += is_first_of_round && (work <= work_ || rounds_ == 0) ? 1 : 0;
    is_past_unlisted_ = is_past_unlisted_ || work >= index(Work::unlisted);
    work_ = work;
    share_ = 0.0;
  }

  /// That may follow in the search under way. The first round is expected.
  int more_rounds() const { return work_ > index(Work::deciding) ? 0 : std::max(most_rounds_ - std::max(rounds_, 1), 0); }

  int most_rounds_;
  int rounds_ = 0;  ///< that have begun, of the search under way
  bool is_past_unlisted_ = false;
  std::size_t work_ = 0;
  double share_ = 0.0;   ///< of this work that is done
  double before_ = 0.0;  ///< cost of all that was done before this work
};

}  // namespace hotfire::explain
