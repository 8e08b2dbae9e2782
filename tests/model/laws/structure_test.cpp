// SPDX-License-Identifier: Apache-2.0
#include "model/structure/structure.hpp"

#include <CppUTest/TestHarness.h>

#include <complex>

#include "model/engine/geometry.hpp"
#include "model/numerics/linear_algebra.hpp"
#include "tests/model/support/vehicles.hpp"

namespace hotfire::test {
namespace {

using Structure = model::ModalStructure<double, 4, 8>;

Structure::Table two_modes() {
  Structure::Table table;
  table.modes = 2;
  table.frequency = {3.0, 90.0};
  table.damping_ratio = {0.01, 0.2};
  table.shape.col(0) << 1e-3, -2e-3, 3e-4, 5e-4;
  table.shape.col(1) << 2e-3, 1e-3, -1e-4, 6e-4;
  return table;
}

}  // namespace

TEST_GROUP(ModalStructure){};

// Constant forces from rest: every port follows phi phi^T f / w^2 (1 - e^{-zeta w t} (cos + zeta / sqrt(1 - zeta^2) sin)),
// at a twentieth of a millisecond as at steps far longer than the modes' periods.
TEST(ModalStructure, IsExactUnderHeldForcesAtAnyStep) {
  const Structure::Table table = two_modes();
  const Structure::PortVector forces(1e4, -3e3, 2e3, 500.0);
  for (const double h : {5e-5, 5e-4, 0.03, 0.7}) {
    const Structure structure(table, h);
    Structure::State state = structure.settled(Structure::PortVector::Zero());
    for (int k = 1; k <= 40; ++k) {
      const auto advance = structure.begin(state);
      state.forces = forces;
      structure.finish(state, advance);
      Structure::PortVector expected = Structure::PortVector::Zero();
      for (int mode = 0; mode < 2; ++mode) {
        const auto i = static_cast<std::size_t>(mode);
        const double w = 2.0 * std::numbers::pi * table.frequency[i];
        const double zeta = table.damping_ratio[i];
        const double root = std::sqrt(1.0 - zeta * zeta);
        const double t = k * h;
        const double rise = 1.0 - std::exp(-zeta * w * t) * (std::cos(w * root * t) + zeta / root * std::sin(w * root * t));
        expected += table.shape.col(mode) * (table.shape.col(mode).dot(forces) / (w * w) * rise);
      }
      CHECK_TRUE((state.displacement - expected).norm() < 1e-11 * structure.static_flexibility().norm() * forces.norm());
    }
  }
}

// What it tells others about a step before the step is closed: mean and rate of its ports.
TEST(ModalStructure, KnowsMeanAndRateOfItsPortsBeforeTheStepIsClosed) {
  Structure::Table table = two_modes();
  table.residual.diagonal() << 1e-9, 2e-9, 1e-9, 3e-9;
  const double h = 5e-4;
  const Structure structure(table, h);
  Structure::State state = structure.settled({1e4, 2e3, 0.0, 0.0});
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    const Structure::State before = state;
    const auto advance = structure.begin(state);
    state.forces = {random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4), random.uniform(-1e3, 1e3), 0.0};
    const auto moved = structure.attach_motion(state, advance);
    const auto turned = structure.rotation(state, advance);
    const auto rate = structure.rotation_rate(state, advance);
    structure.finish(state, advance);
    const Structure::PortVector now = table.residual * state.forces;
    const Structure::PortVector last = table.residual * before.forces;
    const Structure::PortVector mean = 0.5 * (before.displacement + state.displacement) + now;
    const Structure::PortVector change = state.displacement - before.displacement + now - last;
    CHECK_TRUE((moved - mean.head<2>()).norm() < 1e-13);
    CHECK_TRUE((turned - mean.tail<2>()).norm() < 1e-13);
    CHECK_TRUE((h * rate - change.tail<2>()).norm() < 1e-13);
  }
}

// An odd number of modes leaves half of the last pair empty.
TEST(ModalStructure, RunsAnOddNumberOfModes) {
  Structure::Table table = two_modes();
  table.modes = 1;
  const Structure structure(table, 1e-3);
  Structure::State state = structure.settled({1e4, 0.0, 0.0, 0.0});
  const Structure::PortVector rest = state.displacement;
  for (int k = 0; k < 1000; ++k) {
    structure.finish(state, structure.begin(state));
  }
  CHECK_TRUE((state.displacement - rest).norm() < 1e-12 * rest.norm());
  DOUBLES_EQUAL(0.0, state.modes[1].displacement, 0.0);
}

TEST_GROUP(EngineGeometry){};

TEST_GROUP(GimbalBearing){};

// The work of a small turn is the same seen from the actuators and from the engine: the arms are the stroke's derivatives.
TEST(EngineGeometry, HasTheDerivativesOfItsStrokesAsArms) {
  const model::EngineGeometry<double> geometry(inclined_pitch(), inclined_yaw());
  Random random(1);
  constexpr double d = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const double pitch = random.uniform(-0.18, 0.18);
    const double yaw = random.uniform(-0.18, 0.18);
    const auto pose = geometry.at(pitch, yaw);
    for (std::size_t actuator = 0; actuator < 2; ++actuator) {
      const double by_pitch =
          (geometry.at(pitch + d, yaw).stroke[actuator] - geometry.at(pitch - d, yaw).stroke[actuator]) / (2.0 * d);
      const double by_yaw =
          (geometry.at(pitch, yaw + d).stroke[actuator] - geometry.at(pitch, yaw - d).stroke[actuator]) / (2.0 * d);
      // Differences of a length of order one: rounding 1e-16 / 1e-6, curvature 1e-12.
      DOUBLES_EQUAL(by_pitch, pose.arm[actuator][0], 1e-9);
      DOUBLES_EQUAL(by_yaw, pose.arm[actuator][1], 1e-9);
      DOUBLES_EQUAL(1.0, pose.direction[actuator].norm(), 1e-14);
    }
    DOUBLES_EQUAL(1.0, pose.thrust.norm(), 1e-14);
  }
}

TEST(EngineGeometry, HasTheDeclaredArmAtZeroAnglesAndNoneAcross) {
  const model::EngineGeometry<double> geometry({}, model::yaw_attach_points<double>());
  const auto pose = geometry.at(0.0, 0.0);
  for (std::size_t actuator = 0; actuator < 2; ++actuator) {
    DOUBLES_EQUAL(0.0, pose.stroke[actuator], 0.0);
    DOUBLES_EQUAL(0.7544, pose.arm[actuator][actuator], 1e-15);
    DOUBLES_EQUAL(0.0, pose.arm[actuator][1 - actuator], 1e-15);
  }
}

TEST(EngineGeometry, RefusesAttachPointsThatCoincideOrDoNotTurnTheEngine) {
  using Points = model::AttachPoints<double>;
  const Points pitch;
  const Points yaw = model::yaw_attach_points<double>();
  const auto says = [](const Points& a, const Points& b, std::string_view words) {
    return model::broken_relation(a, b).find(words) != std::string_view::npos;
  };
  CHECK_TRUE(model::broken_relation(pitch, yaw).empty());
  CHECK_TRUE(model::broken_relation(inclined_pitch(), inclined_yaw()).empty());
  Points point = pitch;
  point.vehicle_x = point.engine_x;
  CHECK_TRUE(says(point, yaw, "on engine and vehicle coincide"));
  CHECK_TRUE(says(pitch, pitch, "two actuators coincide"));
  CHECK_TRUE(says(yaw, pitch, "pitch actuator has no arm"));
  Points mirrored = yaw;
  mirrored.engine_y = mirrored.vehicle_y = -0.7544;
  CHECK_TRUE(says(pitch, mirrored, "yaw actuator has no arm"));
  Points lost = pitch;
  lost.engine_z = std::nan("");
  CHECK_FALSE(model::broken_relation(lost, yaw).empty());
}

TEST(GimbalBearing, RefusesAStiffnessThatIsNone) {
  model::GimbalParameters<double> gimbal;
  gimbal.compliant = true;
  gimbal.stiffness = bearing_stiffness();
  CHECK_TRUE(model::broken_relation(gimbal).empty());
  gimbal.stiffness(1, 5) *= 2.0;
  CHECK_TRUE(model::broken_relation(gimbal) == "the stiffness matrix is not symmetric");
  gimbal.stiffness = bearing_stiffness();
  gimbal.stiffness(4, 4) = -1.7e7;
  CHECK_TRUE(model::broken_relation(gimbal) == "the stiffness matrix is not positive definite");
}

TEST_GROUP(LinearAlgebra){};

TEST(LinearAlgebra, InvertsWhatIsPositiveDefiniteAndKnowsWhatIsNot) {
  const Eigen::Matrix<double, 6, 6> stiffness = bearing_stiffness();
  const Eigen::Matrix<double, 6, 6> product = stiffness * model::inverse_of_positive_definite<double, 6>(stiffness);
  CHECK_TRUE((product - Eigen::Matrix<double, 6, 6>::Identity()).norm() < 1e-12);
  CHECK_TRUE(model::is_positive_definite(stiffness));
  Eigen::Matrix<double, 6, 6> wrong = stiffness;
  wrong(3, 3) = -1.0;
  CHECK_FALSE(model::is_positive_definite(wrong));
  wrong = stiffness;
  wrong(1, 5) *= 1.001;
  CHECK_FALSE(model::is_symmetric(wrong));
  wrong = stiffness;
  wrong(1, 5) = wrong(5, 1) = 1.01 * std::sqrt(2e9 * 1.7e7);
  CHECK_FALSE(model::is_positive_definite(wrong));
  wrong(0, 0) = std::nan("");
  CHECK_FALSE(model::is_positive_definite(wrong));
}

}  // namespace hotfire::test
