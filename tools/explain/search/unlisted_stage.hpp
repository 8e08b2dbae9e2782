// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/explain/search/rivals.hpp"
#include "tools/explain/search/round.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/explain/search/unlisted_search.hpp"

namespace hotfire::explain {

/// The part of a search that knows no names: where the missing term acts, terms of unknown law there, instead of listed
/// effects or beside them, and which names the records do not bear.
class UnlistedStage {
 public:
  /// Works on `result`; all are to outlive it.
  UnlistedStage(const Dataset& data, const Refiner& refiner, const Evaluator& coarse, const Scales& scales,
                const SearchOptions& options, Rivals& rivals, SearchResult& result)
      : data_(data),
        refiner_(refiner),
        coarse_(coarse),
        scales_(scales),
        options_(options),
        rivals_(rivals),
        result_(result) {}

  /// What a search has found so far.
  struct Found {
    std::vector<Kept> kept;
    Assessed explained;
    std::optional<Rival> rival;
    std::vector<Rival> aside;
  };
  Found found() const { return {result_.kept, result_.explained, result_.rival, rivals_.aside()}; }
  void restore(Found found);

  /// True if a model leaves clearly less beyond the noise than another, and held-out rows agree.
  bool is_clearly_better(const Assessed& model, const Assessed& than) const;
  /// True where what was found leaves more than the noise, of a plant that terms of unknown law are known for.
  bool wants_another_start() const;

  /// True if one signal beside the calibrated model explains the records.
  bool has_single_signal() { return located().is_single; }
  /// Ends a search early: where the names so far explain little and one term of unknown law leaves only noise, it takes
  /// their place.
  void replace_names_that_explain_little();
  /// Ends a search after its first rounds: where one signal explains the records and one term of unknown law leaves only
  /// noise, it takes the place of the names. Returns whether it does.
  bool replace_name_beside_single_signal();

  /// Share of its cost beside the calibrated model that an unknown signal may cost beside a name that the search starts
  /// again from. Where one signal explains the records, a term of unknown law may be all that is missing.
  double share_of_signal();
  /// Starts again with one name beside the calibrated model. Nothing changes if it cannot be fitted.
  void start_from(const Screened& name);
  /// Terms of unknown law beside the names that were found, or listed laws in their place; names that the terms make
  /// needless are dropped. Returns whether only noise is left.
  bool add_terms_to_names();
  /// Goes back to what was found before. What the terms left is compared at the end of the search with what it has found
  /// then.
  void give_up_terms(Found before);
  /// Brings the decisions of all trials in line with the effects that are kept: those of the other hypothesis are dropped,
  /// and an effect that was taken out and came back is filed once more.
  void file_hypothesis();

  /// The end of a search: names that the located place refutes are taken out; a term of unknown law takes the place of the
  /// names or comes beside them where it leaves clearly less; names that were given up are tried again with terms beside
  /// them; terms that were given up are compared; names without weight are dropped; what explained the records as well as a
  /// name is compared with it again; what is left is located.
  void finish();

  /// Where the term acts that the explained model is missing; nowhere for a mass, which has one place only.
  const Located& locate_explained();

  /// The calibrated model is another now.
  void forget() {
    located_.reset();
    instead_.reset();
    exhausted_.reset();
    unnamed_.reset();
  }

 private:
  /// Whether a term may replace a name that was found.
  enum class Names { open, given };

  /// Effects beside which nothing more was found, and what they leave beyond the noise.
  struct Exhausted {
    std::vector<std::string> effects;
    double left = 0.0;
  };

  bool is_worth_a_table() const;
  bool signal_leaves_less();
  Exhausted as_exhausted() const;
  bool is_as_before(const std::optional<Exhausted>& before) const;
  double left_by_listed() const { return held_out_ratio(result_.explained, result_.calibrated); }
  bool leaves_as_little(const Assessed& model) const;
  double advantage() const;
  bool leaves_clearly_less(const Assessed& model, double share) const;
  bool is_unlisted(const Kept& kept) const;
  bool has_unlisted() const;
  Located locate_about(const Assessed& model) const;
  UnlistedTask task_beside(const Assessed& model, const Located& located) const;
  const Located& located();
  void take_out_names(const std::string& why);
  void refuse_misplaced_names();
  void look_instead();
  void look_elsewhere();
  bool is_better(const UnlistedSearch& found) const;
  void take_instead_if_better();
  bool take_instead_if_complete();
  std::optional<std::size_t> term_of_rest(const Located& left) const;
  void add_beside(Names names);
  RoundResult round_of(const std::vector<Candidate>& candidates, const Assessed& beside, const std::string& what);
  void take_out(Trial trial, std::string why);
  std::vector<std::string> sites_of_terms() const;
  bool add_listed_beside(const Located& left, std::optional<std::size_t> term);
  std::optional<UnlistedSearch> better_term(const Assessed& beside, const Located& where, bool tables);
  bool revise_term(std::size_t term, const RoundResult& listed, const Located& left);
  bool replace_misfit(const Located& left);
  void name_terms();
  void return_to_names_if_better(const Found& names);
  void take_if_better(Found other);
  void drop_light_names();
  void drop_names_that_explain_little();
  void keep(const UnlistedSearch& found, std::size_t first_trial);

  const Dataset& data_;
  const Refiner& refiner_;
  const Evaluator& coarse_;
  const Scales& scales_;
  const SearchOptions& options_;
  Rivals& rivals_;
  SearchResult& result_;
  std::optional<Located> located_;         ///< about the calibrated model, once it was asked for
  Located beside_explained_;               ///< about the explained model
  std::vector<double> beside_values_;      ///< of that model's free parameters; none: not asked for yet
  std::optional<UnlistedSearch> instead_;  ///< beside the calibrated model, once it was searched for
  std::size_t instead_trials_ = 0;         ///< where its trials are among all
  std::optional<Exhausted> exhausted_;     ///< the last ones
  std::optional<Exhausted> unnamed_;       ///< the last ones whose terms no listed effect was found for
  std::optional<Found> of_names_;          ///< terms beside names that leave more than noise, for the end of the search
};

}  // namespace hotfire::explain
