#include "tools/explain/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/explain/channel_check.hpp"
#include "tools/explain/finalists.hpp"
#include "tools/explain/refiner.hpp"
#include "tools/explain/stopwatch.hpp"
#include "tools/explain/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// An effect is kept only if it lowers the held-out error by this share of it.
constexpr double kLeastHeldOutDrop = 0.01;
/// What is left beyond the noise is larger than the noise: worth a table of unknown law, and any effect that is supported.
constexpr double kLargerThanNoise = 1.0;
/// A term of unknown law has to stay below this share of the listed effects' held-out error to take their place: it has more
/// freedom than any of them.
constexpr double kUnlistedAdvantage = 0.7;
/// Rows no closer than this tell candidates apart [s]: the fastest that an axis does in its sensors is tens of hertz.
constexpr double kRankingPeriod = 2e-3;
/// A lightly damped mass measured to a thousandth shows what half as many steps shift its resonance by, and what its rows
/// were thinned by.
template <class Family>
constexpr bool kRankedCoarsely = !std::is_same_v<Family, DirectFamily>;

/// The state of one search.
template <class Family>
class Search {
 public:
  Search(const Dataset& data, const ModelFile& model, const SearchOptions& options)
      : data_(data),
        model_(model),
        options_(options),
        thin_(kRankedCoarsely<Family> ? thinned(data, kRankingPeriod) : data),
        fine_(data, Resolution::fine),
        coarse_(thin_, kRankedCoarsely<Family> ? Resolution::coarse : Resolution::fine,
                kRankedCoarsely<Family> ? Resolution::rough : Resolution::fine),
        rough_(thin_, Resolution::rough),
        refiner_(data, kRankedCoarsely<Family> ? rough_ : coarse_, coarse_, fine_, scales_, options.threads, options.watch) {
  }

  SearchResult<Family> run() {
    if constexpr (std::is_same_v<Family, DirectFamily>) {
      scales_ = scales_of(data_);
    }
    Fitted<Family> start;
    start.base = std::get<PlainParameters<Family>>(model_.parameters);
    start.free = declared_parameters<Family>(start.base, model_.tolerance);
    start.u.assign(start.free.size(), 0.0);
    for (const FreeParameter& state : initial_states(data_, scales_, start.u)) {
      start.free.push_back(state);
    }
    start.temper.assign(data_.channels.size(), 1.0);
    result_.declared = assess(fine_, options_.threads, start);
    if constexpr (std::is_same_v<Family, SimplexFamily>) {
      refuse_impossible_channels(data_, result_.declared.prediction);
    }
    options_.watch.progress("calibrating the declared parameters within their tolerances");
    result_.calibrated = calibrated(start);
    result_.explained = result_.calibrated;
    for (int round = 1; round <= options_.most_effects && !options_.watch.interrupted(); ++round) {
      if (lacks_nothing(data_, result_.explained) || !add_effect(round)) {
        break;
      }
      take_out_superfluous(round);
    }
    if (options_.most_effects > 0 && !reaches_noise(data_, result_.explained) && !options_.watch.interrupted() &&
        excess_over_noise(data_, result_.explained.prediction) > kLargerThanNoise) {
      look_for_unlisted();
    }
    result_.interrupted = options_.watch.interrupted();
    return std::move(result_);
  }

 private:
  /// One round. False if no candidate is supported.
  bool add_effect(int round) {
    const Fitted<Family>& current = result_.explained.model;
    std::vector<Candidate> candidates = all_candidates<Family>(data_);
    std::erase_if(candidates, [&](const Candidate& c) {
      return current.base.effects.active[c.effect] || !has_what_it_carries<Family>(current.base, c);
    });
    const Evaluator<Family> evaluator = refiner_.for_screening(current);
    const Screening<Family> screening(evaluator, current, scales_, options_.threads);
    const auto screened = screening.run(candidates, fmt::format("round {}", round), options_.watch);
    return !options_.watch.interrupted() && keep_best(round, screened);
  }

  /// The declared model within its tolerances: fast records are dear, so the way there is made on thinned ones.
  Assessed<Family> calibrated(const Fitted<Family>& declared) const {
    if (fine_.fit_rows() == coarse_.fit_rows()) {
      return refiner_.settled(declared);
    }
    const Assessed<Family> near = refiner_.ranked(declared, kRanking);
    return refiner_.settled(near.good() ? near.model : declared);
  }

  /// False where what is left is of the noise's size already and a further effect takes away little of it: it then imitates
  /// how the laws that were found differ from the truth's.
  bool clears_up(const Assessed<Family>& with) const {
    const double before = excess_over_noise(data_, result_.explained.prediction);
    const double after = excess_over_noise(data_, with.prediction);
    return before > kLargerThanNoise || after * after < kClearsUp * before * before;
  }

  /// True if a finalist that is fitted already leaves no more than noise, and is either a simpler law of the same effect or
  /// another effect that promised more than twice as much.
  bool is_settled(std::size_t wanted, const std::vector<std::size_t>& order, const std::vector<Screened<Family>>& screened,
                  const std::vector<Assessed<Family>>& finalists) const {
    return std::any_of(order.begin(), order.end(), [&](std::size_t i) {
      if (!finalists[i].good() || excess_over_noise(data_, finalists[i].prediction) >= kNothingLeft) {
        return false;
      }
      return screened[i].candidate.name == screened[wanted].candidate.name
                 ? screened[i].fitted.free.size() < screened[wanted].fitted.free.size()
                 : screened[wanted].criterion > 0.5 * screened[i].criterion;
    });
  }

  /// Fits the finalists jointly and keeps the best if it is supported.
  bool keep_best(int round, const std::vector<Screened<Family>>& screened) {
    std::vector<Trial> trials;
    trials.reserve(screened.size());
    for (const Screened<Family>& s : screened) {
      trials.push_back({round, s.candidate, false, s.criterion, 1.0, s.seconds, "dropped", ""});
    }
    const std::vector<std::size_t> order = finalists_of<Family>(screened);
    std::vector<Assessed<Family>> finalists(screened.size());
    for (const std::size_t i : simplest_laws_first<Family>(order, screened)) {
      if (options_.watch.interrupted()) {
        return false;
      }
      if (is_settled(i, order, screened, finalists)) {
        continue;
      }
      options_.watch.progress(fmt::format("round {}: fitting {} with everything else", round, label(screened[i].candidate)));
      const Stopwatch stopwatch;
      finalists[i] = refiner_.ranked(screened[i].fitted, kRanking);
      trials[i].seconds += stopwatch.seconds();
    }
    std::optional<std::size_t> best = rank(trials, finalists, order);
    if (best && clears_up(finalists[*best]) && !reaches_noise(data_, finalists[*best])) {
      for (const std::size_t i : contenders_of(order, screened, finalists)) {
        options_.watch.progress(fmt::format("round {}: fitting {} over ripples", round, label(screened[i].candidate)));
        const Stopwatch stopwatch;
        finalists[i] = refiner_.over_ripples(std::move(finalists[i]));
        trials[i].seconds += stopwatch.seconds();
      }
      best = rank(trials, finalists, order);
    }
    Assessed<Family> winner;
    if (best && clears_up(finalists[*best])) {
      winner = refiner_.from_other_starts(round, std::move(finalists[*best]), trials[*best].candidate);
      options_.watch.progress(fmt::format("round {}: fitting {} with fine steps", round, label(trials[*best].candidate)));
      winner = simplest_law(fine_, scales_, options_.threads, refiner_.settled(winner.model), trials[*best].candidate);
      for (const std::size_t i : order) {
        const Assessed<Family>& finalist = i == *best ? winner : finalists[i];
        if (winner.good() && finalist.good()) {
          compare(trials[i], finalist, winner.goodness.fitted);
        }
      }
    }
    const bool supported = best && winner.good() && trials[*best].delta_criterion < -kStrongEvidence &&
                           trials[*best].held_out_ratio < 1.0 - kLeastHeldOutDrop;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      trials[i].decision = supported && i == *best ? "kept" : "dropped";
      trials[i].reason = reason_of(trials[i], best ? &trials[*best] : nullptr);
    }
    result_.trials.insert(result_.trials.end(), trials.begin(), trials.end());
    if (!supported) {
      return false;
    }
    Kept kept{trials[*best], {}};
    trials.erase(trials.begin() + static_cast<std::ptrdiff_t>(*best));
    std::stable_sort(trials.begin(), trials.end(),
                     [](const Trial& a, const Trial& b) { return a.delta_criterion < b.delta_criterion; });
    kept.alternatives = std::move(trials);
    result_.kept.push_back(std::move(kept));
    result_.explained = std::move(winner);
    result_.rival = rival_of(result_.kept.back(), screened, finalists);
    polish_earlier(round);
    return true;
  }

  /// The closest of the other finalists, fitted as well as the winner was, if the data do not tell the two apart.
  std::optional<Rival<Family>> rival_of(const Kept& kept, const std::vector<Screened<Family>>& screened,
                                        const std::vector<Assessed<Family>>& finalists) const {
    for (const Trial& other : kept.alternatives) {
      if (!other.refined || other.delta_criterion - kept.trial.delta_criterion >= kTied) {
        continue;
      }
      for (std::size_t i = 0; i < screened.size(); ++i) {
        if (label(screened[i].candidate) == label(other.candidate) && finalists[i].good()) {
          const Assessed<Family> again = refiner_.settled(finalists[i].model);
          return again.good() ? std::optional(Rival<Family>{kept.trial.candidate, other.candidate, again.model})
                              : std::nullopt;
        }
      }
    }
    return std::nullopt;
  }

  /// The listed effects leave more than noise: a term of unknown law, at one site, instead of them. It takes their place
  /// where it leaves clearly less on held-out data: listed effects that imitate it would be wrong names.
  void look_for_unlisted() {
    const int round = result_.trials.empty() ? 1 : result_.trials.back().round + 1;
    const Evaluator<Family> evaluator = refiner_.for_screening(result_.calibrated.model);
    const Screening<Family> screening(evaluator, result_.calibrated.model, scales_, options_.threads);
    const auto screened = screening.run(unlisted_candidates<Family>(data_), "unlisted", options_.watch);
    const std::size_t wanted = unlisted_finalists(screened);
    std::vector<Trial> trials;
    std::vector<Assessed<Family>> finalists;
    std::optional<std::size_t> best;
    for (const Screened<Family>& s : screened) {
      trials.push_back(
          {round, s.candidate, false, s.criterion, 1.0, s.seconds, "dropped", "behind the finalists in screening"});
      finalists.emplace_back();
      if (finalists.size() > wanted || options_.watch.interrupted()) {
        continue;
      }
      options_.watch.progress(fmt::format("unlisted: fitting {} with everything else", label(s.candidate)));
      finalists.back() = refiner_.ranked(s.fitted, kRanking);
      if (!finalists.back().good()) {
        continue;
      }
      compare_with_calibrated(trials.back(), finalists.back());
      if (!best || trials.back().held_out_ratio < trials[*best].held_out_ratio) {
        best = trials.size() - 1;
      }
    }
    if (best) {
      Assessed<Family> again = refiner_.settled(finalists[*best].model);
      if (again.good()) {
        compare_with_calibrated(trials[*best], again);
        finalists[*best] = std::move(again);
      }
    }
    const double listed = held_out_ratio(result_.explained, result_.calibrated);
    const bool supported = best && trials[*best].delta_criterion < -kStrongEvidence &&
                           trials[*best].held_out_ratio < kUnlistedAdvantage * listed;
    if (supported) {
      trials[*best].decision = "kept";
      if (!result_.kept.empty()) {
        trials[*best].reason += fmt::format("; the listed effects leave {:.1f} % and are taken out", 100.0 * listed);
      }
      Kept kept{trials[*best], {}};
      for (std::size_t i = 0; i < trials.size(); ++i) {
        if (i != *best && trials[i].refined) {
          kept.alternatives.push_back(trials[i]);
        }
      }
      result_.kept = {std::move(kept)};
      result_.rival.reset();
      result_.explained = std::move(finalists[*best]);
    }
    result_.trials.insert(result_.trials.end(), trials.begin(), trials.end());
  }

  /// Sets how a term of unknown law does against the calibrated model, and says so.
  void compare_with_calibrated(Trial& trial, const Assessed<Family>& with) const {
    trial.refined = true;
    trial.delta_criterion = criterion_change(with, result_.calibrated, with.goodness.fitted);
    trial.held_out_ratio = held_out_ratio(with, result_.calibrated);
    trial.reason = fmt::format("leaves {:.1f} % of the calibrated model's held-out error", 100.0 * trial.held_out_ratio);
  }

  /// What an effect looked like while another was missing may be a local minimum now.
  void polish_earlier(int round) {
    for (std::size_t i = 0; i + 1 < result_.kept.size(); ++i) {
      Assessed<Family> again = refiner_.from_other_starts(round, result_.explained, result_.kept[i].trial.candidate);
      if (Goodness::combined(again.goodness.fitted) < Goodness::combined(result_.explained.goodness.fitted)) {
        again = refiner_.settled(again.model);
        if (again.good()) {
          result_.explained = std::move(again);
        }
      }
    }
  }

  /// Sets how every finalist does, all on the effective samples of the one with the least error: a model that leaves a
  /// coloured residual must not set the price of a parameter. Returns the best.
  std::optional<std::size_t> rank(std::vector<Trial>& trials, const std::vector<Assessed<Family>>& finalists,
                                  const std::vector<std::size_t>& order) const {
    std::optional<std::size_t> closest;
    for (const std::size_t i : order) {
      if (finalists[i].good() && (!closest || Goodness::combined(finalists[i].goodness.fitted) <
                                                  Goodness::combined(finalists[*closest].goodness.fitted))) {
        closest = i;
      }
    }
    std::optional<std::size_t> best;
    for (const std::size_t i : order) {
      if (finalists[i].good()) {
        compare(trials[i], finalists[i], finalists[*closest].goodness.fitted);
        if (!best || trials[i].delta_criterion < trials[*best].delta_criterion) {
          best = i;
        }
      }
    }
    return best;
  }

  /// Sets how a model does against the current one, on given effective samples.
  void compare(Trial& trial, const Assessed<Family>& with, const std::vector<ChannelFit>& effective) const {
    const Assessed<Family>& current = result_.explained;
    trial.refined = true;
    trial.delta_criterion = criterion_change(with, current, effective);
    trial.held_out_ratio = held_out_ratio(with, current);
  }

  /// Takes out every effect without which the model is as good, or reaches the noise, where the search would have ended:
  /// earlier ones that the last has replaced, and the last if all it did was to lead the others, or the calibration, out of
  /// a local minimum.
  void take_out_superfluous(int round) {
    const std::size_t newest = result_.kept.size() - 1;
    for (std::size_t i = newest + 1; i-- > 0;) {
      Trial trial{round,
                  result_.kept[i].trial.candidate,
                  false,
                  0.0,
                  1.0,
                  0.0,
                  "taken out",
                  i == newest ? "the model is as good without it: it led what stays to where it fits"
                              : "the model is as good without it since a later effect was added"};
      options_.watch.progress(fmt::format("round {}: is {} still needed", round, label(trial.candidate)));
      const Stopwatch stopwatch;
      Assessed<Family> rest = refiner_.without(result_.explained.model, trial.candidate);
      if (rest.good()) {
        compare(trial, rest, rest.goodness.fitted);
      }
      trial.seconds = stopwatch.seconds();
      if (rest.good() && (trial.delta_criterion < kStrongEvidence || lacks_nothing(data_, rest))) {
        result_.trials.push_back(trial);
        if (i == newest) {
          result_.rival.reset();
        }
        result_.kept.erase(result_.kept.begin() + static_cast<std::ptrdiff_t>(i));
        result_.explained = refiner_.settled(rest.model);
        if (result_.kept.empty()) {
          result_.calibrated = result_.explained;
        }
      }
    }
  }

  const Dataset& data_;
  const ModelFile& model_;
  const SearchOptions& options_;
  const Dataset thin_;
  Evaluator<Family> fine_;
  Evaluator<Family> coarse_;
  Evaluator<Family> rough_;
  Scales scales_;
  Refiner<Family> refiner_;
  SearchResult<Family> result_;
};

}  // namespace

template <class Family>
SearchResult<Family> search(const Dataset& data, const ModelFile& model, const SearchOptions& options) {
  return Search<Family>(data, model, options).run();
}

template SearchResult<SimplexFamily> search(const Dataset&, const ModelFile&, const SearchOptions&);
template SearchResult<DirectFamily> search(const Dataset&, const ModelFile&, const SearchOptions&);

}  // namespace hotfire::explain
