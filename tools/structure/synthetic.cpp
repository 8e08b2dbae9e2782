// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/synthetic.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "tools/structure/reduction.hpp"

namespace hotfire {

namespace {

/// The distributions of the standard library differ from one to the next: only its engine is used.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  /// Of either sign, sizes within a factor of three.
  double shape() {
    const double size = (*this)(0.5, 1.5);
    return size * ((*this)(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace

ModeSet synthetic_vehicle(unsigned seed, int count) {
  constexpr double kLowest = 1.0;
  constexpr double kHighest = 40.0;
  constexpr double kFlexibility = 1.0 / 1.05e8;
  // Of what an actuator hardly feels: a thousandth of the shapes, a millionth of the flexibility.
  constexpr double kRemote = 1e-3;
  constexpr double kRotation = 0.3;  // rad/m: a mount turns by less than its attach points move
  constexpr double kString = 0.5;    // the floor that carries the anchors moves by less than the attach points
  const auto size_of = [](const ModeSet& set, int k) { return set.frequency(k) * (k % 3 == 1 ? 1.0 : kRemote); };
  Uniform uniform(seed);
  ModeSet set;
  set.engines = kMostEngines;
  set.frequency.resize(count);
  set.damping_ratio.resize(count);
  set.shape.resize(set.ports(), count);
  set.residual = Eigen::MatrixXd::Zero(set.ports(), set.ports());
  for (int k = 0; k < count; ++k) {
    set.frequency(k) = kLowest + (kHighest - kLowest) * (k + uniform(0.1, 0.9)) / count;
    set.damping_ratio(k) = uniform(0.005, 0.015);
    // Equal shares of the static flexibility: a shape that grows with the frequency.
    const double size = size_of(set, k);
    for (int port = 0; port < set.ports(); ++port) {
      const double shape = size * uniform.shape();
      set.shape(port, k) = port < set.ports() / 2 ? shape : kRotation * shape;
    }
  }
  const Eigen::MatrixXd flexibility = static_flexibility(set);
  const int attach_points = set.ports() / 2;
  std::vector<double> scales;
  for (int port = 0; port < attach_points; ++port) {
    const double scale = std::sqrt(uniform(0.9, 1.1) * kFlexibility / flexibility(port, port));
    set.shape.row(port) *= scale;
    set.shape.row(attach_points + port) *= scale;
    scales.push_back(scale);
  }
  // Two strings along each of an engine's angles, from numbers of their own.
  Uniform of_strings(seed + 1);
  set.string_shape.resize(2 * attach_points, count);
  set.string_residual = Eigen::MatrixXd::Zero(2 * attach_points, set.ports());
  for (int string = 0; string < 2 * attach_points; ++string) {
    for (int k = 0; k < count; ++k) {
      set.string_shape(string, k) =
          kString * scales[static_cast<std::size_t>(string) / 2] * size_of(set, k) * of_strings.shape();
    }
  }
  return set;
}

}  // namespace hotfire
