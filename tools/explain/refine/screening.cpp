// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/screening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <span>

#include "tools/explain/data/spectrum.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/explain/terms/periodic.hpp"
#include "tools/explain/terms/trial.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// How many frequencies of a channel's spectrum are tried.
constexpr std::size_t kFrequencies = 3;

/// Names that go on to the full fit, starts of an effect with several parameters, and the lengths of the fits.
constexpr std::size_t kSemifinalists = 6;
/// Behind the first names, one goes on only with this share of the leader's gain, and a law only with this share of its
/// name's best: what is missing beside the leader is searched for again when that is in the model.
constexpr std::size_t kFirstNames = 3;
constexpr double kHopeful = 0.1;
/// A law with more parameters of its own is not scanned: it starts from where the laws that it contains end.
constexpr std::size_t kMostScanned = 6;
constexpr std::size_t kStarts = 3;
/// How often the step of a scan of one parameter is halved about the best value.
constexpr int kNarrowings = 3;
constexpr int kShortFit = 6;
constexpr int kFullFit = 12;
constexpr int kFullFits = 2;
/// How far a parameter is set off when a fit is started again, and how many of the starts are fitted.
constexpr double kRestartFactor = 5.0;
constexpr std::size_t kRestarts = 4;
/// Relative change of the cost at which a candidate is ranked well enough.
constexpr double kRankingTolerance = 1e-4;

FitOptions fit_options(int iterations, const Frozen& frozen) {
  return {iterations, 1, kRankingTolerance, Slopes::narrow, &frozen};
}

void sort_best_first(std::vector<Screened>& screened) {
  std::erase_if(screened, [](const Screened& s) { return !s.good; });
  std::ranges::sort(screened, {}, &Screened::criterion);
}

/// True if a law's criterion is close enough to its name's best, of either sign.
bool is_hopeful_law(double criterion, double best) { return criterion <= best + (1.0 - kHopeful) * std::abs(best); }

/// True if two candidates have one of their own parameters, those from `first` on, in common.
bool share_a_parameter(const Screened& one, const Screened& other, std::size_t first) {
  const auto own = [&](const Screened& s) { return std::span(s.fitted.free).subspan(first); };
  return std::ranges::any_of(own(one), [&](const FreeParameter& parameter) {
    return std::ranges::any_of(own(other), [&](const FreeParameter& p) { return p.is_same_as(parameter); });
  });
}

}  // namespace

Screening::Screening(const Evaluator& evaluator, const Fitted& current, const Scales& scales, unsigned threads)
    : evaluator_(evaluator), current_(current), scales_(scales), threads_(threads) {
  frozen_.u = current.u;
  std::vector<std::size_t> all(current.free.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  differentiate(evaluator, current.base, current.free, current.u, all, Slopes::narrow, threads, frozen_.jacobian);
  evaluator.predict(current.base, current.free, current.u, threads, prediction_);
  current_.temper = temper_of(evaluator, evaluator.residuals(prediction_));
  goodness_ = goodness(evaluator.data(), prediction_);
  frequencies_ = strongest_frequencies(evaluator.data(), prediction_, first_used(), kFrequencies);

  weight_ = weights_of(evaluator, current_.temper);
  prior_.setZero(static_cast<Eigen::Index>(current.free.size()));
  prior_gradient_ = prior_;
  for (std::size_t k = 0; k < current.free.size(); ++k) {
    prior_(static_cast<Eigen::Index>(k)) = current.free[k].prior_curvature();
    prior_gradient_(static_cast<Eigen::Index>(k)) = current.free[k].prior_slope(current.u[k]);
  }
  const Eigen::MatrixXd weighted = weight_.asDiagonal() * frozen_.jacobian;
  Eigen::MatrixXd matrix = weighted.transpose() * weighted;
  matrix.diagonal() += prior_;
  if (matrix.size() > 0) {
    // A parameter that the data do not touch and that has no prior must not make the matrix singular.
    matrix.diagonal().array() += 1e-9 * std::max(1e-30, matrix.diagonal().maxCoeff());
  }
  normal_.compute(matrix);
  Eigen::VectorXd move;
  const Eigen::VectorXd left = evaluator.residuals(prediction_);
  cost_ = eliminated_cost(left, move);

  Screened unaided{{}, current_, 0.0, 0.0, true};
  for (std::size_t k = 0; k < frozen_.u.size(); ++k) {
    unaided.fitted.u[k] += move(static_cast<Eigen::Index>(k));
  }
  std::array<double, kStages> reached{};
  Tangent tangent = tangent_of(evaluator_, unaided.fitted, fit_options(0, frozen_));
  tangent.begin_at(frozen_.u, left);
  for (const Stage stage : {Stage::scan, Stage::short_fit, Stage::full_fit}) {
    for (int pass = 0; pass < (stage == Stage::full_fit ? kFullFits : 1); ++pass) {
      improve(unaided, stage, tangent);
    }
    reached[static_cast<std::size_t>(stage)] = unaided.criterion;
  }
  unaided_ = reached;
}

std::vector<std::vector<double>> Screening::sharpened_for(const std::vector<Candidate>& candidates) const {
  const Dataset& data = evaluator_.data();
  std::vector<std::vector<double>> sharpened(data.channels.size());
  for (const Candidate& candidate : candidates) {
    const std::size_t channel = channel_of_sinusoid(candidate);
    if (is_periodic(candidate) && sharpened[channel].empty()) {
      sharpened[channel] = sharpened_frequencies(
          data, prediction_, channel,
          channel == first_used() ? frequencies_ : strongest_frequencies(data, prediction_, channel, kFrequencies));
    }
  }
  return sharpened;
}

std::vector<Screened> Screening::run(const std::vector<Candidate>& candidates, const std::string& stage,
                                     const Watch& watch) const {
  std::vector<Screened> screened(candidates.size());
  const std::vector<std::vector<double>> sharpened = sharpened_for(candidates);
  std::mutex one_at_a_time;
  std::size_t done = 0;
  const auto report = [&](const char* what, Work work, std::size_t count, double all) {
    const std::lock_guard guard(one_at_a_time);
    ++done;
    const double share = all * static_cast<double>(done) / static_cast<double>(count);
    watch.progress({work, fmt::format("{}: {} of {} {}", stage, done, count, what), share});
  };
  parallel_for(candidates.size(), threads_, [&](std::size_t i) {
    if (!watch.interrupted()) {
      screened[i] = start(candidates[i], sharpened);
    }
    report("candidates screened", Work::screening, candidates.size(), 1.0);
  });
  sort_best_first(screened);

  std::vector<std::string> names;
  std::vector<double> reached;
  std::vector<std::size_t> semifinalists;
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const Screened& one = screened[i];
    const bool hopeful = names.size() < kFirstNames || one.criterion < kHopeful * screened.front().criterion;
    auto name = std::find(names.begin(), names.end(), one.candidate.name);
    if (name == names.end() && names.size() < kSemifinalists && hopeful) {
      name = names.insert(names.end(), one.candidate.name);
      reached.push_back(one.criterion);
    }
    if (name != names.end() && is_hopeful_law(one.criterion, reached[static_cast<std::size_t>(name - names.begin())])) {
      semifinalists.push_back(i);
    }
  }
  done = 0;
  parallel_for(semifinalists.size(), threads_, [&](std::size_t i) {
    Screened& semifinalist = screened[semifinalists[i]];
    if (semifinalist.scanned) {
      improve(semifinalist, Stage::full_fit, kFullFits, watch);
    }
    report("best candidates fitted", Work::fitting, semifinalists.size(), SharesOfWork::kFittedAlone);
  });
  sort_best_first(screened);
  start_from_siblings(screened, names, watch);
  return screened;
}

std::vector<double> Screening::at_frozen(std::vector<double> u) const {
  std::copy(frozen_.u.begin(), frozen_.u.end(), u.begin());
  return u;
}

double Screening::eliminated_cost(const Eigen::VectorXd& residual, Eigen::VectorXd& move) const {
  const Eigen::VectorXd weighted = residual.cwiseProduct(weight_);
  const Eigen::VectorXd gradient = frozen_.jacobian.transpose() * weighted.cwiseProduct(weight_) + prior_gradient_;
  move = -normal_.solve(gradient);
  return weighted.squaredNorm() + gradient.dot(move);
}

Fitted Screening::with_candidate(const Candidate& candidate) const {
  Fitted fitted = current_;
  if (is_unlisted(current_.base, candidate)) {
    activate_unlisted(fitted.base, candidate, evaluator_.data(), current_);
  } else {
    activate(fitted.base, candidate);
  }
  const auto own = effect_parameters(fitted.base, candidate, scales_);
  fitted.free.insert(fitted.free.end(), own.begin(), own.end());
  if (is_periodic(candidate)) {
    const auto phases = clocks(evaluator_.data());
    fitted.free.insert(fitted.free.end(), phases.begin(), phases.end());
  }
  return fitted;
}

std::vector<Screening::Start> Screening::scan(Fitted fitted, const std::vector<std::vector<double>>& points) const {
  std::vector<Start> starts;
  Prediction prediction;
  Eigen::VectorXd move;
  for (const auto& point : points) {
    fitted.u = frozen_.u;
    fitted.u.insert(fitted.u.end(), point.begin(), point.end());
    if (!evaluator_.predict(fitted.base, fitted.free, fitted.u, 1, prediction)) {
      continue;
    }
    Eigen::VectorXd residual = evaluator_.residuals(prediction);
    if (!residual.allFinite()) {
      continue;
    }
    const double cost = eliminated_cost(residual, move);
    for (std::size_t k = 0; k < frozen_.u.size(); ++k) {
      fitted.u[k] += move(static_cast<Eigen::Index>(k));
    }
    starts.push_back({fitted.u, cost, std::move(residual)});
  }
  std::sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  return starts;
}

void Screening::narrow(const Fitted& fitted, std::vector<Start>& starts) const {
  double step = HUGE_VAL;
  for (const Start& other : std::span(starts).subspan(1)) {
    step = std::min(step, std::abs(other.u.back() - starts.front().u.back()));
  }
  const auto [low, high] = fitted.free.back().range();
  for (int i = 0; i < kNarrowings && step > 0.0 && std::isfinite(step); ++i) {
    step *= 0.5;
    const double best = starts.front().u.back();
    std::vector<Start> beside = scan(fitted, {{std::max(low, best - step)}, {std::min(high, best + step)}});
    if (!beside.empty() && beside.front().cost < starts.front().cost) {
      starts.front() = std::move(beside.front());
    }
  }
}

Screened Screening::start(const Candidate& candidate, const std::vector<std::vector<double>>& sharpened) const {
  const Stopwatch stopwatch;
  Screened best;
  best.candidate = candidate;
  const Fitted fitted = with_candidate(candidate);
  const std::vector<FreeParameter> own(fitted.free.begin() + static_cast<std::ptrdiff_t>(current_.free.size()),
                                       fitted.free.end());
  const auto fields = static_cast<std::size_t>(std::count_if(
      own.begin(), own.end(), [](const FreeParameter& p) { return !p.is_ordinate() && !p.is_initial_state(); }));
  if (fields > kMostScanned) {
    best.fitted = fitted;
    best.fitted.u.resize(fitted.free.size(), 0.0);
    best.good = true;
    best.scanned = false;
    return best;
  }
  // One or two parameters, or a table, have one valley; more have several.
  const bool has_table = std::ranges::any_of(own, &FreeParameter::is_ordinate);
  const bool one_valley = own.size() <= 2 || std::ranges::all_of(own, &FreeParameter::is_ordinate);
  std::vector<Start> starts =
      scan(fitted, is_periodic(candidate)
                       ? periodic_starts(evaluator_, fitted, current_.free.size(), sharpened[channel_of_sinusoid(candidate)])
                       : start_points(own, frequencies_));
  // A table starts as nothing, and a frequency has to be met. Of any other law one of the starts is better than nothing, or
  // it is not what is missing.
  const bool searched =
      has_table || std::any_of(own.begin(), own.end(), [](const FreeParameter& p) { return p.unit == "Hz"; });
  const bool hopeless = !searched && !starts.empty() && starts.front().cost >= cost_;
  if (!hopeless && !searched && own.size() == 1 && !starts.empty()) {
    narrow(fitted, starts);
  }
  for (std::size_t i = 0; i < starts.size() && i < (hopeless || one_valley ? 1 : kStarts); ++i) {
    Screened screened{candidate, fitted, 0.0, 0.0, true};
    screened.fitted.u = starts[i].u;
    Tangent tangent = tangent_of(evaluator_, screened.fitted, fit_options(0, frozen_));
    tangent.begin_at(at_frozen(starts[i].u), std::move(starts[i].residual));
    improve(screened, hopeless ? Stage::scan : Stage::short_fit, tangent);
    if (screened.good && (!best.good || screened.criterion < best.criterion)) {
      best = std::move(screened);
    }
  }
  best.seconds = stopwatch.seconds();
  return best;
}

Screened Screening::restart(const Candidate& candidate, const std::vector<double>& own, const Watch& watch) const {
  const Fitted fitted = with_candidate(candidate);
  const std::vector<FreeParameter> parameters(fitted.free.begin() + static_cast<std::ptrdiff_t>(current_.free.size()),
                                              fitted.free.end());
  std::vector<std::vector<double>> points = start_points(parameters, frequencies_);
  for (std::size_t k = 0; k < own.size(); ++k) {
    for (const double factor : {1.0 / kRestartFactor, kRestartFactor}) {
      points.push_back(own);
      points.back()[k] = parameters[k].coordinate(
          std::clamp(parameters[k].value(own[k]) * factor, parameters[k].lower, parameters[k].upper));
    }
  }
  const std::vector<Start> starts = scan(fitted, points);
  std::vector<Screened> restarts;
  for (std::size_t i = 0; i < starts.size() && i < kRestarts; ++i) {
    restarts.push_back({candidate, fitted, 0.0, 0.0, true});
    restarts.back().fitted.u = starts[i].u;
  }
  parallel_for(restarts.size(), threads_, [&](std::size_t i) { improve(restarts[i], Stage::short_fit, 1, watch); });
  sort_best_first(restarts);
  restarts.resize(std::min<std::size_t>(restarts.size(), 2));
  parallel_for(restarts.size(), threads_, [&](std::size_t i) { improve(restarts[i], Stage::full_fit, kFullFits, watch); });
  sort_best_first(restarts);
  Screened unmoved{candidate, fitted, 0.0, 0.0, true};
  unmoved.fitted.u = frozen_.u;
  unmoved.fitted.u.insert(unmoved.fitted.u.end(), own.begin(), own.end());
  improve(unmoved, Stage::scan, 1, watch);
  const bool elsewhere =
      !restarts.empty() && (!unmoved.good || restarts.front().criterion < unmoved.criterion - policy().strong_evidence);
  return elsewhere ? restarts.front() : Screened{candidate, fitted, 0.0, 0.0, false};
}

/// Laws of one effect share parameters and some contain others: each is fitted once more from where the best one ended.
void Screening::start_from_siblings(std::vector<Screened>& screened, const std::vector<std::string>& names,
                                    const Watch& watch) const {
  const std::size_t first = current_.free.size();
  const std::vector<Screened> ended = screened;
  parallel_for(screened.size(), threads_, [&](std::size_t i) {
    const auto best = std::find_if(ended.begin(), ended.end(),
                                   [&](const Screened& s) { return s.candidate.name == ended[i].candidate.name; });
    const bool wanted = std::find(names.begin(), names.end(), ended[i].candidate.name) != names.end() &&
                        share_a_parameter(*best, ended[i], first);
    if (!wanted || best == ended.begin() + static_cast<std::ptrdiff_t>(i) || watch.interrupted()) {
      return;
    }
    Screened again{ended[i].candidate, ended[i].fitted, 0.0, ended[i].seconds, true};
    for (std::size_t k = first; k < again.fitted.free.size(); ++k) {
      FreeParameter& parameter = again.fitted.free[k];
      again.fitted.u[k] = parameter.coordinate(std::clamp(parameter.unit_size, parameter.lower, parameter.upper));
      for (std::size_t j = first; j < best->fitted.free.size(); ++j) {
        if (best->fitted.free[j].is_same_as(parameter)) {
          again.fitted.u[k] = best->fitted.u[j];
        }
      }
    }
    std::copy(best->fitted.u.begin(), best->fitted.u.begin() + static_cast<std::ptrdiff_t>(first), again.fitted.u.begin());
    Tangent tangent = tangent_of(evaluator_, again.fitted, fit_options(0, frozen_));
    improve(again, Stage::full_fit, tangent);
    if (again.good && (!screened[i].scanned || again.criterion < screened[i].criterion)) {
      screened[i] = std::move(again);
    } else {
      screened[i].seconds = again.seconds;
    }
  });
  sort_best_first(screened);
}

void Screening::improve(Screened& screened, Stage stage, int passes, const Watch& watch) const {
  Tangent tangent = tangent_of(evaluator_, screened.fitted, fit_options(0, frozen_));
  for (int pass = 0; pass < passes && !watch.interrupted(); ++pass) {
    improve(screened, stage, tangent);
  }
}

void Screening::improve(Screened& screened, Stage stage, Tangent& tangent) const {
  if (!screened.good) {
    return;
  }
  const Stopwatch stopwatch;
  const int iterations = stage == Stage::scan ? 0 : stage == Stage::short_fit ? kShortFit : kFullFit;
  Fitted& fitted = screened.fitted;
  screened.good = (iterations == 0 || fit(evaluator_, fitted, fit_options(iterations, frozen_), tangent)) &&
                  tangent.move_to(at_frozen(fitted.u));
  if (!screened.good) {
    return;
  }
  Eigen::VectorXd residual = tangent.residual();
  const auto count = static_cast<Eigen::Index>(frozen_.u.size());
  residual += frozen_.jacobian * (Eigen::Map<const Eigen::VectorXd>(fitted.u.data(), count) -
                                  Eigen::Map<const Eigen::VectorXd>(frozen_.u.data(), count));
  fitted.temper = temper_of(evaluator_, residual);
  const std::vector<ChannelFit> left = mean_squares(residual);
  screened.criterion =
      information_criterion(left, goodness_.fitted, fitted.free.size()) - unaided_[static_cast<std::size_t>(stage)];
  screened.left = Goodness::combined(left) / Goodness::combined(goodness_.fitted);
  screened.seconds += stopwatch.seconds();
}

std::vector<ChannelFit> Screening::mean_squares(const Eigen::VectorXd& residual) const {
  const std::vector<double> square = evaluator_.squares_by_channel(residual);
  std::vector<ChannelFit> part(square.size());
  for (const Stretch& s : evaluator_.stretches()) {
    part[s.channel].rows += static_cast<double>(s.last - s.first);
  }
  for (std::size_t c = 0; c < part.size(); ++c) {
    part[c].mean_square = part[c].rows > 0.0 ? square[c] / part[c].rows : 0.0;
  }
  return part;
}

}  // namespace hotfire::explain
