// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/latent/row_products.hpp"
#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Regressors that run along the flow together: their states stay in the processor's registers and first cache.
constexpr Eigen::Index kBatch = 32;
static_assert(static_cast<Eigen::Index>(model::kUnlistedPoints) + 1 <= kBatch);  // a form fits into a batch

/// Every form's regressors by experiment, a row each and a column a row of the record, each over its largest value: its
/// coefficient is then what it adds there over the port's scale.
template <class S>
struct Regressors {
  std::vector<Eigen::Matrix<S, kBatch, Eigen::Dynamic>> added;
  Eigen::VectorXd largest;
};

/// Added to every regressor: a state that dies out would end in numbers that a processor takes a hundred times as long for.
/// It is as far below a regressor as its square is above such numbers.
constexpr double kFloor = 1e-15;

template <class S, class AddedBy>
Regressors<S> scaled_regressors(std::span<const Form> forms, const std::vector<Eigen::MatrixXd>& quantities,
                                AddedBy&& added_by) {
  Regressors<S> all{{}, Eigen::VectorXd::Zero(kBatch)};
  std::vector<std::vector<Eigen::MatrixXd>> columns(quantities.size());
  for (std::size_t e = 0; e < quantities.size(); ++e) {
    Eigen::Index first = 0;
    for (const Form& form : forms) {
      const Eigen::MatrixXd& own = columns[e].emplace_back(added_by(form, e));
      if (own.rows() > 0) {
        auto largest = all.largest.segment(first, own.cols());
        largest = largest.cwiseMax(own.cwiseAbs().colwise().maxCoeff().transpose());
      }
      first += own.cols();
    }
  }
  for (double& size : all.largest) {
    size = size > 0.0 && std::isfinite(size) ? size : 1.0;
  }
  const Eigen::VectorXd scale = all.largest.cwiseInverse();
  for (std::size_t e = 0; e < quantities.size(); ++e) {
    auto& added =
        all.added.emplace_back(Eigen::Matrix<S, kBatch, Eigen::Dynamic>::Constant(kBatch, quantities[e].rows(), S(kFloor)));
    Eigen::Index first = 0;
    for (const Eigen::MatrixXd& own : columns[e]) {
      for (Eigen::Index column = 0; column < own.cols(); ++column, ++first) {
        added.row(first) += (scale(first) * own.col(column)).template cast<S>().transpose();
      }
    }
  }
  return all;
}

/// A number in the precision of a regression: nothing where it is far below what rounding leaves.
template <class S>
S rounded(double value) {
  return std::abs(value) < 1e-30 ? S(0.0) : static_cast<S>(value);
}

}  // namespace

FormRegression::FormRegression(const LatentProblem& problem, const LatentPlace& place, const LatentInput& input,
                               Arguments arguments)
    : problem_(problem), place_(place), signal_(input.signal) {
  const Eigen::Index parameters = problem.expected.size();
  nuisance_ = Eigen::MatrixXd::Identity(parameters, parameters);
  nuisance_right_ = problem.expected;
  for (std::size_t e = 0; e < problem.data.experiments.size(); ++e) {
    const double share = arguments == Arguments::smoothed ? 1.0 : 0.0;
    quantities_.push_back(explain::quantities(problem, e, share * input.states[e]));
    const auto own = static_cast<Eigen::Index>(problem.own[e].size());
    Eigen::MatrixXd own_normal = Eigen::MatrixXd::Zero(own, own);
    Eigen::VectorXd own_right = Eigen::VectorXd::Zero(own);
    for (Eigen::Index c = 0; c < problem.left[e].cols(); ++c) {
      for (Eigen::Index row = 0; row < problem.left[e].rows(); ++row) {
        const double left = problem.left[e](row, c);
        if (std::isnan(left)) {
          continue;
        }
        const auto slopes = problem.sensitivity[e][static_cast<std::size_t>(c)].col(row);
        own_normal.noalias() += slopes * slopes.transpose();
        own_right.noalias() += slopes * left;
        square_ += left * left;
        count_ += 1.0;
      }
    }
    nuisance_(problem.own[e], problem.own[e]) += own_normal;
    nuisance_right_(problem.own[e]) += own_right;
  }
  for (std::size_t e = 0; e < quantities_.size(); ++e) {
    single_.push_back(record<float>(e));
    full_.push_back(record<double>(e));
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(nuisance_);
  left_without_ = (square_ - nuisance_right_.dot(factor.solve(nuisance_right_))) / count_;
}

template <class S>
FormRegression::Record<S> FormRegression::record(std::size_t experiment) const {
  Record<S> record;
  if (place_.port) {
    const std::vector<RowFlow>& rows = problem_.flows[experiment].rows;
    std::ranges::transform(rows, std::back_inserter(record.flow), [&](const RowFlow& row) {
      return PlaceFlow<S>{row.transition.unaryExpr(&rounded<S>),
                          row.response.col(static_cast<int>(*place_.port)).unaryExpr(&rounded<S>)};
    });
  }
  const Eigen::MatrixXd& left = problem_.left[experiment];
  for (Eigen::Index c = 0; c < left.cols(); ++c) {
    const Eigen::MatrixXd& slopes = problem_.sensitivity[experiment][static_cast<std::size_t>(c)];
    auto& others = record.others.emplace_back(slopes.rows() + 1, left.rows());
    others << slopes.template cast<S>(), left.col(c).transpose().template cast<S>();
    const auto channel = static_cast<std::size_t>(c);
    const double scale = place_.port ? problem_.scales.state(kReadState[channel]) : problem_.scales.reading[channel];
    const bool is_reached = place_.port || place_.channel == channel;
    record.unit.push_back(is_reached ? rounded<S>(scale / problem_.data.experiments[experiment].noise[channel]) : S(0.0));
  }
  return record;
}

bool FormRegression::is_explained_by(double left) const {
  return left < policy().left_by_single && left - 1.0 < policy().little_explained * (left_without_ - 1.0);
}

std::vector<FormScore> FormRegression::score(std::span<const Form> forms, unsigned threads, Precision precision) const {
  std::vector<std::pair<std::size_t, std::size_t>> batches;
  for (std::size_t first = 0; first < forms.size();) {
    std::size_t last = first;
    Eigen::Index columns = 0;
    while (last < forms.size() && (last == first || columns + forms[last].size() <= kBatch)) {
      columns += forms[last].size();
      ++last;
    }
    batches.emplace_back(first, last);
    first = last;
  }
  std::vector<FormScore> scores(forms.size());
  parallel_for(batches.size(), threads, [&](std::size_t b) {
    const auto [first, last] = batches[b];
    const std::span<const Form> some = forms.subspan(first, last - first);
    const std::span<FormScore> scores_of_some = std::span(scores).subspan(first, last - first);
    if (precision == Precision::single) {
      score_some(single_, some, scores_of_some);
    } else {
      score_some(full_, some, scores_of_some);
    }
  });
  return scores;
}

/// What a form's regressors add at its port, but for a constant. What is added to the opening of the valve acts through the
/// orifices: its flow falls with the pressure that is left across them.
Eigen::MatrixXd FormRegression::added_by(const Form& form, std::size_t experiment) const {
  const Eigen::MatrixXd& seen = quantities_[experiment];
  Eigen::MatrixXd columns = regressors(form, seen, problem_.data.experiments[experiment].period);
  if (form.site == model::Site::valve) {
    const auto of = [&](model::Argument quantity) { return seen.col(static_cast<Eigen::Index>(quantity)).array(); };
    const auto opening = of(model::Argument::spool);
    const auto share = of(model::Argument::flow) / (problem_.parameters.servovalve.rated_flow * opening);
    columns.array().colwise() *= (opening != 0.0).select(share, 1.0);
  }
  return columns;
}

/// What a unit at the form's site is at the port of its place, over that port's scale.
double FormRegression::to_port(const Form& form) const {
  const auto& parameters = problem_.parameters;
  if (!place_.port) {
    return 1.0 / problem_.scales.reading[place_.channel];
  }
  const double stiffness = 1.0 / (1.0 / parameters.actuator.stiffness + 1.0 / parameters.structure.stiffness);
  const double unit = form.site == model::Site::command
                          ? parameters.servovalve.position_gain * parameters.actuator.moment_arm
                      : form.site == model::Site::load_spring ? stiffness
                      : form.site == model::Site::valve       ? parameters.servovalve.rated_flow
                                                              : 1.0;
  return unit / problem_.scales.input(static_cast<int>(*place_.port));
}

template <class S>
void FormRegression::score_some(const std::vector<Record<S>>& records, std::span<const Form> forms,
                                std::span<FormScore> scores) const {
  const Eigen::Index parameters = problem_.expected.size();
  std::vector<Eigen::Index> first;
  Eigen::Index columns = 0;
  for (const Form& form : forms) {
    first.push_back(columns);
    columns += form.size();
  }
  const auto [added, largest] =
      scaled_regressors<S>(forms, quantities_, [&](const Form& form, std::size_t e) { return added_by(form, e); });
  // Columns beyond those of the forms count for nothing: of a fixed size, the flow takes a fraction of the time.
  using States = Eigen::Matrix<S, kFlowStates, kBatch, Eigen::RowMajor>;
  using Row = Eigen::Matrix<S, 1, kBatch>;
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(columns, parameters);
  Eigen::VectorXd own_right = Eigen::VectorXd::Zero(columns);
  for (std::size_t e = 0; e < records.size(); ++e) {
    States state = States::Zero();
    const Record<S>& record = records[e];
    const auto of_record = static_cast<Eigen::Index>(problem_.own[e].size());
    RowProducts<S> products(columns, of_record + 1);  // the others: a parameter each, then what is left
    for (Eigen::Index row = 0; row < added[e].cols(); ++row) {
      for (std::size_t c = 0; c < record.others.size(); ++c) {
        if (std::isnan(record.others[c](of_record, row)) || record.unit[c] == S(0.0)) {
          continue;
        }
        const Row reading =
            record.unit[c] * (place_.port ? Row(state.row(kReadState[c])) : Row(added[e].col(row).transpose()));
        products.add([&](auto&& values, auto&& others) {
          values = reading.leftCols(columns).transpose();
          others = record.others[c].col(row);
        });
      }
      if (place_.port && row + 1 < added[e].cols()) {
        const PlaceFlow<S>& flow = record.flow[static_cast<std::size_t>(row)];
        const Row input = S(0.5) * (added[e].col(row) + added[e].col(row + 1)).transpose();
        const States next = flow.transition.lazyProduct(state);
        state = next + flow.response.lazyProduct(input);
      }
    }
    products.flush();
    own += products.own;
    own_right += products.cross.rightCols(1);
    cross(Eigen::all, problem_.own[e]) += products.cross.leftCols(of_record);
  }
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const Eigen::Index size = forms[f].size();
    Eigen::MatrixXd whole(size + parameters, size + parameters);
    whole.topLeftCorner(size, size) = own.block(first[f], first[f], size, size) + Eigen::MatrixXd::Identity(size, size);
    whole.topRightCorner(size, parameters) = cross.middleRows(first[f], size);
    whole.bottomLeftCorner(parameters, size) = cross.middleRows(first[f], size).transpose();
    whole.bottomRightCorner(parameters, parameters) = nuisance_;
    Eigen::VectorXd right(size + parameters);
    right << own_right.segment(first[f], size), nuisance_right_;
    const Eigen::LDLT<Eigen::MatrixXd> factor(whole);
    const Eigen::VectorXd solution = factor.solve(right);
    scores[f].left = std::max(1e-12, (square_ - right.dot(solution)) / count_);
    scores[f].criterion =
        solution.allFinite() ? count_ * std::log(scores[f].left) + static_cast<double>(size) * std::log(count_) : HUGE_VAL;
    scores[f].move = solution.tail(parameters);
    scores[f].coefficients = solution.head(size).cwiseQuotient(largest.segment(first[f], size)) / to_port(forms[f]);
  }
}

}  // namespace hotfire::explain
