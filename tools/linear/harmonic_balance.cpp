// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/harmonic_balance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kParts = 1 + 2 * kHarmonics;  ///< of a port signal: mean, real and imaginary part of every harmonic

Complex turn_of(double frequency, double time) { return std::polar(1.0, 2.0 * std::numbers::pi * frequency * time); }

/// True for a part that is zero in a motion whose second half is the first with the other sign: mean and even harmonics.
bool is_even(Index part) { return part == 0 || ((part + 1) / 2) % 2 == 0; }

/// Factor of a delay of a quantity.
Complex late(const Plant& plant, const Quantity& signal, double frequency) {
  Complex turn{1.0};
  for (const Delay& delay : plant.delays()) {
    turn *= delay.name == signal.name ? turn_of(frequency, -delay.seconds) : Complex(1.0);
  }
  return turn;
}

}  // namespace

HarmonicBalance::HarmonicBalance(const Plant& plant) : plant_(plant), parts_(plant), at_rest_(parts_.motion_at_rest()) {}

/// The search for port signals that the laws give back: Newton's method on found(x) - x = 0, the inverse of its matrix by
/// differences and kept up by Broyden's formula [Broyden 1965, Math. Comp. 19]. An unknown is a part of a port's signal over
/// its size.
class HarmonicBalance::Search {
 public:
  Search(const HarmonicBalance& system, double frequency, const std::vector<Complex>& commands)
      : system_(system), ports_(static_cast<Index>(system.parts_.ports().size())) {
    balance_.frequency = frequency;
    balance_.commands = commands;
    for (int m = 1; m <= kHarmonics; ++m) {
      answers_.push_back(system_.parts_.answer_at(m * frequency));
    }
    // A command's own effects do not depend on how the axis moves.
    driven_.resize(commands.size());
    for (std::size_t i = 0; i < commands.size(); ++i) {
      driven_[i].command.fundamental() = commands[i] * late(system_.plant_, system_.parts_.map().inputs[i], frequency);
    }
    const std::vector<PortWaves> given = system_.plant_.respond(frequency, driven_);
    for (std::size_t m = 0; m < kHarmonics; ++m) {
      VectorXcd acting(static_cast<Index>(given.size()));
      std::transform(given.begin(), given.end(), acting.begin(),
                     [&](const PortWaves& own) { return own.command.harmonics[m]; });
      acting_.push_back(acting);
    }
  }

  std::optional<Balance> find(const Balance* near) {
    start(near);
    for (const bool symmetric : {true, false}) {
      choose_unknowns(symmetric);
      if (iterate() && unchosen() < kBalanced) {
        balance_.residual = rest_.lpNorm<Eigen::Infinity>();
        read_outputs();
        if (inverse_.rows() == x_.size()) {
          balance_.slopes = std::make_shared<const SearchSlopes>(SearchSlopes{scale_, unknowns_, inverse_});
        }
        return balance_;
      }
    }
    return {};
  }

 private:
  static constexpr double kDone = 1e-6;
  static constexpr double kAlike = 10.0;  ///< a factor between sizes of signals nearby
  static constexpr double kLeast = 1e-3;  ///< of the largest signal of a kind: less does nothing to the others

  double size() const { return rest_.size() > 0 ? rest_.lpNorm<Eigen::Infinity>() : 0.0; }

  VectorXd signals_of(const std::vector<PortWaves>& ports) const {
    VectorXd found(kParts * ports_);
    for (Index k = 0; k < ports_; ++k) {
      const auto [axis, port] = system_.parts_.ports()[static_cast<std::size_t>(k)];
      const Wave& wave = ports[static_cast<std::size_t>(axis)].ports[static_cast<std::size_t>(port)];
      found(kParts * k) = wave.mean;
      for (Index m = 0; m < kHarmonics; ++m) {
        const Complex& own = wave.harmonics[static_cast<std::size_t>(m)];
        found.segment<2>(kParts * k + 1 + 2 * m) << own.real(), own.imag();
      }
    }
    return found;
  }

  /// The signals where the search starts, and their sizes.
  void start(const Balance* near) {
    all_ = near != nullptr ? signals_of(near->ports) : respond(VectorXd::Zero(kParts * ports_));
    found_ = respond(all_);
    scale_ = VectorXd::Zero(kParts * ports_);
    const auto size_of = [](const VectorXd& signals, Index port) {
      return signals.segment<kParts>(kParts * port).lpNorm<Eigen::Infinity>();
    };
    // A port of an axis that hardly moves counts by what those of its kind do.
    std::array<double, kAxisPorts> largest{};
    for (const bool first : {true, false}) {
      for (Index k = 0; k < ports_; ++k) {
        double& most = largest[static_cast<std::size_t>(system_.parts_.ports()[static_cast<std::size_t>(k)][1])];
        const double own = std::max({size_of(all_, k), size_of(found_, k), first ? 0.0 : kLeast * most});
        most = std::max(most, own);
        scale_.segment<kParts>(kParts * k).setConstant(own);
      }
    }
    bool alike = near != nullptr && near->slopes;
    for (Index k = 0; k < ports_ && alike; ++k) {
      const double own = scale_(kParts * k);
      const double nearby = near->slopes->scale(kParts * k);
      alike = own <= kAlike * nearby && nearby <= kAlike * own;
    }
    nearby_ = alike ? near->slopes : nullptr;
    if (alike) {
      scale_ = nearby_->scale;
    }
  }

  /// The unknowns: parts of ports that carry a signal, without those that are zero in a symmetric motion.
  void choose_unknowns(bool symmetric) {
    unknowns_.clear();
    for (Index i = 0; i < all_.size(); ++i) {
      if (scale_(i) > 0.0 && !(symmetric && is_even(i % kParts))) {
        unknowns_.push_back(i);
      } else {
        all_(i) = 0.0;
      }
    }
    x_ = all_(unknowns_).cwiseQuotient(scale_(unknowns_));
    rest_ = evaluate(x_) - x_;
    const bool known = nearby_ && nearby_->unknowns == unknowns_;
    inverse_ = known ? nearby_->inverse : MatrixXd();
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

  void differentiate() {
    constexpr double kDifference = 1e-5;
    MatrixXd slopes(x_.size(), x_.size());
    for (Index k = 0; k < x_.size(); ++k) {
      VectorXd moved = x_;
      moved(k) += kDifference;
      slopes.col(k) = (evaluate(moved) - moved - rest_) / kDifference;
    }
    inverse_ = slopes.partialPivLu().inverse();
  }

  /// True if it arrives.
  bool iterate() {
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
    return arrived();
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

  bool arrived() {
    evaluate(x_);
    return size() < kBalanced;
  }

  /// What the laws give for the unknowns, as parts of them.
  VectorXd evaluate(const VectorXd& scaled) {
    all_(unknowns_) = scaled.cwiseProduct(scale_(unknowns_));
    found_ = respond(all_);
    return found_(unknowns_).cwiseQuotient(scale_(unknowns_));
  }

  VectorXd respond(const VectorXd& given) {
    balance_.axes = motion(given);
    balance_.ports = system_.plant_.respond(balance_.frequency, balance_.axes);
    return signals_of(balance_.ports);
  }

  VectorXcd harmonic_of(const VectorXd& given, Index m) const {
    VectorXcd signals(ports_);
    for (Index k = 0; k < ports_; ++k) {
      signals(k) = Complex(given(kParts * k + 2 * m - 1), given(kParts * k + 2 * m));
    }
    return signals;
  }

  /// How the linear parts move under the port signals.
  std::vector<AxisWaves> motion(const VectorXd& given) const {
    std::vector<AxisWaves> axes = driven_;
    const auto put = [&](auto&& set, const auto& rows) {
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto first = static_cast<Index>(i) * kMotionRows;
        for (Index k = 0; k < 8; ++k) {
          set(axes[i].states[static_cast<std::size_t>(k)], rows(first + k));
        }
        set(axes[i].slip, rows(first + kSlipRow));
        set(axes[i].attach, rows(first + kAttachRow));
      }
    };
    VectorXd means(ports_);
    for (Index k = 0; k < ports_; ++k) {
      means(k) = given(kParts * k);
    }
    put([](Wave& wave, double value) { wave.mean = value; }, VectorXd(system_.at_rest_ * means));
    for (std::size_t m = 0; m < kHarmonics; ++m) {
      const VectorXcd rows = answers_[m].motion_by_command * acting_[m] +
                             answers_[m].motion_by_port * harmonic_of(given, static_cast<Index>(m) + 1);
      put([m](Wave& wave, Complex value) { wave.harmonics[m] = value; }, rows);
    }
    return axes;
  }

  void read_outputs() {
    const VectorXcd read = answers_[0].output_by_command * acting_[0] + answers_[0].output_by_port * harmonic_of(all_, 1);
    balance_.outputs.assign(read.begin(), read.end());
    for (std::size_t i = 0; i < balance_.outputs.size(); ++i) {
      balance_.outputs[i] *= late(system_.plant_, system_.parts_.map().outputs[i], balance_.frequency);
    }
  }

  const HarmonicBalance& system_;
  Index ports_;
  std::vector<Answer> answers_{};    ///< one a harmonic
  std::vector<AxisWaves> driven_{};  ///< the commands
  std::vector<VectorXcd> acting_{};  ///< commands behind the effects of their site, one a harmonic
  std::vector<Index> unknowns_{};    ///< among the parts of all signals
  VectorXd all_{};                   ///< signals that are tried
  VectorXd found_{};                 ///< what the laws give for them
  VectorXd scale_{};
  VectorXd x_{};
  VectorXd rest_{};
  std::shared_ptr<const SearchSlopes> nearby_{};
  MatrixXd inverse_{};
  Balance balance_{};
};

std::optional<Balance> HarmonicBalance::solve(double frequency, const std::vector<Complex>& commands,
                                              const Balance* near) const {
  return Search(*this, frequency, commands).find(near);
}

Complex hold_factor(double frequency, double period, double step) {
  const int steps = static_cast<int>(std::lround(period / step));
  Complex sum{0.0};
  for (int k = 0; k < steps; ++k) {
    sum += turn_of(frequency, -step * (k + 0.5));
  }
  return sum / static_cast<double>(steps);
}

}  // namespace hotfire::linear
