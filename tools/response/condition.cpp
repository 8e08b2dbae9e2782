// SPDX-License-Identifier: Apache-2.0
#include "tools/response/condition.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <complex>
#include <numbers>

#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/port_response.hpp"

namespace hotfire::response {

namespace {

using Complex = std::complex<double>;

template <class Parameters>
ModeSet mode_set_of(const Parameters& parameters) {
  const int count = parameters.modes.modes;
  ModeSet set;
  set.engines = static_cast<int>(parameters.gimbals.size());
  set.frequency.resize(count);
  set.damping_ratio.resize(count);
  for (int k = 0; k < count; ++k) {
    set.frequency(k) = parameters.modes.frequency[static_cast<std::size_t>(k)];
    set.damping_ratio(k) = parameters.modes.damping_ratio[static_cast<std::size_t>(k)];
  }
  set.shape = parameters.modes.shape.leftCols(count);
  set.residual = parameters.modes.residual;
  return set;
}

/// Arms, local flexibility and bearings as the plant has them at zero angles under its declared thrust.
template <class Plant, class Parameters>
void add_engines(const Parameters& parameters, std::vector<ConditionAxis> axes, Condition& condition) {
  // The plant's own bearings: where they rest does not depend on its step.
  constexpr double kStep = 1e-3;
  condition.local.resize(Plant::kAxes);
  condition.arms = Eigen::MatrixXd::Zero(Plant::kAxes, Plant::kAxes);
  condition.bearing = Eigen::MatrixXd::Zero(Plant::kAxes, Plant::kAxes);
  for (int engine = 0; engine < Plant::kEngines; ++engine) {
    const auto own = static_cast<std::size_t>(engine);
    const auto& gimbal = parameters.gimbals[own];
    const auto pose = Plant::geometry_of(parameters, own).at(0.0, 0.0);
    const model::CompliantBearing<double> bearing(gimbal, kStep);
    const model::Vector3<double> load = pose.thrust * (gimbal.bearing.thrust + gimbal.bearing.dead_load);
    for (int k = 0; k < 2; ++k) {
      const int axis = 2 * engine + k;
      const auto actuator = static_cast<std::size_t>(k);
      axes[static_cast<std::size_t>(axis)].damping = parameters.axes[static_cast<std::size_t>(axis)].engine.viscous_damping;
      condition.local(axis) = (1.0 + gimbal.bearing.further_structure(gimbal.bearing.thrust)) /
                              parameters.axes[static_cast<std::size_t>(axis)].structure.stiffness;
      for (int other = 0; other < 2; ++other) {
        const auto along = static_cast<std::size_t>(other);
        condition.arms(axis, 2 * engine + other) = pose.arm[actuator][along];
        const model::Vector3<double> moved =
            bearing.settled(load + pose.direction[along]).translation() - bearing.settled(load).translation();
        condition.bearing(axis, 2 * engine + other) = pose.direction[actuator].dot(moved);
      }
    }
  }
  condition.axes = std::move(axes);
}

std::vector<ConditionAxis> axes_of(const VehicleFile& vehicle, int engines, const Loading& loading) {
  std::vector<ConditionAxis> axes;
  for (const std::string& name : axis_names(engines)) {
    ConditionAxis axis{name, trials::load_spring_of(vehicle, name), {}, 0.0};
    axis.stiffness = trials::expected_stiffness(axis.spring, loading.amplitude, loading.bias);
    axes.push_back(std::move(axis));
  }
  return axes;
}

}  // namespace

Condition load_condition(const std::filesystem::path& path, const Loading& loading) {
  Condition condition;
  condition.name = path.stem().string();
  if (path.extension() == ".csv") {
    condition.modes = load_modes(path);
    condition.local = Eigen::VectorXd::Zero(2 * condition.modes.engines);
    return condition;
  }
  if (!is_vehicle(path)) {
    throw FileError(fmt::format(
        "{}: has no structure with ports; allowed: topology \"taos\" or \"masv\", or a mode table (.csv)", path.string()));
  }
  const VehicleFile vehicle = load_vehicle(path);
  std::visit(
      [&]<class Parameters>(const Parameters& parameters) {
        using Plant =
            std::conditional_t<std::is_same_v<Parameters, TaosParameters>, model::Taos<double>, model::Masv<double>>;
        condition.modes = mode_set_of(parameters);
        add_engines<Plant>(parameters, axes_of(vehicle, Plant::kEngines, loading), condition);
      },
      vehicle.parameters);
  return condition;
}

Eigen::MatrixXcd structure_response(const Condition& condition, double frequency) {
  Eigen::MatrixXcd response = port_response(condition.modes, frequency);
  for (Eigen::Index axis = 0; axis < condition.local.size(); ++axis) {
    response(axis, axis) += condition.local(axis);
  }
  return response;
}

ActuatorResponse actuator_response(const Condition& condition, double frequency) {
  const auto count = static_cast<Eigen::Index>(condition.axes.size());
  const Complex s(0.0, 2.0 * std::numbers::pi * frequency);
  const Eigen::MatrixXcd ports = structure_response(condition, frequency);
  Eigen::VectorXcd engine(count);
  Eigen::VectorXcd duct(count);
  Eigen::VectorXd spring(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ConditionAxis& axis = condition.axes[static_cast<std::size_t>(i)];
    duct(i) = axis.spring.load.duct_stiffness + s * axis.damping;
    engine(i) = axis.spring.load.inertia * s * s + duct(i);
    spring(i) = axis.stiffness.actuator;
  }
  // Unknowns: forces F, torques T on the gimbals, angles beta.
  Eigen::MatrixXcd system = Eigen::MatrixXcd::Zero(3 * count, 3 * count);
  const auto block = [&](Eigen::Index row, Eigen::Index column) {
    return system.block(row * count, column * count, count, count);
  };
  const Eigen::MatrixXcd to_force = spring.cast<Complex>().asDiagonal();
  const Eigen::MatrixXcd arms = condition.arms.cast<Complex>();
  // q = A beta + Y_FF F + X_FT T, and F + K q = E.
  const Eigen::MatrixXcd own = ports.topLeftCorner(count, count) + condition.bearing.cast<Complex>();
  block(0, 0) = Eigen::MatrixXcd::Identity(count, count) + to_force * own;
  block(0, 1) = to_force * ports.topRightCorner(count, count);
  block(0, 2) = to_force * arms;
  // T - G (beta - X_TF F - X_TT T) = 0.
  block(1, 0) = duct.asDiagonal() * ports.bottomLeftCorner(count, count);
  block(1, 1) = Eigen::MatrixXcd::Identity(count, count) + duct.asDiagonal() * ports.bottomRightCorner(count, count);
  block(1, 2) = -Eigen::MatrixXcd(duct.asDiagonal());
  // J s^2 beta + T = A^T F.
  block(2, 0) = -arms.transpose();
  block(2, 1) = Eigen::MatrixXcd::Identity(count, count);
  block(2, 2) = Eigen::MatrixXcd((engine - duct).asDiagonal());
  Eigen::MatrixXcd force = Eigen::MatrixXcd::Zero(3 * count, count);
  force.topRows(count).setIdentity();
  const Eigen::MatrixXcd solution = system.partialPivLu().solve(force);
  const Eigen::MatrixXcd angle = solution.bottomRows(count);
  return {
      own * solution.topRows(count) + ports.topRightCorner(count, count) * solution.middleRows(count, count) + arms * angle,
      angle};
}

StiffnessByFrequency load_stiffness_by_frequency(const Condition& condition, int axis) {
  const ModalIntegral integral = modal_integral(condition.modes, axis);
  const double at_once = condition.local(axis) + condition.modes.residual(axis, axis);
  StiffnessByFrequency result;
  if (at_once > 0.0) {
    result.frequency.push_back(0.0);
    result.stiffness.push_back(1.0 / at_once);
  }
  for (std::size_t k = 0; k < integral.frequency.size(); ++k) {
    // A mode that a port does not feel leaves it rigid.
    if (at_once + integral.flexibility[k] > 0.0) {
      result.frequency.push_back(integral.frequency[k]);
      result.stiffness.push_back(1.0 / (at_once + integral.flexibility[k]));
    }
  }
  return result;
}

}  // namespace hotfire::response
