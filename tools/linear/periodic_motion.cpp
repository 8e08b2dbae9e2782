// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/periodic_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kDifference = 1e-5;  ///< relative: of a signal by which its slopes are found

/// Adds to the mean, or to the real or imaginary part of a harmonic, of a wave, in the order of a port's parts.
void add_to_part(Wave& wave, Index part, double size) {
  if (part == 0) {
    wave.mean += size;
  } else {
    wave.harmonics[static_cast<std::size_t>((part - 1) / 2)] += part % 2 == 1 ? Complex(size) : Complex(0.0, size);
  }
}

Wave& wave_of(AxisWaves& axis, Index row) {
  return row == kSlipRow ? axis.slip : row == kAttachRow ? axis.attach : axis.states[static_cast<std::size_t>(row)];
}

/// Factor of a delay of a quantity.
Complex late(const Plant& plant, const Quantity& signal, double frequency) {
  Complex turn{1.0};
  for (const Delay& delay : plant.delays()) {
    turn *= delay.name == signal.name ? delay_factor(frequency, delay.seconds) : Complex(1.0);
  }
  return turn;
}

}  // namespace

PeriodicMotion::PeriodicMotion(const HarmonicBalance& system, double frequency, int harmonics,
                               const std::vector<Complex>& commands)
    : system_(system), frequency_(frequency), harmonics_(harmonics), parts_(1 + 2 * harmonics), commands_(commands) {
  for (int m = 1; m <= harmonics_; ++m) {
    answers_.push_back(system_.parts().answer_at(m * frequency));
  }
  // A command's own effects do not depend on how the axis moves.
  driven_.resize(commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    driven_[i].command.fundamental() = commands[i] * late(system_.plant(), system_.parts().map().inputs[i], frequency);
  }
  const std::vector<PortWaves> given = ports_under(driven_);
  for (std::size_t m = 0; m < answers_.size(); ++m) {
    VectorXcd acting(static_cast<Index>(given.size()));
    std::transform(given.begin(), given.end(), acting.begin(),
                   [&](const PortWaves& own) { return own.command.harmonics[m]; });
    acting_.push_back(acting);
  }
}

VectorXd PeriodicMotion::signals_of(const std::vector<PortWaves>& ports) const {
  VectorXd signals(parts_ * this->ports());
  for (Index k = 0; k < this->ports(); ++k) {
    const auto [axis, port] = system_.parts().ports()[static_cast<std::size_t>(k)];
    const Wave& wave = ports[static_cast<std::size_t>(axis)].ports[static_cast<std::size_t>(port)];
    signals(parts_ * k) = wave.mean;
    for (Index m = 0; m < harmonics_; ++m) {
      const Complex& own = wave.harmonics[static_cast<std::size_t>(m)];
      signals.segment<2>(parts_ * k + 1 + 2 * m) << own.real(), own.imag();
    }
  }
  return signals;
}

Balance PeriodicMotion::balance(const VectorXd& signals) const {
  Balance balance;
  balance.frequency = frequency_;
  balance.harmonics = harmonics_;
  balance.commands = commands_;
  balance.axes = motion(signals);
  balance.ports = ports_under(balance.axes);
  const VectorXcd read = answers_[0].output_by_command * acting_[0] + answers_[0].output_by_port * harmonic_of(signals, 1);
  balance.outputs.assign(read.begin(), read.end());
  for (std::size_t i = 0; i < balance.outputs.size(); ++i) {
    balance.outputs[i] *= late(system_.plant(), system_.parts().map().outputs[i], frequency_);
  }
  return balance;
}

VectorXcd PeriodicMotion::harmonic_of(const VectorXd& signals, Index m) const {
  VectorXcd own(ports());
  for (Index k = 0; k < ports(); ++k) {
    own(k) = Complex(signals(parts_ * k + 2 * m - 1), signals(parts_ * k + 2 * m));
  }
  return own;
}

/// How the linear parts move under the port signals.
std::vector<AxisWaves> PeriodicMotion::motion(const VectorXd& signals) const {
  std::vector<AxisWaves> axes = driven_;
  const auto put = [&](auto&& set, const auto& rows) {
    for (Index place = 0; place < rows.size(); ++place) {
      set(wave_of(axes[static_cast<std::size_t>(place / kMotionRows)], place % kMotionRows), rows(place));
    }
  };
  VectorXd means(ports());
  for (Index k = 0; k < ports(); ++k) {
    means(k) = signals(parts_ * k);
  }
  put([](Wave& wave, double value) { wave.mean = value; }, VectorXd(system_.motion_at_rest() * means));
  for (std::size_t m = 0; m < answers_.size(); ++m) {
    const VectorXcd rows = answers_[m].motion_by_command * acting_[m] +
                           answers_[m].motion_by_port * harmonic_of(signals, static_cast<Index>(m) + 1);
    put([m](Wave& wave, Complex value) { wave.harmonics[m] = value; }, rows);
  }
  return axes;
}

/// The slopes at one point.
class PeriodicMotion::Slopes {
 public:
  Slopes(const PeriodicMotion& waves, const VectorXd& signals, const std::vector<Index>& unknowns, const VectorXd& scale)
      : waves_(waves),
        unknowns_(unknowns),
        scale_(scale),
        signals_(signals),
        at_(waves.motion(signals)),
        found_(waves.signals_of(waves.ports_under(at_))),
        slopes_(-MatrixXd::Identity(static_cast<Index>(unknowns.size()), static_cast<Index>(unknowns.size()))) {}

  MatrixXd find() {
    std::vector<Index> parts;
    std::transform(unknowns_.begin(), unknowns_.end(), std::back_inserter(parts),
                   [this](Index unknown) { return unknown % waves_.parts_; });
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    constexpr std::size_t kCrossing = 2;  // rows that need a turn for each axis of an engine
    if (unknowns_.size() < (kMotionRows + kCrossing) * parts.size()) {
      by_unknowns();
      return slopes_;
    }
    for (Index row = 0; row < kMotionRows; ++row) {
      const bool crosses = at_.size() > 1 && (row == model::AxisStates::kAngle || row == kSlipRow);
      const Index stride = crosses ? 2 : 1;
      for (const Index part : parts) {
        for (Index first = 0; first < stride; ++first) {
          by_motion(row, part, first, stride);
        }
      }
    }
    return slopes_;
  }

 private:
  /// By how much one part of one motion row moves with each unknown of its harmonic.
  struct Movers {
    std::vector<Index> columns{};
    VectorXd moves{};
  };

  VectorXd change_to(const VectorXd& found) const { return (found - found_)(unknowns_).cwiseQuotient(scale_(unknowns_)); }

  void by_unknowns() {
    for (Index k = 0; k < slopes_.cols(); ++k) {
      const Index unknown = unknowns_[static_cast<std::size_t>(k)];
      VectorXd moved = signals_;
      moved(unknown) += kDifference * scale_(unknown);
      slopes_.col(k) += change_to(waves_.respond(moved)) / kDifference;
    }
  }

  /// What a change of `part` of `row` of every axis from `first` on in steps of `stride` does to the signals: of each axis
  /// to its own and, with a stride of two, to those of the other axis of its engine.
  void by_motion(Index row, Index part, Index first, Index stride) {
    const auto count = static_cast<Index>(at_.size());
    std::vector<AxisWaves> moved = at_;
    std::vector<Movers> movers(at_.size());
    for (Index axis = first; axis < count; axis += stride) {
      Movers& own = movers[static_cast<std::size_t>(axis)];
      own = movers_of(axis * kMotionRows + row, part);
      const double size = kDifference * own.moves.lpNorm<Eigen::Infinity>();
      own.moves = size > 0.0 ? VectorXd(own.moves / size) : own.moves;
      add_to_part(wave_of(moved[static_cast<std::size_t>(axis)], row), part, size);
    }
    const VectorXd change = change_to(waves_.signals_of(waves_.ports_under(moved)));
    for (Index axis = first; axis < count; axis += stride) {
      const Movers& own = movers[static_cast<std::size_t>(axis)];
      const Index group = axis - axis % stride;
      for (Index other = group; other < group + stride; ++other) {
        const std::vector<Index> rows = rows_of(other);
        slopes_(rows, own.columns) += change(rows) * own.moves.transpose();
      }
    }
  }

  Movers movers_of(Index place, Index part) const {
    const Index harmonic = (part + 1) / 2;
    Movers movers;
    std::vector<double> moves;
    for (std::size_t j = 0; j < unknowns_.size(); ++j) {
      const Index port = unknowns_[j] / waves_.parts_;
      const Index own = unknowns_[j] % waves_.parts_;
      if ((own + 1) / 2 == harmonic) {
        movers.columns.push_back(static_cast<Index>(j));
        moves.push_back(scale_(unknowns_[j]) * (harmonic == 0 ? waves_.system_.motion_at_rest()(place, port)
                                                              : move_of(place, port, harmonic, own, part)));
      }
    }
    movers.moves = Eigen::Map<const VectorXd>(moves.data(), static_cast<Index>(moves.size()));
    return movers;
  }

  /// By how much `part` of a motion row moves with part `own` of a port.
  double move_of(Index place, Index port, Index harmonic, Index own, Index part) const {
    const Complex answer = waves_.answers_[static_cast<std::size_t>(harmonic) - 1].motion_by_port(place, port);
    const Complex moved = own % 2 == 1 ? answer : Complex(0.0, 1.0) * answer;
    return part % 2 == 1 ? moved.real() : moved.imag();
  }

  /// The unknowns at the ports of an axis.
  std::vector<Index> rows_of(Index axis) const {
    std::vector<Index> rows;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const auto port = static_cast<std::size_t>(unknowns_[i] / waves_.parts_);
      if (waves_.system_.parts().ports()[port][0] == axis) {
        rows.push_back(static_cast<Index>(i));
      }
    }
    return rows;
  }

  const PeriodicMotion& waves_;
  const std::vector<Index>& unknowns_;
  const VectorXd& scale_;
  VectorXd signals_;
  std::vector<AxisWaves> at_;
  VectorXd found_;
  MatrixXd slopes_;
};

MatrixXd PeriodicMotion::slopes(const VectorXd& signals, const std::vector<Index>& unknowns, const VectorXd& scale) const {
  return Slopes(*this, signals, unknowns, scale).find();
}

}  // namespace hotfire::linear
