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
    const bool local = k % 3 == 1;
    // Equal shares of the static flexibility: a shape that grows with the frequency.
    const double size = set.frequency(k) * (local ? 1.0 : kRemote);
    for (int port = 0; port < set.ports(); ++port) {
      const double shape = size * uniform(0.5, 1.5) * (uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
      set.shape(port, k) = port < set.ports() / 2 ? shape : kRotation * shape;
    }
  }
  const Eigen::MatrixXd flexibility = static_flexibility(set);
  const int attach_points = set.ports() / 2;
  for (int port = 0; port < attach_points; ++port) {
    const double scale = std::sqrt(uniform(0.9, 1.1) * kFlexibility / flexibility(port, port));
    set.shape.row(port) *= scale;
    set.shape.row(attach_points + port) *= scale;
  }
  return set;
}

}  // namespace hotfire
