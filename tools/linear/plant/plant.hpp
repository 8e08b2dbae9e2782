// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/interface/plant/plant.hpp"
#include "tools/linear/plant/ports.hpp"

namespace hotfire::linear {

using Complex = std::complex<double>;

/// Where a plant rests: what it is linearised about.
struct OperatingPoint {
  std::vector<double> commands;  ///< of every axis [rad]; empty: all zero
  std::vector<double> loads;     ///< constant torque on every engine axis, towards positive angles [N m]; empty: all zero
};

/// A quantity with its name and unit.
struct Quantity {
  std::string name;
  std::string unit;
};

/// What a step of the model does to small deviations from where it rests: every number that the model keeps from step to
/// step is a state, what it remembers of its own iterations included. Exact, by dual numbers.
///   next = by_state state + by_input input
struct StepMap {
  double step = 0.0;  ///< [s]
  std::vector<Quantity> states;
  std::vector<bool> continuous;  ///< of a state: a quantity of the equations of motion, which a reduced model keeps first
  std::vector<Quantity> inputs;  ///< those of the plant; behind them in `by_input`, `kSitePorts` ports an axis
  std::vector<Quantity> outputs;
  Eigen::MatrixXd by_state;
  Eigen::MatrixXd by_input;
  Eigen::MatrixXd output_by_state;  ///< of the outputs at the end of the step
  Eigen::MatrixXd output_by_input;
  std::vector<int> load_force;  ///< of an axis: the state that is the mean force of its load spring over the step [N]
  std::vector<int> first;       ///< of an axis: where its eight continuous states begin (`model::AxisStates`)
  std::vector<int> bristle;     ///< of an axis: the deflection of its bearing's bristle; -1 without friction

  /// The column of `by_input` that is a port of an axis.
  Eigen::Index port_column(int axis, int port) const {
    return static_cast<Eigen::Index>(inputs.size()) + axis * kSitePorts + port;
  }
};

/// A transport delay that a map leaves out.
struct Delay {
  std::string name;      ///< of the input or output
  double seconds = 0.0;  ///< negative: it is early
};

/// The effects that a map has: all of them, or those of sensors and structure alone.
enum class With { all_effects, linear_parts };

/// What represents the friction of a bearing in a map of linear parts: a torque k slip + c slip rate, about both axes.
struct BearingSpring {
  double stiffness = 0.0;  ///< [N m/rad]
  double viscous = 0.0;    ///< [N m s/rad]
};

/// Harmonics of a balance at least, and at most. Fifteen instead of nine change a cycle near the frequency of its engine by
/// 0.002 dB.
inline constexpr int kFewestHarmonics = 9;
inline constexpr int kMostHarmonics = 25;

/// A periodic signal: its mean, and its sines about it, Re(sum over m of harmonics[m - 1] e^{i 2 pi m f t}).
struct Wave {
  double mean = 0.0;
  std::array<Complex, kMostHarmonics> harmonics{};  ///< zero beyond those of the balance

  Complex& fundamental() { return harmonics[0]; }
  const Complex& fundamental() const { return harmonics[0]; }
};

/// How an axis moves: its eight continuous states, its commanded angle, the motion of its attach point, the slip of its
/// bearing as an angle.
struct AxisWaves {
  std::array<Wave, 8> states{};
  Wave command{};
  Wave attach{};
  Wave slip{};
};

/// What an axis puts into its ports when it moves so, and the command behind the effects of its site. Means are the
/// deviation from those at rest. At the bearing it is the part of the slip [rad] that the spring of `Plant::bearing_spring`
/// does not take up: slip - torque / stiffness.
struct PortWaves {
  std::array<Wave, kAxisPorts> ports{};
  Wave command{};
};

/// A plant of several axes about a point of rest, in small deviations and in periodic motion of any size.
class Plant {
 public:
  virtual ~Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  virtual std::string topology() const = 0;
  virtual int axes() const = 0;
  virtual double step() const = 0;                                ///< of the model [s]
  virtual double stiffness(int axis) const = 0;                   ///< K_T of its load spring [N/m]
  virtual double moment_arm(int axis) const = 0;                  ///< [m]
  virtual const std::array<double, 8>& rest(int axis) const = 0;  ///< its continuous states
  virtual std::vector<Quantity> inputs() const = 0;
  virtual std::vector<Delay> delays() const = 0;

  /// Of linear parts the bearings are `bearings`, one an engine; empty: `bearing_spring`.
  virtual StepMap map(With effects, const std::vector<BearingSpring>& bearings = {}) const = 0;

  /// Of an engine of several axes: the bristle of its bearing's friction, as while it holds.
  virtual BearingSpring bearing_spring(int engine) const = 0;

  /// Which ports of an axis carry anything but zero: those whose site has an active effect, and flow and valve command,
  /// whose laws are not linear themselves.
  virtual std::array<bool, kAxisPorts> in_use(int axis) const = 0;

  /// Harmonics of a balance at `frequency` [Hz]. Friction that holds and slips within a cycle
  /// releases the engine, which swings at its own frequency on its load spring: a slow cycle needs the harmonics up to
  /// there, a fast one those of the corners of its laws.
  virtual int harmonics(double frequency) const = 0;

  /// What the model's own laws give when all axes move periodically with one frequency [Hz]: mean and harmonics of every
  /// port signal beyond `linear_parts`. `moved` are deviations from rest with `harmonics` harmonics, and so are the signals.
  virtual std::vector<PortWaves> respond(double frequency, int harmonics, const std::vector<AxisWaves>& moved) const = 0;

 protected:
  Plant() = default;
};

/// The plant of some parameters, for records of `period` [s]. Throws UsageError for what has no small deviations: a `direct`
/// mass, a term with a memory, a simulated vibration, a point at which the plant does not rest.
std::unique_ptr<Plant> make_plant(const plant::AnyParameters& parameters, double period, const OperatingPoint& point);

// One for each topology, each in a file of its own.
std::unique_ptr<Plant> make_plant(const model::Simplex<double>::Parameters& parameters, double period,
                                  const OperatingPoint& point);
std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Taos<double>>& parameters, double period,
                                  const OperatingPoint& point);
std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Masv<double>>& parameters, double period,
                                  const OperatingPoint& point);

}  // namespace hotfire::linear
