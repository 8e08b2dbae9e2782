// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/oscillation_search.hpp"

#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

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
/// Shares of a quantity's size beyond which the frequency no longer moves: a straight line, and one that saturates.
constexpr std::array kBends{1.0, 0.3};
/// Quantities whose oscillation is fitted, and points of its curve.
constexpr std::size_t kFittedOscillations = 3;
constexpr int kTuningPoints = 7;
constexpr int kTuningSteps = 30;

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
    Eigen::Index longest = 0;
    for (std::size_t e = 0; e < regression.quantities().size(); ++e) {
      records_.push_back(sampled(regression, e));
      longest = std::max(longest, records_.back().signal.size());
    }
    length_ = static_cast<Eigen::Index>(2 * std::bit_ceil(static_cast<std::size_t>(std::max<Eigen::Index>(longest, 8))));
  }

  /// The strongest oscillation that a quantity tunes; of no power if the quantity does not move.
  Peak strongest(Argument argument) const {
    Peak best;
    best.argument = argument;
    const auto [middle, size] = extent(argument);
    if (!(size > 0.0)) {
      return best;
    }
    for (const double bend : kBends) {
      const std::vector<Eigen::VectorXd> turns = integrals(argument, middle, size, bend);
      double range = 0.0;
      for (const Eigen::VectorXd& of_record : turns) {
        range = std::max(range, of_record.size() > 0 ? of_record.maxCoeff() - of_record.minCoeff() : 0.0);
      }
      const int tunings = std::clamp(static_cast<int>(most_tuned_ * range / kTunedApart), 1, kMostTunings);
      for (int k = 0; k <= tunings; ++k) {
        take_peaks(turns, bend, most_tuned_ * k / tunings, best);
      }
    }
    return best;
  }

  /// The curve over the peak's quantity with which an oscillation explains most of the signal.
  Tuned tuned(const Peak& peak) const {
    const auto [middle, size] = extent(peak.argument);
    Tuned result{peak, {}, {}};
    for (int k = 0; k < kTuningPoints; ++k) {
      const double place = 2.0 * k / (kTuningPoints - 1.0) - 1.0;
      result.points.push_back(middle + size * place);
      result.values.push_back(peak.tuning * bent(place, peak.bend));
    }
    const std::vector<Eigen::MatrixXd> hats = hat_integrals(peak.argument, result.points);
    double damping = 1e-3;
    result.left = left_by(result, hats, nullptr);
    for (int step = 0; step < kTuningSteps; ++step) {
      Normal normal;
      left_by(result, hats, &normal);
      Eigen::MatrixXd damped = normal.matrix;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-12 * normal.matrix.diagonal().maxCoeff();
      const Eigen::VectorXd move = damped.ldlt().solve(normal.right);
      Tuned next = result;
      for (int k = 0; k < kTuningPoints; ++k) {
        next.values[static_cast<std::size_t>(k)] += move(k);
      }
      next.left = left_by(next, hats, nullptr);
      const bool is_better = next.left < result.left;
      damping *= is_better ? 0.3 : 10.0;
      if (is_better) {
        const bool is_small = next.left > (1.0 - 1e-6) * result.left;
        result = std::move(next);
        if (is_small) {
          break;
        }
      }
    }
    return result;
  }

 private:
  struct Normal {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kTuningPoints, kTuningPoints);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kTuningPoints);
  };

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

  /// Middle of a quantity's values and their 99th percentile about it.
  std::pair<double, double> extent(Argument argument) const {
    std::vector<double> values;
    for (const Sampled& record : records_) {
      const auto column = record.quantities.col(static_cast<Eigen::Index>(argument));
      values.insert(values.end(), column.begin(), column.end());
    }
    if (values.empty()) {
      return {0.0, 0.0};
    }
    const double low = quantile_of_unsorted(values, 0.01);
    const double high = quantile_of_unsorted(values, 0.99);
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

  /// The signal demodulated by a tuning and transformed: positive frequencies are of that tuning, negative ones of its
  /// opposite, because the signal is real.
  void take_peaks(const std::vector<Eigen::VectorXd>& turns, double bend, double tuning, Peak& best) const {
    Eigen::VectorXcd demodulated(length_);
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(length_);
    Eigen::VectorXcd of_record(length_);
    Eigen::FFT<double> transform;
    for (std::size_t e = 0; e < records_.size(); ++e) {
      demodulated.setZero();
      for (Eigen::Index i = 0; i < turns[e].size(); ++i) {
        demodulated(i) = records_[e].signal(i) * std::polar(1.0, -kOscillationTurn * tuning * turns[e](i));
      }
      transform.fwd(of_record, demodulated);
      sum += of_record;
    }
    const double bin = 1.0 / (static_cast<double>(length_) * period_);
    const auto first = static_cast<Eigen::Index>(std::ceil(slowest_ / bin));
    const auto last = std::min(length_ / 2 - 1, static_cast<Eigen::Index>(fastest_ / bin));
    for (Eigen::Index k = first; k <= last; ++k) {
      for (const bool is_opposite : {false, true}) {
        const double power = std::norm(sum(is_opposite ? length_ - k : k));
        if (power > best.power) {
          best = {best.argument, bend, static_cast<double>(k) * bin, is_opposite ? -tuning : tuning, power};
        }
      }
    }
  }

  /// Sum of squares that the best amplitude and phase leave, and the normal equations of the curve's values.
  double left_by(const Tuned& tuned, const std::vector<Eigen::MatrixXd>& hats, Normal* normal) const {
    const Eigen::VectorXd values =
        Eigen::Map<const Eigen::VectorXd>(tuned.values.data(), kTuningPoints).array() + tuned.peak.frequency;
    std::vector<Eigen::VectorXcd> waves;
    Eigen::Matrix2d own = Eigen::Matrix2d::Zero();
    Eigen::Vector2d with_signal = Eigen::Vector2d::Zero();
    double square = 0.0;
    for (std::size_t e = 0; e < records_.size(); ++e) {
      const Eigen::VectorXd turns = hats[e] * values;
      const Eigen::VectorXcd wave = turns.unaryExpr([](double turn) { return std::polar(1.0, kOscillationTurn * turn); });
      const Eigen::VectorXd& signal = records_[e].signal;
      Eigen::Matrix<double, Eigen::Dynamic, 2> both(wave.size(), 2);
      both << wave.imag(), wave.real();
      own += both.transpose() * both;
      with_signal += both.transpose() * signal;
      square += signal.squaredNorm();
      waves.push_back(wave);
    }
    const Eigen::Vector2d amplitude = own.ldlt().solve(with_signal);
    if (normal != nullptr) {
      for (std::size_t e = 0; e < records_.size(); ++e) {
        const Eigen::VectorXd modelled = amplitude(0) * waves[e].imag() + amplitude(1) * waves[e].real();
        const Eigen::VectorXd slope = kOscillationTurn * (amplitude(0) * waves[e].real() - amplitude(1) * waves[e].imag());
        const Eigen::MatrixXd by_value = slope.asDiagonal() * hats[e];
        normal->matrix += by_value.transpose() * by_value;
        normal->right += by_value.transpose() * (records_[e].signal - modelled);
      }
    }
    return square - with_signal.dot(amplitude);
  }

  double slowest_ = 0.0;
  double fastest_ = 0.0;
  double most_tuned_ = 0.0;
  double period_ = 0.0;
  std::vector<Sampled> records_;
  Eigen::Index length_ = 0;
};

}  // namespace

std::optional<Form> find_oscillation(const FormRegression& regression, const LatentPlace& place, unsigned threads) {
  const OscillationSearch search(regression);
  std::vector<Peak> peaks(model::kArgumentNames.size());
  parallel_for(peaks.size(), threads, [&](std::size_t a) { peaks[a] = search.strongest(static_cast<Argument>(a)); });
  std::ranges::stable_sort(peaks, std::greater<>(), &Peak::power);
  std::erase_if(peaks, [](const Peak& peak) { return !(peak.power > 0.0); });
  peaks.resize(std::min(peaks.size(), kFittedOscillations));
  if (peaks.empty()) {
    return std::nullopt;
  }
  std::vector<Tuned> fitted(peaks.size());
  parallel_for(peaks.size(), threads, [&](std::size_t i) { fitted[i] = search.tuned(peaks[i]); });
  const Tuned& best = *std::ranges::min_element(fitted, {}, &Tuned::left);
  Form form = at_place(place, best.peak.argument);
  form.memory.kind = model::Memory::oscillator;
  form.memory.frequency = best.peak.frequency;
  form.points = best.points;
  form.values = best.values;
  return form;
}

}  // namespace hotfire::explain
