// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/jet.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "hal/arithmetic/denormals.hpp"
#include "tools/interface/plant/copy_state.hpp"
#include "tools/linear/plant/elements.hpp"
#include "tools/linear/plant/parameters.hpp"
#include "tools/linear/plant/topologies.hpp"

namespace hotfire::linear {

/// A plant of one topology: `Topology<S>` says what it is in a scalar S.
template <template <class> class Topology>
class PlantOf final : public Plant {
  static constexpr int kAtOnce = 8;  ///< columns of a map that one step gives: a dual number of this many parts
  using Dual = ceres::Jet<double, kAtOnce>;
  using Plain = Topology<double>;
  using Moved = Topology<Dual>;
  using State = typename Plain::State;
  using Laws = AxisLaws<typename Plain::Axis>;
  static constexpr auto kAxes = static_cast<std::size_t>(Plain::kAxes);

 public:
  template <class Declared>
  PlantOf(const Declared& declared, double period, const OperatingPoint& point) {
    Plain::visit(declared, table_);
    PortedSlots<double> slots(table_);
    Plain::visit(parameters_, slots);
    commands_ = point.commands;
    commands_.resize(kAxes, 0.0);
    loads_ = point.loads;
    loads_.resize(kAxes, 0.0);
    // A law of the size of a deflection (`SoftStiffness`) has no slope at exactly none: the load spring carries a trace.
    constexpr double kTrace = 1e-3;  // N m: far below any friction, far above rounding
    for (double& load : loads_) {
      load = load == 0.0 ? kTrace : load;
    }
    inputs_ = Plain::inputs(parameters_);
    delays_ = delays_of<Plain>(parameters_);
    set_operating_point<Plain>(parameters_, loads_);
    h_ = period / model::steps_per_period(period, Plain::longest_step(parameters_));
    model_.emplace(Plain::of_model(parameters_), h_);
    rest_ = std::make_unique<State>(parameters_, Plain::steady(*model_, commands_));
    for (std::size_t i = 0; i < kAxes; ++i) {
      std::copy_n(Plain::axis(*rest_, i).y.data(), rests_[i].size(), rests_[i].begin());
    }
    refuse_motion();
    for (std::size_t i = 0; i < kAxes; ++i) {
      flow_slopes_[i] = flow_slopes(i);
      const auto& own = Plain::axis(*model_, static_cast<int>(i)).parameters();
      holds_ = holds_ || acts<model::Site::piston>(own.effects) || acts<model::Site::engine_torque>(own.effects) ||
               in_use(static_cast<int>(i))[kFrictionPort];
      const double stiffness = Plain::axis(*model_, static_cast<int>(i)).stiffness();
      engine_frequency_ = std::max(
          engine_frequency_, own.actuator.moment_arm * std::sqrt(stiffness / own.engine.inertia) / (2.0 * std::numbers::pi));
    }
  }

  std::string topology() const override { return std::string(Plain::Model::topology); }
  int axes() const override { return Plain::kAxes; }
  double step() const override { return h_; }
  double stiffness(int axis) const override { return Plain::axis(*model_, axis).stiffness(); }
  double moment_arm(int axis) const override { return Plain::axis(*model_, axis).parameters().actuator.moment_arm; }
  const std::array<double, 8>& rest(int axis) const override { return rests_[static_cast<std::size_t>(axis)]; }
  std::vector<Quantity> inputs() const override { return empty_map().inputs; }
  std::vector<Delay> delays() const override { return delays_; }

  StepMap map(With effects, const std::vector<BearingSpring>& bearings) const override {
    auto dual = std::make_unique<typename Moved::Parameters>();
    PortedSlots<Dual> slots(table_);
    Moved::visit(*dual, slots);
    set_operating_point<Moved>(*dual, loads_);
    if (effects == With::linear_parts) {
      std::vector<BearingSpring> own = bearings;
      for (std::size_t e = own.size(); Plain::is_vehicle && e < kAxes / 2; ++e) {
        own.push_back(bearing_spring(static_cast<int>(e)));
      }
      leave_linear_parts<Moved>(*dual, own);
    }
    const auto moving = std::make_unique<typename Moved::Model>(Moved::of_model(*dual), h_);
    const auto first = std::make_unique<typename Moved::State>(*dual, typename Moved::Model::State{});
    plant::copy_state(rest_->plant, first->plant);
    if constexpr (Plain::is_vehicle) {
      plant::copy_state(rest_->piston_lag, first->piston_lag);
    }
    const auto state = std::make_unique<typename Moved::State>(*first);
    StepMap map = empty_map();
    const Labels<Dual> labels = labels_of<Moved>(*state, *dual);
    describe(labels, map);
    const auto states = static_cast<Eigen::Index>(map.states.size());
    const auto inputs = static_cast<Eigen::Index>(map.inputs.size() + kSitePorts * kAxes);
    const auto outputs = static_cast<Eigen::Index>(map.outputs.size());
    Eigen::MatrixXd all(states + outputs, states + inputs);
    std::vector<Dual> given(map.inputs.size());
    std::vector<Dual> read(map.outputs.size());
    const hal::FlushDenormals flush;
    for (Eigen::Index column = 0; column < all.cols(); column += kAtOnce) {
      const Eigen::Index some = std::min<Eigen::Index>(kAtOnce, all.cols() - column);
      state->plant = first->plant;
      if constexpr (Plain::is_vehicle) {
        state->piston_lag = first->piston_lag;
      }
      for (std::size_t i = 0; i < given.size(); ++i) {
        given[i] = Dual(start_of_input(i));
      }
      for (Eigen::Index k = 0; k < some; ++k) {
        const Eigen::Index own = column + k;
        Dual& moved = own < states ? *labels.all()[static_cast<std::size_t>(own)].value
                      : own - states < static_cast<Eigen::Index>(given.size())
                          ? given[static_cast<std::size_t>(own - states)]
                          : port<Moved>(*state, static_cast<std::size_t>(own - states) - given.size());
        moved.v[k] = 1.0;
      }
      Moved::step(*moving, *state, given, *dual);
      Moved::read(*state, h_, *dual, read);
      for (Eigen::Index k = 0; k < some; ++k) {
        for (Eigen::Index row = 0; row < states; ++row) {
          all(row, column + k) = labels.all()[static_cast<std::size_t>(row)].value->v[k];
        }
        for (Eigen::Index row = 0; row < outputs; ++row) {
          all(states + row, column + k) = read[static_cast<std::size_t>(row)].v[k];
        }
      }
    }
    map.by_state = all.topLeftCorner(states, states);
    map.by_input = all.topRightCorner(states, inputs);
    map.output_by_state = all.bottomLeftCorner(outputs, states);
    map.output_by_input = all.bottomRightCorner(outputs, inputs);
    return map;
  }

  BearingSpring bearing_spring(int engine) const override {
    constexpr double kHard = 1e9;  // N m/rad: of rigid friction; far harder than any engine is held
    if constexpr (Plain::is_vehicle) {
      const auto& friction = parameters_.vehicle.gimbals[static_cast<std::size_t>(engine)].friction;
      if (friction.law() != model::BearingFriction<double>::Law::coulomb) {
        return {friction.stiffness, 0.0};
      }
    }
    return {kHard, 0.0};
  }

  std::array<bool, kAxisPorts> in_use(int axis) const override {
    const auto i = static_cast<std::size_t>(axis);
    const auto& effects = Plain::axis(*model_, axis).parameters().effects;
    std::array<bool, kAxisPorts> used{};
    used[kValvePort] = true;
    used[kFlowPort] = true;
    used[kPistonPort] = acts<model::Site::piston>(effects);
    used[kSpringPort] = acts<model::Site::load_spring>(effects);
    // A moment arm that follows the angle turns the engine by another torque.
    used[kTorquePort] = acts<model::Site::engine_torque>(effects) || used[kSpringPort];
    if constexpr (Plain::is_vehicle) {
      used[kFrictionPort] = parameters_.vehicle.gimbals[i / 2].friction.rubs();
    }
    return used;
  }

  int harmonics(double frequency) const override {
    if (!holds_) {
      return kFewestHarmonics;
    }
    constexpr double kSwings = 3.0;  // a release is no sine, and faster than the engine alone while friction still holds it
    const double wanted = std::ceil(kSwings * engine_frequency_ / frequency);
    return static_cast<int>(std::clamp<double>(wanted, kFewestHarmonics, kMostHarmonics));
  }

  std::vector<PortWaves> respond(double frequency, int harmonics, const std::vector<AxisWaves>& moved) const override {
    std::vector<PortWaves> all(kAxes);
    const hal::FlushDenormals flush;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const Laws& laws = laws_at(frequency, harmonics, i);
      const std::size_t other = Plain::is_vehicle ? i ^ 1U : i;
      const Wave& angle = moved[other].states[model::AxisStates::kAngle];
      Wave other_angle = angle;
      other_angle.mean += rests_[other][model::AxisStates::kAngle];
      const auto waves = laws.respond(moved[i], other_angle);
      std::copy_n(waves.begin(), kSitePorts, all[i].ports.begin());
      all[i].command = waves.back();
      const Wave& spool = moved[i].states[model::AxisStates::kOpening];
      const Wave& pressure = moved[i].states[model::AxisStates::kPressure];
      Wave& flow = all[i].ports[kFlowPort];
      flow.mean -= flow_slopes_[i][0] * spool.mean + flow_slopes_[i][1] * pressure.mean;
      for (std::size_t m = 0; m < static_cast<std::size_t>(harmonics); ++m) {
        flow.harmonics[m] -= flow_slopes_[i][0] * spool.harmonics[m] + flow_slopes_[i][1] * pressure.harmonics[m];
      }
    }
    if constexpr (Plain::is_vehicle) {
      for (std::size_t e = 0; e < kAxes / 2; ++e) {
        if (parameters_.vehicle.gimbals[e].friction.rubs()) {
          const auto torque = friction_of(parameters_.vehicle.gimbals[e].friction, condition_of(e), frequency, harmonics,
                                          moved[2 * e].slip, moved[2 * e + 1].slip);
          const double stiffness = bearing_spring(static_cast<int>(e)).stiffness;
          for (std::size_t k = 0; k < 2; ++k) {
            Wave& port = all[2 * e + k].ports[kFrictionPort];
            port.mean = -torque[k].mean / stiffness;
            for (std::size_t m = 0; m < static_cast<std::size_t>(harmonics); ++m) {
              port.harmonics[m] = moved[2 * e + k].slip.harmonics[m] - torque[k].harmonics[m] / stiffness;
            }
          }
        }
      }
    }
    return all;
  }

 private:
  /// The state is one of rest: a second of the model leaves every axis where it is.
  void refuse_motion() {
    constexpr double kStill = 1e-5;  // rad, m: a settled start is known to a tenth of it
    State state(parameters_, rest_->plant);
    std::vector<double> given(inputs_.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      given[i] = start_of_input(i);
    }
    const hal::FlushDenormals flush;
    for (int k = 0; k < static_cast<int>(1.0 / h_); ++k) {
      Plain::step(*model_, state, given, parameters_);
    }
    for (std::size_t i = 0; i < kAxes; ++i) {
      const auto& y = Plain::axis(state, i).y;
      for (const int own : {model::AxisStates::kPiston, model::AxisStates::kAngle}) {
        if (!(std::abs(y(own) - rests_[i][static_cast<std::size_t>(own)]) < kStill)) {
          throw UsageError(fmt::format(
              "the model does not rest under these commands and loads: {}{} moves by {:.3g} in a second; remedy: a smaller "
              "load or command, or parameters under which the loop of the actuator is stable",
              kAxisStates[static_cast<std::size_t>(own)][0], Plain::suffix(i),
              y(own) - rests_[i][static_cast<std::size_t>(own)]));
        }
      }
    }
  }

  double start_of_input(std::size_t i) const { return i < kAxes ? commands_[i] : inputs_[i].start; }

  StepMap empty_map() const {
    StepMap map;
    map.step = h_;
    for (const plant::Variable& input : inputs_) {
      map.inputs.push_back({input.name, input.unit});
    }
    for (const plant::Variable& output : Plain::Adapter::outputs(plant::Setup{})) {
      map.outputs.push_back({output.name, output.unit});
    }
    return map;
  }

  /// Every number of a state.
  template <class Any>
  static Labels<typename Any::Scalar> labels_of(typename Any::State& state, const typename Any::Parameters& parameters) {
    Labels<typename Any::Scalar> labels;
    for (std::size_t i = 0; i < kAxes; ++i) {
      label_axis(Any::axis(state, i), Any::axis(parameters, i).effects, Plain::suffix(i), labels);
    }
    if constexpr (Any::is_vehicle) {
      label_vehicle(state.plant, parameters.vehicle, labels);
      if (model::value_of(parameters.sensors.piston.lag) > 0.0) {
        labels.add(state.piston_lag, "reading", "m");
      }
    }
    return labels;
  }

  /// The states of a map, and where those are that have a meaning to its users.
  static void describe(const Labels<Dual>& labels, StepMap& map) {
    for (std::size_t i = 0; i < kAxes; ++i) {
      map.first.push_back(labels.place_of(std::string(kAxisStates[0][0]) + Plain::suffix(i)));
      map.load_force.push_back(labels.place_of("load_force" + Plain::suffix(i)));
      map.bristle.push_back(
          labels.place_of("bearing" + std::to_string(i / 2 + 1) + (i % 2 == 0 ? ".bristle_pitch" : ".bristle_yaw")));
    }
    for (const auto& own : labels.all()) {
      map.states.push_back(own.quantity);
      map.continuous.push_back(own.continuous);
    }
  }

  /// Port `index` of all, `kSitePorts` an axis.
  template <class Any>
  static typename Any::Scalar& port(typename Any::State& state, std::size_t index) {
    auto& values = Any::axis(state, index / kSitePorts).effects.values;
    typename Any::Scalar* found = nullptr;
    std::size_t left = index % kSitePorts;
    Any::Axis::Effects::for_each([&]<class E, std::size_t I>() {
      if constexpr (is_port<E>) {
        found = left == 0 ? &std::get<I>(values).added : found;
        --left;
      }
    });
    return *found;
  }

  /// The laws of an axis beyond its linear parts: without its structure and its sensors.
  typename Plain::Axis::Parameters parameters_of_laws(std::size_t i) const {
    auto own = Plain::axis(*model_, static_cast<int>(i)).parameters();
    Plain::Axis::Effects::for_each([&]<class E, std::size_t I>() {
      own.effects.active[I] =
          own.effects.active[I] && E::site != model::Site::structure && E::site != model::Site::sensor && !is_port<E>;
    });
    return own;
  }

  const Laws& laws_at(double frequency, int harmonics, std::size_t i) const {
    auto& own = laws_[i];
    if (!own.laws || own.frequency != frequency || own.harmonics != harmonics) {
      own.laws.emplace(parameters_of_laws(i), frequency, harmonics, Plain::axis(*rest_, i), commands_[i]);
      own.frequency = frequency;
      own.harmonics = harmonics;
    }
    return *own.laws;
  }

  /// By how much the flow of the declared orifices follows spool and load pressure beyond rated_flow times the spool
  /// [m^3/s, m^3/s/Pa]: what `linear_parts` has of it.
  std::array<double, 2> flow_slopes(std::size_t i) const {
    auto bare = parameters_of_laws(i);
    bare.effects.active = {};
    constexpr double kAnyFrequency = 1.0;
    constexpr int kOne = 1;
    const Laws laws(bare, kAnyFrequency, kOne, Plain::axis(*rest_, i), commands_[i]);
    const auto slope = [&](int state, double size) {
      AxisWaves moved;
      moved.states[static_cast<std::size_t>(state)].fundamental() = size;
      return laws.respond(moved, Wave{})[kFlowPort].fundamental().real() / size;
    };
    // Far below what opens a valve or loads a piston, far above rounding.
    return {slope(model::AxisStates::kOpening, 1e-8), slope(model::AxisStates::kPressure, 1e-2)};
  }

  /// What the friction of an engine's bearing depends on at rest.
  model::BearingCondition<double> condition_of(std::size_t e) const {
    const auto& bearing = parameters_.vehicle.gimbals[e].bearing;
    const auto pose = model_->geometry(static_cast<int>(e))
                          .at(rests_[2 * e][model::AxisStates::kAngle], rests_[2 * e + 1][model::AxisStates::kAngle]);
    const model::Vector3<double> force = pose.thrust * (bearing.thrust + bearing.dead_load) +
                                         pose.direction[0] * rest_->plant.axes[2 * e].spring_force +
                                         pose.direction[1] * rest_->plant.axes[2 * e + 1].spring_force;
    return {force.norm(), bearing.vibration_under(bearing.thrust)};
  }

  struct LawsAt {
    double frequency = 0.0;
    int harmonics = 0;
    std::optional<Laws> laws{};
  };

  plant::ParameterTable table_{};
  typename Plain::Parameters parameters_{};
  std::vector<plant::Variable> inputs_{};
  std::vector<Delay> delays_{};
  std::vector<double> commands_{};
  std::vector<double> loads_{};
  double h_ = 0.0;
  bool holds_ = false;             ///< something may hold a piston or an engine for a part of a cycle: friction
  double engine_frequency_ = 0.0;  ///< of the engine that swings fastest on its load spring [Hz]
  std::optional<typename Plain::Model> model_{};
  std::unique_ptr<State> rest_{};
  std::array<std::array<double, 8>, kAxes> rests_{};
  std::array<std::array<double, 2>, kAxes> flow_slopes_{};
  mutable std::array<LawsAt, kAxes> laws_{};
};

}  // namespace hotfire::linear
