// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/latent/form_comb.hpp"

namespace hotfire::explain {

namespace {

using model::Argument;

constexpr std::size_t kArguments = model::kArgumentNames.size();
/// Forms whose curves are laid, and whose parameters are refined.
constexpr std::size_t kLaid = 4;
/// Forms that the screening leaves for the regression.
constexpr std::size_t kScreenedStill = 6;
constexpr std::size_t kScreenedMoving = 10;
/// Memories of one argument among them.
constexpr int kMemoriesOfOne = 2;
/// A memory explains clearly more than its argument where it leaves less than this share of what that leaves.
constexpr double kClearlyLess = 0.9;
constexpr std::size_t kBins = 32;
/// Rows between those that the screening looks at, and values that its bins are laid by.
constexpr Eigen::Index kEvery = 4;
constexpr std::size_t kSampled = 500;
/// Rounds in which a memory's parameter is refined, each with half the step.
constexpr int kFormRefinements = 3;

void keep_best(std::vector<ScoredForm>& all, std::size_t most) {
  std::ranges::stable_sort(all, {}, [](const ScoredForm& s) { return s.score.criterion; });
  if (all.size() > most) {
    all.resize(most);
  }
}

bool is_of_same(const Form& a, const Form& b) { return a.argument == b.argument && a.factor == b.factor; }

bool is_alike(const Form& a, const Form& b) { return is_of_same(a, b) && a.memory.kind == b.memory.kind; }

/// Of forms alike but for their parameter and shape the best, `most` at most.
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

std::vector<ScoredForm> scored(const FormRegression& regression, std::vector<Form> forms, unsigned threads) {
  const std::vector<FormScore> scores = regression.score(forms, threads);
  std::vector<ScoredForm> all;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    all.push_back({std::move(forms[i]), scores[i]});
  }
  return all;
}

/// Share of a signal's variance that a function of x explains: the correlation ratio over bins of equal width between the
/// ends of x (Pearson 1905). It asks for no shape of the function.
double correlation_ratio(const std::vector<double>& x, const std::vector<double>& signal) {
  std::vector<double> sample;
  for (std::size_t i = 0; i < x.size(); i += 1 + x.size() / kSampled) {
    sample.push_back(x[i]);
  }
  std::ranges::sort(sample);
  const double low = quantile(sample, 0.01);
  const double high = quantile(sample, 0.99);
  if (!(high > low)) {
    return 0.0;
  }
  std::array<double, kBins> sum{};
  std::array<double, kBins> count{};
  double whole = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double place = std::clamp((x[i] - low) / (high - low), 0.0, 1.0);
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(place * static_cast<double>(kBins)));
    sum[bin] += signal[i];
    count[bin] += 1.0;
    whole += signal[i] * signal[i];
  }
  double between = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    between += count[bin] > 0.0 ? sum[bin] * sum[bin] / count[bin] : 0.0;
  }
  return whole > 0.0 ? between / whole : 0.0;
}

/// The same of a form's output, or of its output less its argument, whichever explains more, of every few rows.
double correlation_ratio(const FormRegression& regression, const Form& form, const std::vector<double>& signal) {
  std::vector<double> output;
  std::vector<double> distortion;
  for (std::size_t e = 0; e < regression.quantities().size(); ++e) {
    const Eigen::VectorXd argument = argument_of(form, regression.quantities()[e]);
    const Eigen::VectorXd own = remembered(form, argument, regression.problem().data.experiments[e].period);
    for (Eigen::Index row = 0; row < own.size(); row += kEvery) {
      output.push_back(own(row));
      distortion.push_back(own(row) - argument(row));
    }
  }
  const double share = correlation_ratio(output, signal);
  return form.has_direct() ? std::max(share, correlation_ratio(distortion, signal)) : share;
}

/// The smoothed signal less its mean, of every few rows.
std::vector<double> screened_signal(const FormRegression& regression) {
  std::vector<double> values;
  double sum = 0.0;
  for (const Eigen::VectorXd& signal : regression.signal()) {
    for (Eigen::Index row = 0; row < signal.size(); row += kEvery) {
      values.push_back(signal(row));
      sum += signal(row);
    }
  }
  const double mean = sum / static_cast<double>(values.size());
  std::ranges::transform(values, values.begin(), [&](double value) { return value - mean; });
  return values;
}

/// Of the forms those that a function of whose output explains most of the smoothed signal: the best without memory, and the
/// best memories of those that explain clearly more than their argument itself. A short memory is nearly its argument: all
/// of them would crowd out whatever else there is.
std::vector<Form> screened(const FormRegression& regression, const std::vector<Form>& plain,
                           const std::vector<Form>& remembering, unsigned threads) {
  const std::vector<double> signal = screened_signal(regression);
  const auto scored_by_ratio = [&](const std::vector<Form>& forms) {
    std::vector<ScoredForm> all(forms.size());
    parallel_for(forms.size(), threads, [&](std::size_t i) {
      all[i] = {forms[i], {}};
      all[i].score.criterion = 1.0 - correlation_ratio(regression, forms[i], signal);
    });
    return all;
  };
  std::vector<ScoredForm> still = scored_by_ratio(plain);
  std::vector<ScoredForm> moving = scored_by_ratio(remembering);
  std::erase_if(moving, [&](const ScoredForm& scored) {
    const auto own =
        std::ranges::find_if(still, [&](const ScoredForm& other) { return is_of_same(scored.form, other.form); });
    return scored.score.criterion > kClearlyLess * own->score.criterion;
  });
  std::vector<Form> best;
  for (ScoredForm& scored : best_of_each(std::move(still), kScreenedStill)) {
    best.push_back(std::move(scored.form));
  }
  const std::size_t most = best.size() + kScreenedMoving;
  for (ScoredForm& scored : best_of_each(std::move(moving), remembering.size())) {
    const auto of_same = std::ranges::count_if(best, [&](const Form& form) { return is_of_same(scored.form, form); });
    if (best.size() < most && of_same <= kMemoriesOfOne) {
      best.push_back(std::move(scored.form));
    }
  }
  return best;
}

ScoredForm refined_form(const FormRegression& regression, ScoredForm best, unsigned threads) {
  double factor = 1.25;
  for (int i = 0; i < kFormRefinements; ++i) {
    for (ScoredForm& other : scored(regression, neighbours(best.form, factor), threads)) {
      if (other.score.criterion < best.score.criterion) {
        best = std::move(other);
      }
    }
    factor = std::sqrt(factor);
  }
  return best;
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
  }
  for (const Form& form : plain) {
    std::ranges::move(with_memories(regression, form), std::back_inserter(forms));
  }
  const std::vector<Form> likely = screened(regression, plain, forms, threads);

  std::vector<Form> laid;
  for (const Form& form : likely) {
    laid.push_back(form);
    for (const bool curve_first : {false, true}) {
      if (auto curve = with_curve(regression, form, curve_first)) {
        laid.push_back(std::move(*curve));
      }
    }
  }
  std::vector<ScoredForm> best = best_of_each(scored(regression, std::move(laid), threads), kLaid);
  for (ScoredForm& form : best) {
    form = refined_form(regression, std::move(form), threads);
  }
  keep_best(best, most);
  return best;
}

}  // namespace hotfire::explain
