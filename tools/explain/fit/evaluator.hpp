// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/data/plants.hpp"
#include "tools/explain/data/zeros.hpp"
#include "tools/explain/fit/parameter_space.hpp"

namespace hotfire::explain {

/// What a model predicts: by experiment, by channel, a value a row.
using Prediction = std::vector<std::vector<std::vector<double>>>;

/// A prediction of `data` at the rows of `thin`, which is thinned from it.
Prediction at_thinned_rows(const Prediction& full, const Dataset& data, const Dataset& thin);

/// A run of consecutive rows of one channel that a fit sees, and where its residuals start in the residual vector.
struct Stretch {
  std::size_t experiment;
  std::size_t channel;
  std::size_t first;
  std::size_t last;
  std::size_t offset;
};

/// How finely experiments are stepped: `fine` is what `hotfire simulate` and the rig do; `coarse` takes half as many steps
/// and ranks candidates, a step of 1 ms being right to a hundredth of sensor noise on smooth effects; `rough` takes a
/// quarter and screens them, where what is left is far more than such steps are wrong by. `finest` takes twice as many as
/// `fine`, to know the error of those.
enum class Resolution { finest, fine, coarse, rough };

/// Steps in place of as many `fine` ones.
int steps_at(Resolution resolution, int fine);

/// Puts the coordinates `u` into parameters.
ModelParameters with_values(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u);

/// Simulates every experiment of a dataset under given parameters, and differentiates the simulation by narrow difference
/// quotients (`model::Perturbed`): the one that it makes, or one of longer steps. The end of a fit is where residuals say,
/// and a fit still closes in on it along derivatives that are off by a few percent.
class Evaluator {
 public:
  Evaluator(const Dataset& data, Resolution resolution) : Evaluator(data, resolution, resolution) {}
  /// Differentiates under `slopes`.
  Evaluator(const Dataset& data, Resolution resolution, Resolution slopes);

  const Dataset& data() const { return data_; }
  Resolution resolution() const { return resolution_; }
  const std::vector<Stretch>& stretches() const { return stretches_; }
  /// Residuals a fit sees, over all experiments and channels.
  std::size_t fit_rows() const { return fit_rows_; }

  /// Simulates all experiments, and adds to each channel of each the zero that is most likely then (zeros.hpp). False if a
  /// state became non-finite.
  bool predict(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u, unsigned threads,
               Prediction& prediction) const;
  /// The same with those zeros.
  bool predict(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u, unsigned threads,
               Prediction& prediction, Zeros& zeros) const;

  /// This evaluator with every prediction shifted by as much as one under finer steps differs from its `own` at one model:
  /// what long steps are wrong by changes little from there to models nearby.
  Evaluator shifted(const Prediction& own, const Prediction& finer) const;

  /// (prediction - measured) / noise on the rows a fit sees, of a prediction that `predict` made. The zeros are integrated
  /// out: the n rows of a channel of a record are whitened by the rank-one covariance that its zero adds to their noise,
  /// I + s^2 1 1^T with s = S / noise, which takes from each the share 1 - 1 / sqrt(1 + n s^2) of their mean.
  Eigen::VectorXd residuals(const Prediction& prediction) const;

  /// Sum of squares of such residuals, by channel.
  std::vector<double> squares_by_channel(const Eigen::VectorXd& residual) const;

  /// Derivatives of such residuals with respect to the coordinates `u` of the parameters `wanted`, a column each. False if
  /// one became non-finite.
  bool differentiate(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u,
                     std::span<const std::size_t> wanted, unsigned threads, Eigen::MatrixXd& jacobian) const;

 private:
  /// Calls f(first row, rows, precision) for the residuals of every channel of every record that has a zero.
  template <class F>
  void for_each_zero(F&& f) const;

  const Dataset& data_;
  Resolution resolution_ = Resolution::fine;
  Resolution slopes_ = Resolution::fine;
  Prediction shift_;                        ///< empty: none
  std::vector<std::size_t> longest_first_;  ///< experiments in the order in which threads take them
  std::vector<Stretch> stretches_;
  std::size_t fit_rows_ = 0;
};

}  // namespace hotfire::explain
