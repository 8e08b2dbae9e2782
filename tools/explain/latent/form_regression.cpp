// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/explain/fit/parallel.hpp"

namespace hotfire::explain {

namespace {

/// Regressors that run along the flow together: their states stay in the processor's first cache.
constexpr Eigen::Index kBatch = 24;

/// Normal equations of one form's regressors, with the declared parameters and what is left.
struct Normal {
  Eigen::MatrixXd own;
  Eigen::MatrixXd cross;  ///< a row a regressor, a column a parameter of the problem
  Eigen::VectorXd right;
};

/// Every form's regressors by experiment, side by side, each over its largest value: its coefficient is then what it adds
/// there over the port's scale.
struct Regressors {
  std::vector<Eigen::MatrixXd> added;
  Eigen::VectorXd largest;
};

Regressors scaled_regressors(std::span<const Form> forms, const std::vector<Eigen::MatrixXd>& quantities,
                             const Dataset& data, Eigen::Index columns) {
  Regressors all{{}, Eigen::VectorXd::Zero(columns)};
  for (std::size_t e = 0; e < quantities.size(); ++e) {
    Eigen::MatrixXd& added = all.added.emplace_back(quantities[e].rows(), columns);
    Eigen::Index first = 0;
    for (const Form& form : forms) {
      added.middleCols(first, form.size()) = regressors(form, quantities[e], data.experiments[e].period);
      first += form.size();
    }
    if (added.rows() > 0) {
      all.largest = all.largest.cwiseMax(added.cwiseAbs().colwise().maxCoeff().transpose());
    }
  }
  for (double& size : all.largest) {
    size = size > 0.0 && std::isfinite(size) ? size : 1.0;
  }
  for (Eigen::MatrixXd& added : all.added) {
    added.array().rowwise() /= all.largest.transpose().array();
  }
  return all;
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
}

double FormRegression::left_without() const {
  const Eigen::LLT<Eigen::MatrixXd> factor(nuisance_);
  return (square_ - nuisance_right_.dot(factor.solve(nuisance_right_))) / count_;
}

std::vector<FormScore> FormRegression::score(std::span<const Form> forms, unsigned threads) const {
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
    score_some(forms.subspan(first, last - first), std::span(scores).subspan(first, last - first));
  });
  return scores;
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
                                                              : 1.0;
  return unit / problem_.scales.input(static_cast<int>(*place_.port));
}

void FormRegression::score_some(std::span<const Form> forms, std::span<FormScore> scores) const {
  const Eigen::Index parameters = problem_.expected.size();
  std::vector<Normal> normals;
  std::vector<Eigen::Index> first;
  Eigen::Index columns = 0;
  for (const Form& form : forms) {
    const Eigen::Index size = form.size();
    normals.push_back(
        {Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, parameters), Eigen::VectorXd::Zero(size)});
    first.push_back(columns);
    columns += size;
  }
  const auto [added, largest] = scaled_regressors(forms, quantities_, problem_.data, columns);
  Eigen::Matrix<double, kFlowStates, Eigen::Dynamic> state(kFlowStates, columns);
  Eigen::Matrix<double, kFlowStates, Eigen::Dynamic> next(kFlowStates, columns);
  Eigen::RowVectorXd reading(columns);
  for (std::size_t e = 0; e < quantities_.size(); ++e) {
    state.setZero();
    const Eigen::MatrixXd& left = problem_.left[e];
    Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(columns, static_cast<Eigen::Index>(problem_.own[e].size()));
    for (Eigen::Index row = 0; row < left.rows(); ++row) {
      for (Eigen::Index c = 0; c < left.cols(); ++c) {
        if (std::isnan(left(row, c))) {
          continue;
        }
        const auto channel = static_cast<std::size_t>(c);
        const double noise = problem_.data.experiments[e].noise[channel];
        if (place_.port) {
          reading = state.row(kReadState[channel]) * (problem_.scales.state(kReadState[channel]) / noise);
        } else if (place_.channel == channel) {
          reading = added[e].row(row) * (problem_.scales.reading[channel] / noise);
        } else {
          continue;
        }
        const auto slopes = problem_.sensitivity[e][channel].col(row);
        for (std::size_t f = 0; f < forms.size(); ++f) {
          const auto own = reading.segment(first[f], forms[f].size()).transpose();
          normals[f].own.noalias() += own * own.transpose();
          normals[f].right.noalias() += own * left(row, c);
        }
        cross.noalias() += reading.transpose() * slopes.transpose();
      }
      if (place_.port && row + 1 < left.rows()) {
        const RowFlow& flow = problem_.flows[e].rows[static_cast<std::size_t>(row)];
        next.noalias() = flow.transition * state;
        next.noalias() +=
            flow.response.col(static_cast<int>(*place_.port)) * (0.5 * (added[e].row(row) + added[e].row(row + 1)));
        state.swap(next);
      }
    }
    for (std::size_t f = 0; f < forms.size(); ++f) {
      normals[f].cross(Eigen::all, problem_.own[e]) += cross.middleRows(first[f], forms[f].size());
    }
  }
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const Eigen::Index size = forms[f].size();
    Eigen::MatrixXd whole(size + parameters, size + parameters);
    whole.topLeftCorner(size, size) = normals[f].own + Eigen::MatrixXd::Identity(size, size);
    whole.topRightCorner(size, parameters) = normals[f].cross;
    whole.bottomLeftCorner(parameters, size) = normals[f].cross.transpose();
    whole.bottomRightCorner(parameters, parameters) = nuisance_;
    Eigen::VectorXd right(size + parameters);
    right << normals[f].right, nuisance_right_;
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
