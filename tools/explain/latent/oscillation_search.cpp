// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/oscillation_search.hpp"

#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "tools/explain/data/spectrum.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/latent/form_comb.hpp"

namespace hotfire::explain {

namespace {

using model::Argument;

constexpr double kOscillationTurn = 2.0 * std::numbers::pi;
/// Frequencies of an oscillation, in cycles a time constant of the servo: of the reference axis 1 to 30 Hz. Below, a motion
/// of the axis looks the same.
constexpr double kSlowestOscillation = 0.059;
constexpr double kFastestOscillation = 1.77;
/// The most that a quantity moves the frequency, in the same unit: of the reference axis 10 Hz.
constexpr double kMostTuned = 0.6;
/// Samples a cycle of the fastest.
constexpr double kSamplesACycle = 2.5;
/// Part of a turn by which neighbouring tunings differ at the ends of the record: a peak loses little to a sixth.
constexpr double kTunedApart = 1.0 / 3.0;
constexpr int kMostTunings = 400;
/// Shares of a quantity's size beyond which the frequency no longer moves: a straight line, and curves that saturate. The
/// fit of a curve that starts far from the right one ends whole turns off.
constexpr std::array kBends{1.0, 0.7, 0.5, 0.35, 0.25};
/// Quantities whose oscillation is fitted, and points of its curve.
constexpr std::size_t kFittedOscillations = 3;
constexpr int kTuningPoints = 13;
static_assert(kTuningPoints <= static_cast<int>(model::kUnlistedPoints));
/// Curvatures that a curve may have, from stiff to free. Their unit is the most that a quantity moves the frequency. A curve
/// that starts free can gain or lose a turn where its quantity has few samples.
constexpr std::array kCurvatures{0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
constexpr int kTuningSteps = 30;
/// Share of a signal that rounding leaves.
constexpr double kLeastLeft = 1e-12;

/// Signal and quantities of one record at samples that are as far apart in every record.
struct Sampled {
  Eigen::VectorXd signal;
  Eigen::MatrixXd quantities;
};

/// An oscillation by its quantity: `frequency` + `tuning` x the bent quantity, both in hertz.
struct Peak {
  Argument argument = Argument::time;
  double bend = 1.0;
  double frequency = 0.0;
  double tuning = 0.0;
  double power = 0.0;
};

/// A curve of the frequency over a quantity.
struct Tuned {
  Peak peak;
  std::vector<double> points;
  std::vector<double> values;  ///< added to the peak's frequency
  double left = HUGE_VAL;      ///< sum of squares
  double bic = HUGE_VAL;       ///< with the effective number of its values
};

class OscillationSearch {
 public:
  explicit OscillationSearch(const FormRegression& regression) {
    const double servo = regression.problem().scales.time;
    slowest_ = kSlowestOscillation / servo;
    fastest_ = kFastestOscillation / servo;
    most_tuned_ = kMostTuned / servo;
    period_ = 1.0 / (kSamplesACycle * fastest_);
    for (const Experiment& experiment : regression.problem().data.experiments) {
      period_ = std::max(period_, experiment.period);
    }
    std::size_t longest = 0;
    for (std::size_t e = 0; e < regression.quantities().size(); ++e) {
      records_.push_back(sampled(regression, e));
      longest = std::max(longest, static_cast<std::size_t>(records_.back().signal.size()));
    }
    length_ = static_cast<Eigen::Index>(fast_transform_length(2 * std::max<std::size_t>(longest, 8)));
  }

  /// The strongest oscillation that a quantity tunes by each of the bends; none if the quantity or the signal does not move.
  std::vector<Peak> strongest(Argument argument) const {
    std::vector<Peak> peaks;
    const auto [middle, size] = extent(argument);
    if (!(size > 0.0)) {
      return peaks;
    }
    for (const double bend : kBends) {
      const std::vector<Eigen::VectorXd> turns = integrals(argument, middle, size, bend);
      double range = 0.0;
      for (const Eigen::VectorXd& of_record : turns) {
        range = std::max(range, of_record.size() > 0 ? of_record.maxCoeff() - of_record.minCoeff() : 0.0);
      }
      const int tunings = std::clamp(static_cast<int>(most_tuned_ * range / kTunedApart), 1, kMostTunings);
      if (const Peak best = strongest_of_bend(argument, bend, turns, tunings); best.power > 0.0) {
        peaks.push_back(best);
      }
    }
    return peaks;
  }

  /// The curve over the peak's quantity with which an oscillation explains most of the signal. The BIC selects its
  /// smoothness.
  Tuned tuned(const Peak& peak) const {
    const auto [middle, size] = extent(peak.argument);
    Tuned curve{peak, spread_points(sorted_values(peak.argument), kTuningPoints), {}};
    std::vector<double> places;
    for (const double point : curve.points) {
      places.push_back((point - middle) / size);
      curve.values.push_back(peak.tuning * bent(places.back(), peak.bend));
    }
    if (curve.points.size() < 3) {
      return curve;
    }
    const std::vector<Eigen::MatrixXd> hats = hat_integrals(peak.argument, curve.points);
    const Eigen::MatrixXd roughness = roughness_of(places) / (most_tuned_ * most_tuned_);
    Tuned best = curve;
    for (const double curvature : kCurvatures) {
      fit_values(curve, hats, roughness / (curvature * curvature));
      if (curve.bic < best.bic) {
        best = curve;
      }
    }
    return best;
  }

 private:
  struct Normal {
    explicit Normal(std::size_t points)
        : matrix(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(points), static_cast<Eigen::Index>(points))),
          right(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points))) {}

    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
  };

  /// The integral of the squared second derivative, as a quadratic form in the values at `places`.
  static Eigen::MatrixXd roughness_of(const std::vector<double>& places) {
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd roughness = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
      const double before = places[i] - places[i - 1];
      const double behind = places[i + 1] - places[i];
      const Eigen::Vector3d second =
          2.0 / (before + behind) * Eigen::Vector3d(1.0 / before, -1.0 / before - 1.0 / behind, 1.0 / behind);
      roughness.block<3, 3>(static_cast<Eigen::Index>(i) - 1, static_cast<Eigen::Index>(i) - 1) +=
          0.5 * (before + behind) * second * second.transpose();
    }
    return roughness;
  }

  /// Fits the values by Levenberg-Marquardt. The cost is what is left and a penalty of the roughness, which the mean square
  /// at the start weighs.
  void fit_values(Tuned& tuned, const std::vector<Eigen::MatrixXd>& hats, const Eigen::MatrixXd& roughness) const {
    const auto count = static_cast<Eigen::Index>(tuned.values.size());
    double samples = 0.0;
    for (const Sampled& record : records_) {
      samples += static_cast<double>(record.signal.size());
    }
    tuned.left = left_by(tuned, hats, nullptr);
    const Eigen::MatrixXd stiffness = tuned.left / samples * roughness;
    const auto cost = [&](const Tuned& at) {
      const auto values = Eigen::Map<const Eigen::VectorXd>(at.values.data(), count);
      return at.left + values.dot(stiffness * values);
    };
    double damping = 1e-3;
    for (int step = 0; step < kTuningSteps; ++step) {
      Normal normal(tuned.values.size());
      left_by(tuned, hats, &normal);
      Eigen::MatrixXd damped = normal.matrix + stiffness;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-12 * normal.matrix.diagonal().maxCoeff();
      const Eigen::VectorXd move =
          damped.ldlt().solve(normal.right - stiffness * Eigen::Map<const Eigen::VectorXd>(tuned.values.data(), count));
      Tuned next = tuned;
      Eigen::Map<Eigen::VectorXd>(next.values.data(), count) += move;
      next.left = left_by(next, hats, nullptr);
      const bool is_better = cost(next) < cost(tuned);
      damping *= is_better ? 0.3 : 10.0;
      if (is_better) {
        const bool is_small = cost(next) > (1.0 - 1e-6) * cost(tuned);
        tuned = std::move(next);
        if (is_small) {
          break;
        }
      }
    }
    Normal normal(tuned.values.size());
    left_by(tuned, hats, &normal);
    Eigen::MatrixXd whole = normal.matrix + stiffness;
    whole.diagonal().array() += 1e-12 * normal.matrix.diagonal().maxCoeff();
    const double effective = whole.ldlt().solve(normal.matrix).trace();
    tuned.bic = samples * std::log(tuned.left) + effective * std::log(samples);
  }

  Sampled sampled(const FormRegression& regression, std::size_t e) const {
    const Eigen::VectorXd& signal = regression.signal()[e];
    const Eigen::MatrixXd& quantities = regression.quantities()[e];
    const double rows_apart = period_ / regression.problem().data.experiments[e].period;
    const auto count = static_cast<Eigen::Index>(static_cast<double>(signal.size() - 1) / rows_apart);
    Sampled record{Eigen::VectorXd(count), Eigen::MatrixXd(count, quantities.cols())};
    for (Eigen::Index i = 0; i < count; ++i) {
      const double at = static_cast<double>(i) * rows_apart;
      const auto row = static_cast<Eigen::Index>(at);
      const double share = at - static_cast<double>(row);
      record.signal(i) = (1.0 - share) * signal(row) + share * signal(row + 1);
      record.quantities.row(i) = (1.0 - share) * quantities.row(row) + share * quantities.row(row + 1);
    }
    record.signal.array() -= count > 0 ? record.signal.mean() : 0.0;
    return record;
  }

  static double bent(double place, double bend) { return std::clamp(place / bend, -1.0, 1.0); }

  std::vector<double> sorted_values(Argument argument) const {
    std::vector<double> values;
    for (const Sampled& record : records_) {
      const auto column = record.quantities.col(static_cast<Eigen::Index>(argument));
      values.insert(values.end(), column.begin(), column.end());
    }
    std::ranges::sort(values);
    return values;
  }

  /// Middle of a quantity's values and their 99th percentile about it.
  std::pair<double, double> extent(Argument argument) const {
    const std::vector<double> values = sorted_values(argument);
    if (values.empty()) {
      return {0.0, 0.0};
    }
    const double low = quantile(values, 0.01);
    const double high = quantile(values, 0.99);
    return {0.5 * (low + high), 0.5 * (high - low)};
  }

  /// By record: integral over time [s] of the bent quantity.
  std::vector<Eigen::VectorXd> integrals(Argument argument, double middle, double size, double bend) const {
    std::vector<Eigen::VectorXd> all;
    for (const Sampled& record : records_) {
      Eigen::VectorXd& sum = all.emplace_back(record.signal.size());
      double so_far = 0.0;
      for (Eigen::Index i = 0; i < sum.size(); ++i) {
        const double own = bent((record.quantities(i, static_cast<Eigen::Index>(argument)) - middle) / size, bend);
        sum(i) = so_far + 0.5 * period_ * own;
        so_far += period_ * own;
      }
    }
    return all;
  }

  /// By record: integrals over time of a curve's hats, a column a point.
  std::vector<Eigen::MatrixXd> hat_integrals(Argument argument, const std::vector<double>& points) const {
    std::vector<Eigen::MatrixXd> all;
    const auto count = static_cast<Eigen::Index>(points.size());
    for (const Sampled& record : records_) {
      Eigen::MatrixXd& sum = all.emplace_back(record.signal.size(), count);
      Eigen::RowVectorXd so_far = Eigen::RowVectorXd::Zero(count);
      for (Eigen::Index i = 0; i < sum.rows(); ++i) {
        Eigen::RowVectorXd own = Eigen::RowVectorXd::Zero(count);
        add_hats(points, record.quantities(i, static_cast<Eigen::Index>(argument)), own);
        sum.row(i) = so_far + 0.5 * period_ * own;
        so_far += period_ * own;
      }
    }
    return all;
  }

  /// The signal demodulated by one tuning after the other and transformed. The transform is linear: that of the sum over the
  /// records is the sum of theirs. A step of the tuning turns a sample by an angle of its own, the same at every step.
  Peak strongest_of_bend(Argument argument, double bend, const std::vector<Eigen::VectorXd>& turns, int tunings) const {
    Peak best;
    best.argument = argument;
    best.bend = bend;
    const double step = most_tuned_ / tunings;
    std::vector<Eigen::VectorXcd> demodulated;
    std::vector<Eigen::VectorXcd> turned;
    for (std::size_t e = 0; e < records_.size(); ++e) {
      demodulated.emplace_back(records_[e].signal);
      turned.emplace_back(turns[e].unaryExpr([&](double own) { return std::polar(1.0, -kOscillationTurn * step * own); }));
    }
    Eigen::FFT<double> transform;
    Eigen::VectorXcd sum(length_);
    Eigen::VectorXcd spectrum(length_);
    for (int k = 0; k <= tunings; ++k) {
      sum.setZero();
      for (std::size_t e = 0; e < demodulated.size(); ++e) {
        sum.head(demodulated[e].size()) += demodulated[e];
        demodulated[e] = demodulated[e].cwiseProduct(turned[e]);
      }
      transform.fwd(spectrum, sum);
      take_peaks(spectrum, step * k, best);
    }
    return best;
  }

  /// Positive frequencies are of the tuning, negative ones of its opposite, because the signal is real.
  void take_peaks(const Eigen::VectorXcd& spectrum, double tuning, Peak& best) const {
    const double bin = 1.0 / (static_cast<double>(length_) * period_);
    const auto first = static_cast<Eigen::Index>(std::ceil(slowest_ / bin));
    const auto last = std::min((length_ - 1) / 2, static_cast<Eigen::Index>(fastest_ / bin));
    for (Eigen::Index k = first; k <= last; ++k) {
      for (const bool is_opposite : {false, true}) {
        const double power = std::norm(spectrum(is_opposite ? length_ - k : k));
        if (power > best.power) {
          best.frequency = static_cast<double>(k) * bin;
          best.tuning = is_opposite ? -tuning : tuning;
          best.power = power;
        }
      }
    }
  }

  /// Sum of squares that the best amplitude and phase leave, and the normal equations of the curve's values.
  double left_by(const Tuned& tuned, const std::vector<Eigen::MatrixXd>& hats, Normal* normal) const {
    const Eigen::VectorXd values =
        Eigen::Map<const Eigen::VectorXd>(tuned.values.data(), std::ssize(tuned.values)).array() + tuned.peak.frequency;
    std::vector<Eigen::Matrix<double, Eigen::Dynamic, 2>> waves;  // sine and cosine
    Eigen::Matrix2d own = Eigen::Matrix2d::Zero();
    Eigen::Vector2d with_signal = Eigen::Vector2d::Zero();
    double square = 0.0;
    for (std::size_t e = 0; e < records_.size(); ++e) {
      const Eigen::ArrayXd turns = kOscillationTurn * (hats[e] * values).array();
      const Eigen::VectorXd& signal = records_[e].signal;
      auto& wave = waves.emplace_back(turns.size(), 2);
      wave << turns.sin(), turns.cos();
      own += wave.transpose() * wave;
      with_signal += wave.transpose() * signal;
      square += signal.squaredNorm();
    }
    const Eigen::Vector2d amplitude = own.ldlt().solve(with_signal);
    if (normal != nullptr) {
      for (std::size_t e = 0; e < records_.size(); ++e) {
        const Eigen::VectorXd slope = kOscillationTurn * (amplitude(0) * waves[e].col(1) - amplitude(1) * waves[e].col(0));
        const Eigen::MatrixXd by_value = slope.asDiagonal() * hats[e];
        normal->matrix += by_value.transpose() * by_value;
        normal->right += by_value.transpose() * (records_[e].signal - waves[e] * amplitude);
      }
    }
    return std::max(square - with_signal.dot(amplitude), kLeastLeft * square);
  }

  double slowest_ = 0.0;
  double fastest_ = 0.0;
  double most_tuned_ = 0.0;
  double period_ = 0.0;
  std::vector<Sampled> records_;
  Eigen::Index length_ = 0;
};

}  // namespace

std::vector<Form> find_oscillations(const FormRegression& regression, const LatentPlace& place, unsigned threads) {
  const OscillationSearch search(regression);
  std::vector<std::vector<Peak>> peaks(model::kArgumentNames.size());
  parallel_for(peaks.size(), threads, [&](std::size_t a) { peaks[a] = search.strongest(static_cast<Argument>(a)); });
  std::erase_if(peaks, [](const std::vector<Peak>& of_quantity) { return of_quantity.empty(); });
  const auto power = [](const std::vector<Peak>& of_quantity) {
    return std::ranges::max(of_quantity, {}, &Peak::power).power;
  };
  std::ranges::stable_sort(peaks, std::greater<>(), power);
  peaks.resize(std::min(peaks.size(), kFittedOscillations));
  std::vector<Tuned> fitted(peaks.size());
  parallel_for(peaks.size(), threads, [&](std::size_t i) {
    for (const Peak& peak : peaks[i]) {
      Tuned tuned = search.tuned(peak);
      if (tuned.bic < fitted[i].bic) {
        fitted[i] = std::move(tuned);
      }
    }
  });
  std::vector<Form> forms;
  for (const Tuned& tuned : fitted) {
    if (tuned.points.empty()) {
      continue;
    }
    Form form = at_place(place, tuned.peak.argument);
    form.memory.kind = model::Memory::oscillator;
    form.memory.frequency = tuned.peak.frequency;
    form.points = tuned.points;
    form.values = tuned.values;
    forms.push_back(std::move(form));
  }
  return forms;
}

}  // namespace hotfire::explain
