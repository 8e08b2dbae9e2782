// SPDX-License-Identifier: Apache-2.0
#include "model/engine/bearing_block.hpp"

#include <CppUTest/TestHarness.h>
#include <ceres/jet.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "model/numerics/exact_hold.hpp"
#include "tests/model/support/vehicles.hpp"

namespace hotfire::test {
namespace {

using Bearing = model::CompliantBearing<double>;
using Gimbal = model::GimbalParameters<double>;
using Force = model::Vector3<double>;
using Torque = model::Pair<double>;
using Five = Eigen::Matrix<double, 5, 1>;
using FiveByFive = Eigen::Matrix<double, 5, 5>;

constexpr double kBlockStep = 5e-4;
const std::array<int, 5> kMoving{0, 1, 2, 4, 5};

Gimbal with_block(double mass, double inertia, double loss_time = 1e-3) {
  Gimbal gimbal;
  gimbal.compliant = true;
  gimbal.stiffness = bearing_stiffness();
  gimbal.bearing.block_mass = mass;
  gimbal.bearing.block_inertia = inertia;
  gimbal.bearing.loss_time = loss_time;
  gimbal.bearing.vehicle_side_flexibility = 0.6;
  return gimbal;
}

/// Stiffness of the vehicle's half against translation, pitch and yaw; roll follows.
FiveByFive half_stiffness(const Gimbal& gimbal) {
  const Eigen::Matrix<double, 6, 6> compliance = gimbal.stiffness.inverse();
  return (gimbal.bearing.vehicle_side_flexibility * compliance(kMoving, kMoving)).inverse();
}

Five inertia_of(const Gimbal& gimbal) {
  const auto& bearing = gimbal.bearing;
  Five inertia;
  inertia << bearing.block_mass, bearing.block_mass, bearing.block_mass, bearing.block_inertia, bearing.block_inertia;
  return inertia;
}

Five wrench_of(const Force& force, const Torque& torque) {
  Five wrench;
  wrench << force, torque.pitch, torque.yaw;
  return wrench;
}

/// One step under a wrench.
void advance(const Bearing& bearing, Bearing::State& state, const Force& force, const Torque& torque) {
  Bearing::Advance opened;
  bearing.begin(state, opened);
  bearing.finish(state, opened, force, torque);
}

Five moved(const Bearing::State& state) { return state.block.displacement; }

/// Of the engine's half against the vehicle.
Five whole(const Bearing::State& state) { return wrench_of(state.translation(), state.rotation()); }

/// Rate of the block, from its modes.
Five rate_of(const Gimbal& gimbal, const Bearing::State& state) {
  const auto modes = model::block_modes(gimbal);
  Five rate = Five::Zero();
  for (int k = 0; k < 5; ++k) {
    rate += modes.shape.col(k) * state.block.modes[static_cast<std::size_t>(k)].velocity;
  }
  return rate;
}

}  // namespace

TEST_GROUP(BearingBlock){};

// Newton's law of the block by the exponential of its ten states, which knows no modes: modes that ring and modes that do
// not (a loss time of 1 ms makes 1 kg m^2 of the second kind), forces that turn the bearing, a step beyond a period.
TEST(BearingBlock, MovesAsItsEquationsSayAtAnyStep) {
  for (const auto& [mass, inertia, loss_time] : {std::array{50.0, 1.0, 1e-3}, std::array{50.0, 1.0, 1e-4},
                                                 std::array{5e3, 100.0, 1e-3}, std::array{300.0, 0.01, 2e-5}}) {
    const Gimbal gimbal = with_block(mass, inertia, loss_time);
    const Eigen::Matrix<double, 5, 1> per_inertia = inertia_of(gimbal).cwiseInverse();
    const FiveByFive stiff = per_inertia.asDiagonal() * half_stiffness(gimbal);
    Eigen::Matrix<double, 10, 10> a = Eigen::Matrix<double, 10, 10>::Zero();
    a.topRightCorner<5, 5>().setIdentity();
    a.bottomLeftCorner<5, 5>() = -stiff;
    a.bottomRightCorner<5, 5>() = -loss_time * stiff;
    Eigen::Matrix<double, 10, 5> b = Eigen::Matrix<double, 10, 5>::Zero();
    b.bottomRows<5>() = per_inertia.asDiagonal();
    for (const double h : {5e-5, 5e-4, 4e-3}) {
      const Bearing bearing(gimbal, h);
      const auto exact = model::exact_hold<double, 10, 5>(a, b, h);
      Bearing::State state;
      Eigen::Matrix<double, 10, 1> expected = Eigen::Matrix<double, 10, 1>::Zero();
      Random random(3);
      for (int k = 0; k < 50; ++k) {
        const Force force{random.uniform(-1e6, 1e6), random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5)};
        const Torque torque{random.uniform(-2e4, 2e4), random.uniform(-2e4, 2e4)};
        advance(bearing, state, force, torque);
        expected = exact.transition * expected + exact.response * wrench_of(force, torque);
        const Five rest = half_stiffness(gimbal).inverse() * wrench_of({1e6, 1e5, 1e5}, {2e4, 2e4});
        for (int i = 0; i < 5; ++i) {
          DOUBLES_EQUAL(expected(i), moved(state)(i), 1e-9 * std::abs(rest(i)));
        }
      }
    }
  }
}

// The loss time of a bearing may give a mode exactly the damping at which its frequency ends, and less or more beside it:
// the motion and its derivatives go on without a step.
TEST(BearingBlock, AModePassesCriticalDampingWithItsDerivatives) {
  using Dual = ceres::Jet<double, 2>;
  const auto advanced = [](double damping_ratio, double w) {
    return model::advance_mode<Dual>({Dual(1.0), Dual(30.0)}, Dual(w, 0), Dual(damping_ratio, 1), kBlockStep);
  };
  for (const double w : {20.0, 2e3, 2e4}) {
    // Off 1 by little more and by little less than where the series begins, and in its middle.
    for (const double off : {-1e-3, 0.0, 1e-3}) {
      const auto below = advanced(1.0 + off - 1e-9, w);
      const auto above = advanced(1.0 + off + 1e-9, w);
      const double size = std::exp(-w * kBlockStep);
      DOUBLES_EQUAL(below.displacement.a + 2e-9 * below.displacement.v(1), above.displacement.a, 1e-11 * size);
      DOUBLES_EQUAL(below.velocity.a + 2e-9 * below.velocity.v(1), above.velocity.a, 1e-11 * size * w);
      for (int i = 0; i < 2; ++i) {
        const double derivative = below.displacement.v(i);
        CHECK_TRUE(std::isfinite(derivative));
        DOUBLES_EQUAL(derivative, above.displacement.v(i), 1e-6 * (std::abs(derivative) + size));
      }
    }
  }
}

// On a joint that holds it the block rings at sqrt(K / I) / 2 pi, less its damping: counted over a second.
TEST(BearingBlock, RingsAtItsNaturalFrequencyAndDiesAway) {
  Gimbal gimbal = with_block(50.0, 1.0, 1e-5);
  gimbal.stiffness = Eigen::Matrix<double, 6, 6>(gimbal.stiffness.diagonal().asDiagonal());
  constexpr double kFineStep = 1e-5;
  const Bearing bearing(gimbal, kFineStep);
  const double w = std::sqrt(1.7e7 / 0.6 / 1.0);
  const double zeta = 0.5 * w * gimbal.bearing.loss_time;
  Bearing::State state;
  for (int k = 0; k < 30000; ++k) {  // settled under a torque that then goes
    advance(bearing, state, {0.0, 0.0, 0.0}, {1e4, 0.0});
  }
  DOUBLES_EQUAL(1e4 * 0.6 / 1.7e7, moved(state)(3), 1e-9 * 1e4 / 1.7e7);
  int crossings = 0;
  double first = 0.0;
  double last = 0.0;
  double peak = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double before = moved(state)(3);
    advance(bearing, state, {0.0, 0.0, 0.0}, {0.0, 0.0});
    const double after = moved(state)(3);
    if (before * after < 0.0) {
      last = (k + before / (before - after)) * kFineStep;
      first = crossings == 0 ? last : first;
      ++crossings;
    }
    peak = k >= 3000 ? std::max(peak, std::abs(after)) : 0.0;
  }
  const double frequency = 0.5 * (crossings - 1) / (last - first);
  DOUBLES_EQUAL(w * std::sqrt(1.0 - zeta * zeta) / (2.0 * std::numbers::pi), frequency, 1e-4 * frequency);
  CHECK_TRUE(peak < std::exp(-zeta * w * 3000 * kFineStep) * 1e4 / 1.7e7);
}

// Whatever works on it: what is put in through the joint is stored or lost.
TEST(BearingBlock, GivesBackNoMoreThanItIsGiven) {
  for (const double inertia : {0.01, 1.0, 100.0}) {
    const Gimbal gimbal = with_block(50.0 * inertia, inertia, 1e-4);
    const Bearing bearing(gimbal, kBlockStep);
    const FiveByFive of_vehicle = half_stiffness(gimbal);
    const FiveByFive of_engine = of_vehicle * (0.6 / 0.4);
    const auto stored = [&](const Bearing::State& state) {
      const Five engine = state.displacement(kMoving);
      const Five block = moved(state);
      const Five rate = rate_of(gimbal, state);
      return 0.5 * (engine.dot(of_engine * engine) + block.dot(of_vehicle * block) +
                    rate.dot(inertia_of(gimbal).asDiagonal() * rate));
    };
    Bearing::State state;
    Random random(5);
    double lost = 0.0;
    double given = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const Force force{random.uniform(-1e6, 1e6), random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5)};
      const Torque torque{random.uniform(-2e4, 2e4), random.uniform(-2e4, 2e4)};
      const Five before = whole(state);
      const double had = stored(state);
      advance(bearing, state, force, torque);
      const double work = wrench_of(force, torque).dot(whole(state) - before);
      const double loss = work - (stored(state) - had);
      CHECK_TRUE(loss > -1e-9 * (std::abs(work) + had));
      lost += loss;
      given += std::abs(work);
    }
    CHECK_TRUE(lost > 0.01 * given);
  }
}

// What it says of a step before it is closed is what the step then does.
TEST(BearingBlock, KnowsMeanAndRateBeforeTheStepIsClosed) {
  const Gimbal gimbal = with_block(50.0, 1.0);
  const Bearing bearing(gimbal, kBlockStep);
  Bearing::State state;
  Random random(7);
  for (int k = 0; k < 20; ++k) {
    const Force force{random.uniform(-1e6, 1e6), random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5)};
    const Torque torque{random.uniform(-2e4, 2e4), random.uniform(-2e4, 2e4)};
    const Force further{1e4, -2e4, 3e4};
    const Torque more{300.0, -500.0};
    const Five before = whole(state);
    Bearing::Advance opened;
    bearing.begin(state, opened);
    const Force mean = bearing.mean_translation(state, opened, force, torque);
    const Torque rate = bearing.rotation_rate(state, opened, force, torque);
    const Force under_more = bearing.mean_translation(state, opened, force + further, torque);
    const Torque faster = bearing.rotation_rate(state, opened, force, torque + more) - rate;
    bearing.finish(state, opened, force, torque);
    const Five after = whole(state);
    CHECK_TRUE((mean - 0.5 * (before + after).head<3>()).norm() < 1e-12 * 1e-3);
    DOUBLES_EQUAL((after(3) - before(3)) / kBlockStep, rate.pitch, 1e-9);
    DOUBLES_EQUAL((after(4) - before(4)) / kBlockStep, rate.yaw, 1e-9);
    const Force along{0.2, -0.5, 0.8};
    DOUBLES_EQUAL(along.dot(under_more - mean), bearing.mean_flexibility(along, further, force), 1e-15);
    const Torque expected = bearing.rate_flexibility().times(more);
    DOUBLES_EQUAL(expected.pitch, faster.pitch, 1e-9);
    DOUBLES_EQUAL(expected.yaw, faster.yaw, 1e-9);
  }
}

// A block changes nothing that is at rest, on a bearing that is softer without load either.
TEST(BearingBlock, SettlesWhereTheWholeBearingDoes) {
  Gimbal gimbal = with_block(500.0, 10.0);
  gimbal.bearing.unloaded_stiffness = 0.3;
  gimbal.bearing.load_scale = 3e5;
  Gimbal plain = gimbal;
  plain.bearing.block_mass = plain.bearing.block_inertia = 0.0;
  const Bearing bearing(gimbal, kBlockStep);
  for (const double size : {0.0, 1e5, 3e5, 2e6}) {
    const Force force{size, 0.2 * size, -0.1 * size};
    const Five rest = model::GimbalSpring<double>(plain, kBlockStep).settled(force, {})(kMoving);
    CHECK_TRUE((whole(bearing.settled(force)) - rest).norm() <= 1e-12 * rest.norm());
    Bearing::State state;
    for (int k = 0; k < 4000; ++k) {
      advance(bearing, state, force, {});
    }
    CHECK_TRUE((whole(state) - rest).norm() <= 1e-9 * rest.norm());
  }
}

TEST(BearingBlock, WithoutInertiaHasTheBitsOfABearingWithoutABlock) {
  Taos::Parameters parameters = hot_fire<Taos>();
  Taos::Parameters other = parameters;
  other.gimbals[0].bearing.vehicle_side_flexibility = 0.9;
  const Taos one(parameters, kBlockStep);
  const Taos same(other, kBlockStep);
  other.gimbals[0].bearing.block_mass = 50.0;
  other.gimbals[0].bearing.block_inertia = 1.0;
  const Taos blocked(other, kBlockStep);
  CHECK_FALSE(same.has_block(0));
  CHECK_TRUE(blocked.has_block(0));
  std::array<Taos::State, 3> states{one.steady({}), same.steady({}), blocked.steady({})};
  for (int k = 0; k < 1000; ++k) {
    const Taos::Inputs inputs{{0.01 * std::sin(0.02 * k), 0.006 * std::sin(0.03 * k)}};
    one.step(states[0], inputs);
    same.step(states[1], inputs);
    blocked.step(states[2], inputs);
    CHECK_TRUE(states[0].measured == states[1].measured);
  }
  CHECK_FALSE(states[0].measured == states[2].measured);
}

// The lightest block that a file may declare is none: what it does is the bearing's own law to 1e-6 of it.
TEST(BearingBlock, OfHardlyAnyInertiaIsTheBearingWithoutOne) {
  Taos::Parameters parameters = hot_fire<Taos>();
  const Taos plain(parameters, kBlockStep);
  parameters.gimbals[0].bearing.block_mass = parameters.gimbals[0].bearing.block_inertia = 1e-6;
  const Taos light(parameters, kBlockStep);
  Taos::State one = plain.steady({});
  Taos::State other = light.steady({});
  double gap = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const Taos::Inputs inputs{{0.01 * std::sin(0.02 * k), 0.006 * std::sin(0.03 * k)}};
    plain.step(one, inputs);
    light.step(other, inputs);
    gap = std::max(gap, std::abs(one.measured[1] - other.measured[1]));
    largest = std::max(largest, std::abs(one.measured[1]));
  }
  CHECK_TRUE(gap < 1e-6 * largest);
}

TEST(BearingBlock, HasTheDerivativesOfItsParameters) {
  using Dual = ceres::Jet<double, 3>;
  const auto pitch_of = [](auto mass, auto inertia, auto loss_time) {
    using S = decltype(mass);
    model::GimbalParameters<S> gimbal;
    gimbal.compliant = true;
    gimbal.stiffness = bearing_stiffness().cast<S>();
    gimbal.bearing.block_mass = mass;
    gimbal.bearing.block_inertia = inertia;
    gimbal.bearing.loss_time = loss_time;
    const model::CompliantBearing<S> bearing(gimbal, kBlockStep);
    typename model::CompliantBearing<S>::State state;
    for (int k = 0; k < 3; ++k) {
      typename model::CompliantBearing<S>::Advance opened;
      bearing.begin(state, opened);
      bearing.finish(state, opened, {S(1e6), S(2e5), S(-1e5)}, {S(1e4), S(-5e3)});
    }
    return S(state.rotation().pitch);
  };
  const std::array<double, 3> at{400.0, 5.0, 1e-4};
  const Dual exact = pitch_of(Dual(at[0], 0), Dual(at[1], 1), Dual(at[2], 2));
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = 1e-5 * at[i];
    const auto shifted = [&](double by) {
      std::array<double, 3> own = at;
      own[i] += by;
      return pitch_of(own[0], own[1], own[2]);
    };
    const double difference = (shifted(d) - shifted(-d)) / (2.0 * d);
    DOUBLES_EQUAL(difference, exact.v(static_cast<Eigen::Index>(i)), 1e-6 * std::abs(difference));
  }
}

TEST(BearingBlock, IsRefusedWithHalfOfItsInertiaAndOnARigidBearing) {
  const auto says = [](const Gimbal& gimbal, std::string_view words) {
    return model::broken_relation(gimbal).find(words) != std::string_view::npos;
  };
  CHECK_TRUE(model::broken_relation(with_block(50.0, 1.0)).empty());
  CHECK_TRUE(says(with_block(50.0, 0.0), "give block_mass and block_inertia, or neither"));
  CHECK_TRUE(says(with_block(0.0, 1.0), "give block_mass and block_inertia, or neither"));
  CHECK_TRUE(says(with_block(50.0, 1e-9), "must be above 1e-6"));
  Gimbal rigid = with_block(50.0, 1.0);
  rigid.compliant = false;
  CHECK_TRUE(says(rigid, "rigid bearing; give gimbal.stiffness"));
}

TEST_GROUP(OverdampedMode){};

// Against the exponential of its two states, through critical damping and far beyond.
TEST(OverdampedMode, IsAdvancedExactly) {
  constexpr double w = 4000.0;
  for (const double zeta : {1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.001, 1.7, 30.0}) {
    const Eigen::Matrix2d a{{0.0, 1.0}, {-w * w, -2.0 * zeta * w}};
    for (const double h : {1e-5, 2.5e-4, 2e-3}) {
      const auto exact = model::exact_hold<double, 2, 1>(a, Eigen::Vector2d(0.0, 1.0), h).transition;
      const auto place = model::advance_mode<double>({1.0, 0.0}, w, zeta, h);
      const auto speed = model::advance_mode<double>({0.0, 1.0}, w, zeta, h);
      DOUBLES_EQUAL(exact(0, 0), place.displacement, 1e-8);
      DOUBLES_EQUAL(exact(1, 0) / w, place.velocity / w, 1e-8);
      DOUBLES_EQUAL(exact(0, 1) * w, speed.displacement * w, 1e-8);
      DOUBLES_EQUAL(exact(1, 1), speed.velocity, 1e-8);
    }
  }
}

TEST_GROUP(Eigensystem){};

TEST(Eigensystem, RestoresTheMatrixWhateverItsScales) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix<double, 5, 5> root;
    for (double& entry : root.reshaped()) {
      entry = random.uniform(-1.0, 1.0);
    }
    const Five scale{1.0, 1e-3, 1e2, 1.0, 1e-6};
    Eigen::Matrix<double, 5, 5> matrix = scale.asDiagonal() * (root * root.transpose()) * scale.asDiagonal();
    if (i % 2 == 1) {  // equal values
      matrix(4, 4) = matrix(3, 3) = 2.0;
      matrix.row(4).head<4>().setZero();
      matrix.col(4).head<4>().setZero();
      matrix.row(3).head<3>().setZero();
      matrix.col(3).head<3>().setZero();
    }
    const auto system = model::eigensystem_of_symmetric<double, 5>(matrix);
    const auto& q = system.vectors;
    CHECK_TRUE((q.transpose() * q - FiveByFive::Identity()).norm() < 1e-13);
    const FiveByFive restored = q * system.values.asDiagonal() * q.transpose();
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 5; ++column) {
        DOUBLES_EQUAL(matrix(row, column), restored(row, column),
                      1e-12 * std::sqrt(matrix(row, row) * matrix(column, column)));
      }
    }
  }
}

}  // namespace hotfire::test
