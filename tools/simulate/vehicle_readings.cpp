#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

namespace {

/// What of a state the channel `piston` of an axis has.
template <class Plant>
double piston_of(const typename Plant::State& state, std::size_t axis) {
  return Plant::measured(state)[axis * Plant::kChannels];
}

}  // namespace

template <class Plant>
VehicleReadings<Plant>::VehicleReadings(const VehicleSensors& sensors, const typename Plant::State& start, unsigned seed)
    : sensors_(sensors), normal_(seed) {
  for (Strings::Anchors anchors : sensors.strings) {
    for (auto& string : anchors) {
      for (double* coordinate : {&string.vehicle_x, &string.vehicle_y, &string.vehicle_z}) {
        *coordinate += sensors.placement_error * normal_();
      }
    }
    geometry_.emplace_back(anchors);
  }
  pistons_.resize(Plant::kAxes);
  piston_lag_.resize(Plant::kAxes);
  for (std::size_t i = 0; i < piston_lag_.size(); ++i) {
    VehicleSensors::Readout::settle(piston_lag_[i], piston_of<Plant>(start, i));
  }
  strings_ = lengths(start);
  string_lag_.resize(strings_.size());
  for (std::size_t i = 0; i < strings_.size(); ++i) {
    VehicleSensors::Readout::settle(string_lag_[i], strings_[i]);
  }
}

template <class Plant>
void VehicleReadings<Plant>::read(const typename Plant::State& state, double h) {
  for (std::size_t i = 0; i < pistons_.size(); ++i) {
    pistons_[i] = sensors_.piston.read(piston_lag_[i], piston_of<Plant>(state, i), normal_(), h);
  }
  const std::vector<double> now = lengths(state);
  for (std::size_t i = 0; i < now.size(); ++i) {
    strings_[i] = sensors_.string.read(string_lag_[i], now[i], normal_(), h);
  }
}

template <class Plant>
std::vector<double> VehicleReadings<Plant>::lengths(const typename Plant::State& state) const {
  std::vector<double> lengths;
  for (std::size_t e = 0; e < geometry_.size(); ++e) {
    const double pitch = state.axes[2 * e].y(Plant::AxisModel::kAngle);
    const double yaw = state.axes[2 * e + 1].y(Plant::AxisModel::kAngle);
    // The bearing's translation carries the engine's end: the same as the anchors carried the other way.
    const Eigen::Vector3d bearing = state.gimbals[e].displacement.template head<3>();
    for (const double length : geometry_[e].lengths(pitch, yaw, -bearing)) {
      lengths.push_back(length);
    }
  }
  if (lengths.empty() || sensors_.string_shape.rows() == 0) {
    return lengths;
  }
  Eigen::VectorXd pulled = sensors_.string_residual * state.structure.forces;
  for (Eigen::Index k = 0; k < sensors_.string_shape.cols(); ++k) {
    pulled += sensors_.string_shape.col(k) * state.structure.modes[static_cast<std::size_t>(k)].displacement;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] -= pulled(static_cast<Eigen::Index>(i));
  }
  return lengths;
}

template class VehicleReadings<model::Taos<double>>;
template class VehicleReadings<model::Masv<double>>;

}  // namespace hotfire
