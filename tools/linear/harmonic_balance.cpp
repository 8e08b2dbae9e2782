// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/harmonic_balance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/linear/periodic_motion.hpp"

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// True for a part that is zero in a motion whose second half is the first with the other sign: mean and even harmonics.
bool is_even(Index part) { return part == 0 || ((part + 1) / 2) % 2 == 0; }

/// The search for port signals that the laws give back: Newton's method on found(x) - x = 0, the inverse of its matrix by
/// differences and kept up by Broyden's formula [Broyden 1965, Math. Comp. 19]. An unknown is a part of a port's signal over
/// its size.
class Search {
 public:
  explicit Search(const PeriodicMotion& waves) : waves_(waves), parts_(waves.parts()), ports_(waves.ports()) {}

  std::optional<Balance> find(const Balance* near) {
    start(near);
    for (const bool symmetric : {true, false}) {
      choose_unknowns(symmetric);
      iterate();
      all_ = all_of(x_);
      Balance balance = waves_.balance(all_);
      found_ = waves_.signals_of(balance.ports);
      if (size() < HarmonicBalance::kBalanced && unchosen() < HarmonicBalance::kBalanced) {
        if (inverse_.rows() == x_.size()) {
          balance.slopes = std::make_shared<const SearchSlopes>(SearchSlopes{parts_, scale_, unknowns_, inverse_});
        }
        return balance;
      }
    }
    return {};
  }

 private:
  static constexpr double kDone = 1e-6;
  static constexpr double kAlike = 10.0;  ///< a factor between sizes of signals nearby
  static constexpr double kLeast = 1e-3;  ///< of the largest signal of a kind: less does nothing to the others

  double size() const { return rest_.size() > 0 ? rest_.lpNorm<Eigen::Infinity>() : 0.0; }

  /// The signals where the search starts, and their sizes.
  void start(const Balance* near) {
    all_ = near != nullptr ? waves_.signals_of(near->ports) : waves_.respond(VectorXd::Zero(parts_ * ports_));
    found_ = waves_.respond(all_);
    if (near != nullptr && near->harmonics < waves_.harmonics()) {
      // What the laws make of fewer harmonics.
      for (Index k = 0; k < ports_; ++k) {
        const Index more = 2 * (waves_.harmonics() - near->harmonics);
        all_.segment(parts_ * (k + 1) - more, more) = found_.segment(parts_ * (k + 1) - more, more);
      }
    }
    scale_ = VectorXd::Zero(parts_ * ports_);
    const auto size_of = [this](const VectorXd& signals, Index port) {
      return signals.segment(parts_ * port, parts_).lpNorm<Eigen::Infinity>();
    };
    // A port of an axis that hardly moves counts by what those of its kind do.
    std::array<double, kAxisPorts> largest{};
    for (const bool first : {true, false}) {
      for (Index k = 0; k < ports_; ++k) {
        double& most = largest[static_cast<std::size_t>(waves_.kind_of(k))];
        const double own = std::max({size_of(all_, k), size_of(found_, k), first ? 0.0 : kLeast * most});
        most = std::max(most, own);
        scale_.segment(parts_ * k, parts_).setConstant(own);
      }
    }
    bool alike = near != nullptr && near->slopes;
    for (Index k = 0; k < ports_ && alike; ++k) {
      const double own = scale_(parts_ * k);
      const double nearby = near->slopes->scale(near->slopes->parts * k);
      alike = own <= kAlike * nearby && nearby <= kAlike * own;
    }
    nearby_ = alike ? near->slopes : nullptr;
    if (alike) {
      for (Index k = 0; k < ports_; ++k) {
        scale_.segment(parts_ * k, parts_).setConstant(nearby_->scale(nearby_->parts * k));
      }
    }
  }

  /// The unknowns: parts of ports that carry a signal, without those that are zero in a symmetric motion.
  void choose_unknowns(bool symmetric) {
    unknowns_.clear();
    for (Index i = 0; i < all_.size(); ++i) {
      if (scale_(i) > 0.0 && !(symmetric && is_even(i % parts_))) {
        unknowns_.push_back(i);
      } else {
        all_(i) = 0.0;
      }
    }
    x_ = all_(unknowns_).cwiseQuotient(scale_(unknowns_));
    rest_ = evaluate(x_) - x_;
    inverse_ = nearby_ ? inverse_nearby() : MatrixXd();
  }

  /// The inverse nearby for the unknowns of this search. A part that is no unknown there is taken as one that no law
  /// follows.
  MatrixXd inverse_nearby() const {
    const auto& theirs = nearby_->unknowns;
    std::vector<Index> own;
    std::vector<Index> other;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const Index part = unknowns_[i] % parts_;
      const Index place = unknowns_[i] / parts_ * nearby_->parts + part;
      const auto found = std::lower_bound(theirs.begin(), theirs.end(), place);
      if (part < nearby_->parts && found != theirs.end() && *found == place) {
        own.push_back(static_cast<Index>(i));
        other.push_back(found - theirs.begin());
      }
    }
    MatrixXd inverse = -MatrixXd::Identity(x_.size(), x_.size());
    inverse(own, own) = nearby_->inverse(other, other);
    return inverse;
  }

  /// The largest part among those that are no unknowns.
  double unchosen() const {
    double largest = 0.0;
    std::size_t next = 0;
    for (Index i = 0; i < found_.size(); ++i) {
      if (next < unknowns_.size() && unknowns_[next] == i) {
        ++next;
      } else if (scale_(i) > 0.0) {
        largest = std::max(largest, std::abs(found_(i)) / scale_(i));
      }
    }
    return largest;
  }

  void differentiate() { inverse_ = waves_.slopes(all_of(x_), unknowns_, scale_).partialPivLu().inverse(); }

  void iterate() {
    constexpr int kMatrices = 12;
    for (int matrix = 0; matrix < kMatrices && size() > kDone; ++matrix) {
      const bool own = inverse_.rows() != x_.size();
      if (own) {
        differentiate();
      }
      if (!descend() && own) {
        break;
      }
      if (size() > kDone) {
        inverse_.resize(0, 0);
      }
    }
  }

  /// Steps with one matrix while they help. False if not even the first does.
  bool descend() {
    constexpr int kSteps = 60;
    constexpr int kPatience = 5;  // steps within which the disagreement has to fall to half
    constexpr double kShortest = 1e-3;
    double before = rest_.norm();
    for (int step = 0; step < kSteps && size() > kDone; ++step) {
      const VectorXd change = -(inverse_ * rest_);
      double share = 1.0;
      VectorXd next = x_ + change;
      VectorXd next_rest = evaluate(next) - next;
      while (!(next_rest.norm() < rest_.norm()) && share > kShortest) {
        share *= 0.5;
        next = x_ + share * change;
        next_rest = evaluate(next) - next;
      }
      if (!(next_rest.norm() < rest_.norm())) {
        return step > 0;
      }
      const VectorXd moved = next - x_;
      const VectorXd turned = inverse_ * (next_rest - rest_);
      const double along = moved.dot(turned);
      if (std::abs(along) > 0.0) {
        const Eigen::RowVectorXd row = moved.transpose() * inverse_ / along;
        inverse_ += (moved - turned) * row;
      }
      x_ = next;
      rest_ = next_rest;
      if ((step + 1) % kPatience == 0) {
        if (rest_.norm() > 0.5 * before) {
          return true;
        }
        before = rest_.norm();
      }
    }
    return true;
  }

  /// What the laws give for the unknowns, as parts of them.
  VectorXd evaluate(const VectorXd& scaled) {
    all_ = all_of(scaled);
    found_ = waves_.respond(all_);
    return found_(unknowns_).cwiseQuotient(scale_(unknowns_));
  }

  VectorXd all_of(const VectorXd& scaled) const {
    VectorXd all = VectorXd::Zero(parts_ * ports_);
    all(unknowns_) = scaled.cwiseProduct(scale_(unknowns_));
    return all;
  }

  const PeriodicMotion& waves_;
  Index parts_;
  Index ports_;
  std::vector<Index> unknowns_{};  ///< among the parts of all signals
  VectorXd all_{};                 ///< signals that are tried
  VectorXd found_{};               ///< what the laws give for them
  VectorXd scale_{};
  VectorXd x_{};
  VectorXd rest_{};
  std::shared_ptr<const SearchSlopes> nearby_{};
  MatrixXd inverse_{};
};

}  // namespace

HarmonicBalance::HarmonicBalance(const Plant& plant) : plant_(plant), parts_(plant), at_rest_(parts_.motion_at_rest()) {}

std::optional<Balance> HarmonicBalance::solve(double frequency, const std::vector<Complex>& commands,
                                              const Balance* near) const {
  const int harmonics = plant_.harmonics(frequency);
  const auto find = [&](int own, const Balance* start) { return Search({*this, frequency, own, commands}).find(start); };
  if (near != nullptr && near->harmonics == harmonics) {
    if (std::optional<Balance> found = find(harmonics, near)) {
      return found;
    }
  }
  std::optional<Balance> few = find(kFewestHarmonics, near);
  if (harmonics == kFewestHarmonics) {
    return few;
  }
  return find(harmonics, few ? &*few : near);
}

Complex delay_factor(double frequency, double delay) { return std::polar(1.0, -2.0 * std::numbers::pi * frequency * delay); }

Complex hold_factor(double frequency, double period, double step) {
  const int steps = static_cast<int>(std::lround(period / step));
  Complex sum{0.0};
  for (int k = 0; k < steps; ++k) {
    sum += delay_factor(frequency, step * (k + 0.5));
  }
  return sum / static_cast<double>(steps);
}

}  // namespace hotfire::linear
