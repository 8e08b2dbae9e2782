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

  /// Ends a search early: where the names so far explain little and one term of unknown law leaves only noise, it takes
  /// their place.
  void replace_names_that_explain_little();

  /// The end of a search: names that the located place refutes are taken out; a term of unknown law takes the place of the
  /// names or comes beside them where it leaves clearly less; names that were given up are tried again with terms beside
  /// them; so is the name without which an unknown signal costs most; names without weight are dropped; what explained the
  /// records as well as a name is compared with it again; what is left is located.
  void finish();

  /// Where the term acts that the explained model is missing; nowhere for a mass, which has one place only.
  const Located& locate_explained();

  /// The calibrated model is another now.
  void forget() {
    located_.reset();
    instead_.reset();
  }

 private:
  /// What a search has found so far.
  struct Found {
    std::vector<Kept> kept;
    Assessed explained;
    std::optional<Rival> rival;
  };

  /// Whether a term may replace a name that was found.
  enum class Names { open, given };

  void restore(Found found);
  bool is_worth_a_table() const;
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
  bool wants_another_start() const;
  void return_to_names_if_better(const Found& names);
  void start_from_name_beside_a_signal(const Found& names);
  std::optional<Screened> name_that_saves_most() const;
  void start_from_if_better(Found names);
  void file_hypothesis();
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
  bool started_from_name_ = false;         ///< that saves an unknown signal most: tried
};

}  // namespace hotfire::explain
