// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/jet.h>

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "hal/arithmetic/denormals.hpp"
#include "tools/interface/plant/copy_state.hpp"
#include "tools/interface/plant/parameter_table.hpp"
#include "tools/interface/plant/plant.hpp"

namespace hotfire::plant {

/// Constants and state of a model begin with a cache line: where memory puts them then makes no difference to the time of a
/// step, which reads them four numbers at once.
inline constexpr std::size_t kCacheLine = 64;

/// A plant in one scalar: parameters with their places in the table, and the model with its constants.
template <class Adapter, class S>
class Instance {
 public:
  using Parameters = typename Adapter::Parameters;
  using State = typename Adapter::State;

  explicit Instance(const ParameterTable& table) {
    ParameterSlots<S> slots(table);
    Adapter::visit(parameters_, slots);
    slots_ = slots.take();
  }

  Parameters& parameters() noexcept { return parameters_; }
  const Parameters& parameters() const noexcept { return parameters_; }
  std::span<S* const> slots() const noexcept { return slots_; }

  /// Computes the model's constants from the parameters.
  void build(double period, int steps) noexcept { model_.emplace(Adapter::of_model(parameters_), period / steps); }
  const typename Adapter::Model& model() const noexcept { return *model_; }

 private:
  Parameters parameters_{};
  std::vector<S*> slots_{};
  alignas(kCacheLine) std::optional<typename Adapter::Model> model_{};
};

/// A plant of one topology: `Adapter<S>` says what the topology is in a scalar S.
template <template <class> class Adapter>
class PlantOf final : public Plant {
  using Dual = ceres::Jet<double, 1>;
  using Plain = Adapter<double>;
  using Moved = Adapter<Dual>;
  using State = typename Plain::State;
  // A state is saved as bytes.
  static_assert(std::is_trivially_destructible_v<State>);

 public:
  static std::unique_ptr<Plant> make(const typename Plain::Parameters& parameters, const Setup& setup) {
    ParameterTable table;
    Plain::visit(parameters, table);
    return std::unique_ptr<Plant>(new PlantOf(table, parameters, setup));
  }

  std::string_view topology() const noexcept override { return Plain::Model::topology; }

  std::string_view set_parameters(std::span<const double> values) noexcept override {
    fill(values);
    if (const std::string_view broken = Plain::broken(plain_.parameters()); !broken.empty()) {
      fill(parameter_values_);
      return broken;
    }
    std::copy(values.begin(), values.end(), parameter_values_.begin());
    build();
    return {};
  }

  bool start(double time) noexcept override {
    start_time_ = time;
    periods_ = 0;
    state_ = Plain::first_state(plain_.parameters(), setup_);
    Plain::settle(plain_.model(), state_, input_values_, plain_.parameters(), further(), time);
    const hal::FlushDenormals flush;
    Plain::begin_reading(state_, plain_.parameters());
    Plain::read(state_, period(), output_values_);
    return is_sane();
  }

  bool advance() noexcept override {
    const hal::FlushDenormals flush;
    for (int step = 0; step < steps_; ++step) {
      Plain::step(plain_.model(), state_, input_values_, plain_.parameters());
    }
    ++periods_;
    Plain::read(state_, period(), output_values_);
    return is_sane();
  }

  void differentiate(std::span<const Seed> seeds, std::span<double> sensitivity) noexcept override {
    move(seeds);
    copy_state(state_.plant, dual_state_->plant);
    const hal::FlushDenormals flush;
    Moved::begin_reading(*dual_state_, dual_.parameters());
    for (int step = 0; step < steps_; ++step) {
      step_slopes();
    }
    read_slopes(sensitivity);
  }

  void differentiate_start(double time, std::span<const Seed> seeds, std::span<double> sensitivity) noexcept override {
    start_slopes(time, seeds);
    read_slopes(sensitivity);
  }

  void start_slopes(double time, std::span<const Seed> seeds) noexcept override {
    move(seeds);
    Moved::settle(dual_.model(), *dual_state_, dual_inputs_, dual_.parameters(), dual_further_, time);
    const hal::FlushDenormals flush;
    Moved::begin_reading(*dual_state_, dual_.parameters());
  }

  void step_slopes() noexcept override {
    for (std::size_t i = 0; i < dual_inputs_.size(); ++i) {
      dual_inputs_[i].a = input_values_[i];
    }
    const hal::FlushDenormals flush;
    Moved::step(dual_.model(), *dual_state_, dual_inputs_, dual_.parameters());
  }

  void read_slopes(std::span<double> sensitivity) noexcept override {
    const hal::FlushDenormals flush;
    Moved::read(*dual_state_, period(), dual_outputs_);
    for (std::size_t i = 0; i < sensitivity.size(); ++i) {
      sensitivity[i] = dual_outputs_[i].v[0];
    }
  }

 protected:
  std::span<std::byte> block() noexcept override { return std::as_writable_bytes(std::span(&state_, 1)); }
  void use_parameters() noexcept override {
    fill(parameter_values_);
    build();
  }
  std::span<const std::byte> block() const noexcept override { return std::as_bytes(std::span(&state_, 1)); }

 private:
  PlantOf(const ParameterTable& table, const typename Plain::Parameters& parameters, const Setup& setup)
      : Plant(setup),
        plain_(table),
        dual_(table),
        state_(Plain::first_state(parameters, setup)),
        dual_state_(std::make_unique<typename Adapter<Dual>::State>(Adapter<Dual>::first_state(dual_.parameters(), setup))) {
    inputs_ = Plain::inputs(parameters);
    outputs_ = Plain::outputs(setup);
    parameters_ = table.variables();
    for (const Variable& variable : Plain::further_parameters()) {
      parameters_.push_back(variable);
    }
    dual_inputs_.resize(inputs_.size());
    dual_outputs_.resize(outputs_.size());
    dual_further_.resize(parameters_.size() - table.variables().size());
    Fingerprint fingerprint;
    fingerprint.add(Plain::Model::topology);
    fingerprint.add(setup.period);
    fingerprint.add(static_cast<double>(setup.seed));
    fingerprint.add(static_cast<double>(sizeof(State)));
    complete_tables(fingerprint.value() ^ table.fingerprint());
    build();
  }

  /// Inputs, parameters and model in dual numbers: their values, moved by the seeds.
  void move(std::span<const Seed> seeds) noexcept {
    for (std::size_t i = 0; i < dual_inputs_.size(); ++i) {
      dual_inputs_[i] = Dual(input_values_[i]);
    }
    for (std::size_t i = 0; i < dual_further_.size(); ++i) {
      dual_further_[i] = Dual(further()[i]);
    }
    bool rebuild = !dual_is_current_;
    for (std::size_t i = 0; !dual_is_current_ && i < dual_.slots().size(); ++i) {
      *dual_.slots()[i] = Dual(parameter_values_[i]);
    }
    dual_is_current_ = true;
    for (const Seed& seed : seeds) {
      if (seed.kind == Seed::Kind::input) {
        dual_inputs_[seed.index].v[0] += seed.value;
      } else if (seed.index < dual_.slots().size()) {
        dual_.slots()[seed.index]->v[0] += seed.value;
        rebuild = true;
        dual_is_current_ = false;
      } else {
        dual_further_[seed.index - dual_.slots().size()].v[0] += seed.value;
      }
    }
    Moved::smooth(dual_.parameters());
    if (rebuild) {
      dual_.build(period(), steps_);
    }
  }

  /// Parameters beyond those of the model.
  std::span<const double> further() const noexcept {
    return std::span<const double>(parameter_values_).subspan(plain_.slots().size());
  }

  void fill(std::span<const double> values) noexcept {
    for (std::size_t i = 0; i < plain_.slots().size(); ++i) {
      *plain_.slots()[i] = values[i];
    }
  }

  void build() noexcept {
    steps_ = Plain::steps(Plain::of_model(plain_.parameters()), period());
    plain_.build(period(), steps_);
    dual_is_current_ = false;
  }

  bool is_sane() const noexcept {
    for (const double value : output_values_) {
      if (!(std::abs(value) < kRunaway)) {
        return false;
      }
    }
    return true;
  }

  Instance<Plain, double> plain_;
  Instance<Adapter<Dual>, Dual> dual_;
  alignas(kCacheLine) State state_;
  std::unique_ptr<typename Adapter<Dual>::State> dual_state_;
  std::vector<Dual> dual_inputs_{};
  std::vector<Dual> dual_outputs_{};
  std::vector<Dual> dual_further_{};
  bool dual_is_current_ = false;  ///< its parameters are those of the plant, without derivatives
};

}  // namespace hotfire::plant
