// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/latent/correlation.hpp"
#include "tools/explain/latent/form_comb.hpp"
#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

using model::Argument;

constexpr std::size_t kArguments = model::kArgumentNames.size();
/// Gains, and as many curves and powers, whose parameters are refined.
constexpr std::size_t kRefined = 3;
/// Forms that the screening leaves for the regression.
constexpr std::size_t kScreenedStill = 6;
constexpr std::size_t kScreenedMoving = 24;
/// Memories of one argument among them.
constexpr int kMemoriesOfOne = 4;
/// Forms whose response explains most, and memories of one argument among them.
constexpr std::size_t kScreenedByResponse = 12;
constexpr int kResponsesOfOne = 2;
/// Filters behind a curve that go on.
constexpr std::size_t kBehindCurve = 6;
/// A memory explains clearly more than its argument where it leaves less than this share of what that leaves.
constexpr double kClearlyLess = 0.9;
/// Forms with a memory over which curves are laid.
constexpr std::size_t kCurved = 6;
/// Curves without a memory whose output is given one that is not linear.
constexpr std::size_t kFollowed = 3;
/// Steps in which a memory's parameter is refined.
constexpr int kFormRefinements = 6;
/// Memories that are tuned in the screening, and steps of that.
constexpr std::size_t kTuned = 24;
constexpr int kTunings = 8;

void keep_best(std::vector<ScoredForm>& all, std::size_t most) {
  std::ranges::stable_sort(all, {}, [](const ScoredForm& s) { return s.score.criterion; });
  if (all.size() > most) {
    all.resize(most);
  }
}

bool is_of_same(const Form& a, const Form& b) { return a.argument == b.argument && a.factor == b.factor; }

bool is_alike(const Form& a, const Form& b) {
  return is_of_same(a, b) && a.memory.kind == b.memory.kind && a.has_curve() == b.has_curve();
}

/// Of forms alike but for their parameters the best, `most` at most.
std::vector<ScoredForm> best_of_each(std::vector<ScoredForm> all, std::size_t most) {
  keep_best(all, all.size());
  std::vector<ScoredForm> best;
  for (ScoredForm& scored : all) {
    const bool known = std::ranges::any_of(best, [&](const ScoredForm& other) { return is_alike(scored.form, other.form); });
    if (best.size() == most) {
      break;
    }
    if (!known && std::isfinite(scored.score.criterion)) {
      best.push_back(std::move(scored));
    }
  }
  return best;
}

std::vector<Form> forms_of(const std::vector<ScoredForm>& all) {
  std::vector<Form> forms;
  std::ranges::transform(all, std::back_inserter(forms), &ScoredForm::form);
  return forms;
}

std::vector<ScoredForm> scored(const FormRegression& regression, std::vector<Form> forms, unsigned threads,
                               Precision precision = Precision::full) {
  const std::vector<FormScore> scores = regression.score(forms, threads, precision);
  std::vector<ScoredForm> all;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    all.push_back({std::move(forms[i]), scores[i]});
  }
  return all;
}

/// Moves the parameters of forms' memories to where their responses explain most. The regression is nearly as fast with
/// the neighbours of all of them as with those of one.
void refine(const FormRegression& regression, std::vector<ScoredForm>& forms, unsigned threads,
            Precision precision = Precision::full) {
  std::vector<double> factors(forms.size(), 1.25);
  for (int i = 0; i < kFormRefinements; ++i) {
    std::vector<Form> beside;
    std::vector<std::size_t> of;
    for (std::size_t f = 0; f < forms.size(); ++f) {
      std::ranges::move(neighbours(forms[f].form, factors[f]), std::back_inserter(beside));
      of.resize(beside.size(), f);
    }
    std::vector<bool> moved(forms.size());
    std::vector<ScoredForm> all = scored(regression, std::move(beside), threads, precision);
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (all[n].score.criterion < forms[of[n]].score.criterion) {
        forms[of[n]] = std::move(all[n]);
        moved[of[n]] = true;
      }
    }
    for (std::size_t f = 0; f < forms.size(); ++f) {
      factors[f] = moved[f] ? factors[f] : std::sqrt(factors[f]);
    }
  }
}

/// Moves the laws of an added flow to the opening of the valve where they explain clearly more: the orifices between the two
/// let less through under load. Both are one place, because a signal without a law follows either.
void take_site(const FormRegression& regression, std::vector<ScoredForm>& forms, unsigned threads) {
  std::vector<Form> at_opening;
  std::vector<std::size_t> of;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (forms[f].form.site == model::Site::flow) {
      at_opening.push_back(forms[f].form);
      at_opening.back().site = model::Site::valve;
      of.push_back(f);
    }
  }
  std::vector<ScoredForm> opened = scored(regression, std::move(at_opening), threads);
  for (std::size_t i = 0; i < opened.size(); ++i) {
    // The criterion is minus twice the log likelihood.
    if (opened[i].score.criterion < forms[of[i]].score.criterion - 2.0 * policy().tied_gain) {
      forms[of[i]] = std::move(opened[i]);
    }
  }
}

/// Moves the parameter of a form's memory to where a function of its output explains most of the signal: a curve that bends
/// several times over the output shows only close to the right parameter, and a comb is never that dense.
void tune(const SignalCorrelation& correlation, ScoredForm& scored) {
  double factor = 1.2;
  for (int i = 0; i < kTunings; ++i) {
    std::vector<Form> beside = neighbours(scored.form, factor);
    if (beside.empty()) {
      return;
    }
    const std::vector<double> shares = correlation.explained_shares(beside);
    const auto best = std::ranges::max_element(shares);
    if (1.0 - *best < scored.score.criterion) {
      scored.form = std::move(beside[static_cast<std::size_t>(best - shares.begin())]);
      scored.score.criterion = 1.0 - *best;
    } else {
      factor = std::sqrt(factor);
    }
  }
}

/// How much of the smoothed signal a function of each form's output leaves. Forms of one argument are adjacent.
std::vector<ScoredForm> scored_by_signal(const SignalCorrelation& correlation, const std::vector<Form>& forms,
                                         unsigned threads) {
  std::vector<std::span<const Form>> of_one_argument;
  for (auto first = forms.begin(); first != forms.end();) {
    const auto last = std::find_if_not(first, forms.end(), [&](const Form& form) { return is_of_same(form, *first); });
    of_one_argument.emplace_back(first, last);
    first = last;
  }
  std::vector<ScoredForm> all(forms.size());
  parallel_for(of_one_argument.size(), threads, [&](std::size_t g) {
    const std::span<const Form> group = of_one_argument[g];
    const std::vector<double> shares = correlation.explained_shares(group);
    for (std::size_t i = 0; i < group.size(); ++i) {
      ScoredForm& scored = all[static_cast<std::size_t>(group.data() - forms.data()) + i];
      scored.form = group[i];
      scored.score.criterion = 1.0 - shares[i];
    }
  });
  return all;
}

/// Of the forms those that a function of whose output explains most of the smoothed signal: the best without memory, and the
/// best memories of those that explain clearly more than their argument itself. A short memory is nearly its argument: all
/// of them would crowd out whatever else there is.
std::vector<Form> screened_by_signal(const SignalCorrelation& correlation, std::vector<ScoredForm> still,
                                     std::vector<ScoredForm> moving, unsigned threads) {
  std::erase_if(moving, [&](const ScoredForm& scored) {
    const auto own =
        std::ranges::find_if(still, [&](const ScoredForm& other) { return is_of_same(scored.form, other.form); });
    return scored.score.criterion > kClearlyLess * own->score.criterion;
  });
  std::vector<Form> best = forms_of(best_of_each(std::move(still), kScreenedStill));
  moving = best_of_each(std::move(moving), kTuned);
  parallel_for(moving.size(), threads, [&](std::size_t i) { tune(correlation, moving[i]); });
  for (ScoredForm& scored : best_of_each(std::move(moving), kTuned)) {
    const auto of_same = std::ranges::count_if(best, [&](const Form& form) { return is_of_same(scored.form, form); });
    if (best.size() < kScreenedStill + kScreenedMoving && of_same <= kMemoriesOfOne) {
      best.push_back(std::move(scored.form));
    }
  }
  return best;
}

/// The best forms, at most `most`, and `kResponsesOfOne` of one argument, with their parameters where they explain most.
std::vector<Form> best_responses(const FormRegression& regression, std::vector<Form> forms, std::size_t most,
                                 unsigned threads) {
  const std::size_t count = forms.size();
  std::vector<ScoredForm> best;
  for (ScoredForm& form : best_of_each(scored(regression, std::move(forms), threads, Precision::single), count)) {
    const auto of_same =
        std::ranges::count_if(best, [&](const ScoredForm& other) { return is_of_same(form.form, other.form); });
    if (best.size() == most) {
      break;
    }
    if (of_same < kResponsesOfOne) {
      best.push_back(std::move(form));
    }
  }
  refine(regression, best, threads, Precision::single);
  return forms_of(best);
}

/// Of the memories those whose response explains most of what is left. The smoothed signal is mostly noise where the plant
/// hides what acts on it, and ranks a gain over the right memory of the right argument behind hundreds of others; the
/// readings do not. A comb's parameter is that of the smoothed signal, except of a hold: it is the readings that show when a
/// signal is sampled.
std::vector<Form> screened_by_response(const FormRegression& regression, const std::vector<ScoredForm>& moving,
                                       unsigned threads) {
  const auto is_sampled = [](const ScoredForm& scored) {
    return scored.form.memory.kind == model::Memory::hold && !scored.form.factor;
  };
  std::vector<Form> forms;
  for (ScoredForm& scored : best_of_each(moving, moving.size())) {
    if (!is_sampled(scored)) {
      forms.push_back(std::move(scored.form));
    }
  }
  for (const ScoredForm& scored : moving) {
    if (is_sampled(scored)) {
      forms.push_back(scored.form);
    }
  }
  return best_responses(regression, std::move(forms), kScreenedByResponse, threads);
}

/// Curves in front of the filters of one quantity that explain most there. A gain and a curve behind a filter say little of
/// them.
std::vector<ScoredForm> with_curves_first(const FormRegression& regression, const std::vector<Form>& remembering,
                                          unsigned threads) {
  std::vector<Form> rough = with_rough_curves(regression, remembering);
  std::vector<Form> fine;
  for (const Form& form : best_responses(regression, std::move(rough), kBehindCurve, threads)) {
    if (auto curved = with_curve(regression, form, true)) {
      fine.push_back(std::move(*curved));
    }
  }
  return scored(regression, std::move(fine), threads);
}

/// The forms without a memory over which a rough curve explains most of the readings, with that curve. A gain says nothing
/// of a curve that is even, and the smoothed signal contains what the problem's parameters move too.
std::vector<Form> screened_under_curves(const FormRegression& regression, const std::vector<Form>& plain, unsigned threads) {
  std::vector<ScoredForm> curved = scored(regression, with_rough_curves(regression, plain), threads, Precision::single);
  return forms_of(best_of_each(std::move(curved), kScreenedStill));
}

/// The forms that go on: by the signal, then by the response those that are not among them.
std::vector<Form> screened(const FormRegression& regression, const std::vector<Form>& plain,
                           const std::vector<Form>& remembering, unsigned threads) {
  const SignalCorrelation correlation(regression);
  const std::vector<ScoredForm> moving = scored_by_signal(correlation, remembering, threads);
  std::vector<Form> best = screened_by_signal(correlation, scored_by_signal(correlation, plain, threads), moving, threads);
  std::vector<Form> by_response = screened_by_response(regression, moving, threads);
  std::ranges::move(screened_under_curves(regression, plain, threads), std::back_inserter(by_response));
  for (Form& form : by_response) {
    const auto same = std::ranges::find_if(
        best, [&](const Form& other) { return is_of_same(form, other) && form.memory.kind == other.memory.kind; });
    if (same == best.end()) {
      best.push_back(std::move(form));
    } else if (form.memory.kind == model::Memory::hold) {
      *same = std::move(form);
    }
  }
  return best;
}

/// Memories that are not linear, behind the curves that explain most without one.
std::vector<ScoredForm> behind_best_curves(const FormRegression& regression, std::vector<ScoredForm> laid,
                                           unsigned threads) {
  std::erase_if(laid, [](const ScoredForm& scored) {
    return !scored.form.has_curve() || scored.form.memory.kind != model::Memory::none;
  });
  std::vector<Form> forms;
  for (const ScoredForm& scored : best_of_each(std::move(laid), kFollowed)) {
    std::ranges::move(behind_curve(regression, scored.form, scored.score.coefficients), std::back_inserter(forms));
  }
  return scored(regression, std::move(forms), threads);
}

}  // namespace

std::vector<ScoredForm> search_forms(const FormRegression& regression, const LatentPlace& place, std::size_t most,
                                     unsigned threads) {
  std::vector<Form> forms;
  std::vector<Form> plain;
  for (std::size_t a = 0; a < kArguments; ++a) {
    plain.push_back(at_place(place, static_cast<Argument>(a)));
    for (std::size_t b = 0; b <= a && a + 1 < kArguments; ++b) {
      plain.push_back(at_place(place, static_cast<Argument>(a), static_cast<Argument>(b)));
    }
    if (static_cast<Argument>(a) != Argument::time) {  // a law whose size drifts
      plain.push_back(at_place(place, static_cast<Argument>(a), Argument::time));
    }
  }
  for (const Form& form : plain) {
    std::ranges::move(with_memories(regression, form), std::back_inserter(forms));
  }
  const std::vector<Form> likely = screened(regression, plain, forms, threads);

  // A curve costs a regressor a point: it is laid over what explains most by a gain, by a rough curve or by the signal.
  std::vector<ScoredForm> laid = scored(regression, likely, threads);
  std::vector<ScoredForm> by_gain = laid;
  std::erase_if(by_gain, [](const ScoredForm& scored) { return scored.form.has_curve(); });
  keep_best(by_gain, kCurved);
  std::vector<Form> shaped;
  std::size_t moving = 0;
  for (const Form& form : likely) {
    const bool is_still = form.memory.kind == model::Memory::none;
    const bool is_best = std::ranges::any_of(by_gain, [&](const ScoredForm& other) { return is_alike(other.form, form); });
    if (is_still || moving++ < kCurved || is_best) {
      for (const bool curve_first : {false, true}) {
        if (auto curve = with_curve(regression, form, curve_first)) {
          shaped.push_back(std::move(*curve));
        }
      }
    }
    if (is_still) {
      const Form own = at_place(place, form.argument, form.factor);
      std::ranges::move(with_kinks(regression, own), std::back_inserter(shaped));
      std::ranges::move(with_powers(regression, own), std::back_inserter(shaped));
    }
  }
  std::ranges::move(scored(regression, std::move(shaped), threads), std::back_inserter(laid));
  std::ranges::move(behind_best_curves(regression, laid, threads), std::back_inserter(laid));
  if (std::ranges::none_of(laid, [&](const ScoredForm& f) { return regression.is_explained_by(f.score.left); })) {
    std::ranges::move(with_curves_first(regression, forms, threads), std::back_inserter(laid));
  }
  // Gains, curves and powers are ranked apart. In the linear regression, a curve or a power follows a large effect that is
  // neither. Within the records, a curve follows a power.
  const auto of = [&](auto&& is_in, std::size_t count) {
    std::vector<ScoredForm> some;
    std::ranges::copy_if(laid, std::back_inserter(some), [&](const ScoredForm& scored) { return is_in(scored.form); });
    return best_of_each(std::move(some), count);
  };
  std::vector<ScoredForm> best = of([](const Form& form) { return !form.has_curve() && !form.is_power(); }, kRefined);
  std::ranges::move(of([](const Form& form) { return form.has_curve(); }, kRefined), std::back_inserter(best));
  std::ranges::move(of([](const Form& form) { return form.is_power(); }, kRefined), std::back_inserter(best));
  take_site(regression, best, threads);
  refine(regression, best, threads);
  keep_best(best, most);
  return best;
}

std::vector<ScoredForm> replacing(const std::vector<ScoredForm>& found) {
  std::vector<ScoredForm> all;
  for (const ScoredForm& scored : best_of_each(found, found.size())) {
    auto form = in_place_of_signal(scored.form);
    const auto is_of_same_memory = [&](const ScoredForm& other) {
      return other.form.site == form->site && other.form.memory.kind == form->memory.kind;
    };
    if (form && std::ranges::none_of(all, is_of_same_memory)) {
      FormScore score = scored.score;
      score.coefficients = Eigen::VectorXd::Constant(2, 1.0);
      score.coefficients(1) = -1.0;
      score.move.setZero();
      all.push_back({std::move(*form), std::move(score)});
    }
  }
  return all;
}

std::vector<ScoredForm> moved_forms(const FormRegression& regression, const LatentPlace& place,
                                    const std::vector<ScoredForm>& elsewhere, const std::vector<ScoredForm>& here,
                                    unsigned threads) {
  std::vector<Form> forms;
  for (const ScoredForm& other : elsewhere) {
    if (std::ranges::none_of(here, [&](const ScoredForm& own) { return is_alike(own.form, other.form); })) {
      Form form = other.form;
      const Form at_site = at_place(place, form.argument, form.factor);
      form.site = at_site.site;
      form.channel = at_site.channel;
      forms.push_back(std::move(form));
    }
  }
  std::vector<ScoredForm> moved = scored(regression, std::move(forms), threads);
  std::erase_if(moved, [](const ScoredForm& form) { return !std::isfinite(form.score.criterion); });
  take_site(regression, moved, threads);
  refine(regression, moved, threads);
  return moved;
}

}  // namespace hotfire::explain
