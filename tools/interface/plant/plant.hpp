// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "model/direct.hpp"
#include "model/electromechanical.hpp"
#include "model/imposed_motion.hpp"
#include "model/modal.hpp"
#include "model/sensors/vehicle_sensors.hpp"
#include "model/simplex.hpp"
#include "model/vehicle.hpp"
#include "tools/interface/plant/variable.hpp"

namespace hotfire::plant {

/// A reading beyond this is a plant that ran away, in any unit.
inline constexpr double kRunaway = 1e12;

/// The parameters of a plant of any topology.
using AnyParameters =
    std::variant<model::Simplex<double>::Parameters, model::Direct<double>::Parameters,
                 model::ImposedMotion<double>::Parameters, model::Modal<double>::Parameters,
                 model::Electromechanical<double>::Parameters, model::InstrumentedVehicle<model::Taos<double>>,
                 model::InstrumentedVehicle<model::Masv<double>>>;

/// How a plant is run.
struct Setup {
  double period = 1e-3;  ///< between two readings [s]; split into equal steps of the model (model/numerics/step_size.hpp)
  unsigned seed = 1;     ///< of the sensors' noise
  bool strings = false;  ///< the model declares string potentiometers: they are outputs
};

/// What a derivative is taken of, or by.
struct Seed {
  enum class Kind { input, parameter } kind;
  std::size_t index;
  double value;
};

/// A plant of any topology behind tables of variables: inputs held over a period, readings at its end. The same input gives
/// the same bits as `hotfire simulate`.
///
/// A plant allocates when it is made and never again: `start`, `advance`, `differentiate`, `set_parameters` and the copies
/// of its state take no memory. A plant has no state outside of itself. One thread at a time may use it; different plants
/// are independent.
class Plant {
 public:
  virtual ~Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  virtual std::string_view topology() const noexcept = 0;
  double period() const noexcept { return setup_.period; }
  int steps() const noexcept { return steps_; }  ///< of the model in a period

  const std::vector<Variable>& inputs() const noexcept { return inputs_; }
  const std::vector<Variable>& outputs() const noexcept { return outputs_; }
  const std::vector<Variable>& parameters() const noexcept { return parameters_; }

  std::span<double> input_values() noexcept { return input_values_; }
  std::span<const double> output_values() const noexcept { return output_values_; }
  std::span<const double> parameter_values() const noexcept { return parameter_values_; }

  /// Takes new values of all parameters, in the order of `parameters`, each within its bounds. Returns what relation between
  /// them is broken, and changes nothing then; empty if none is. Computes the model's constants again: set-up work, without
  /// allocation, in a bounded time.
  virtual std::string_view set_parameters(std::span<const double> values) noexcept = 0;

  /// Starts at `time` [s] in the steady state under the inputs: set-up work. A `direct` mass starts where its parameters
  /// say. False if that is not finite.
  virtual bool start(double time) noexcept = 0;

  /// Advances by one period with the inputs held, and reads. False if a reading is not finite or ran away.
  virtual bool advance() noexcept = 0;

  /// Periods since the start; the time is start + periods * period.
  std::uint64_t periods() const noexcept { return periods_; }
  double start_time() const noexcept { return start_time_; }
  double time() const noexcept { return start_time_ + static_cast<double>(periods_) * setup_.period; }

  /// By how much the outputs at the end of the next period move when inputs and parameters move by the seeds, by dual
  /// numbers: exact. The present state and the other inputs are given. A reading is taken without its noise and steps.
  /// `sensitivity` has a place for every output. Set-up work, without allocation, in a bounded time.
  virtual void differentiate(std::span<const Seed> seeds, std::span<double> sensitivity) noexcept = 0;

  /// The same of the outputs that `start(time)` reads.
  virtual void differentiate_start(double time, std::span<const Seed> seeds, std::span<double> sensitivity) noexcept = 0;

  /// The derivatives along a whole run, its start included, when parameters move by the seeds: exact, by dual numbers.
  /// `start_slopes` starts at `time` under the inputs. `step_slopes` advances by one step of the model, `steps` of which
  /// make a period, under the inputs as they are then. `read_slopes` gives by how much the outputs move, at the start and
  /// once a period. The plant's own run stays as it is. `differentiate` and `differentiate_start` end such a run. No
  /// allocation.
  virtual void start_slopes(double time, std::span<const Seed> seeds) noexcept = 0;
  virtual void step_slopes() noexcept = 0;
  virtual void read_slopes(std::span<double> sensitivity) noexcept = 0;

  /// What a plant is in the middle of a run: inputs, outputs, parameters and the model's state, as bytes of this build for
  /// this machine. `load` is for bytes of `save` of a plant with the same `identity`.
  std::size_t state_size() const noexcept;
  void save(std::span<std::byte> bytes) const noexcept;
  void load(std::span<const std::byte> bytes) noexcept;
  /// Identifies models whose states are exchangeable.
  std::uint64_t identity() const noexcept { return identity_; }

 protected:
  explicit Plant(const Setup& setup) : setup_(setup) {}

  /// The model's own state as one block.
  virtual std::span<std::byte> block() noexcept = 0;
  virtual std::span<const std::byte> block() const noexcept = 0;

  /// Computes the model's constants from `parameter_values_`.
  virtual void use_parameters() noexcept = 0;

  /// Fills the values from the tables' start values. Called once, when the tables are complete.
  void complete_tables(std::uint64_t identity);

  Setup setup_;
  int steps_ = 1;
  std::uint64_t periods_ = 0;
  double start_time_ = 0.0;
  std::uint64_t identity_ = 0;
  std::vector<Variable> inputs_{};
  std::vector<Variable> outputs_{};
  std::vector<Variable> parameters_{};
  std::vector<double> input_values_{};
  std::vector<double> output_values_{};
  std::vector<double> parameter_values_{};
};

/// The plant of some parameters: the one place where a topology is chosen. Their reader has checked the parameters.
std::unique_ptr<Plant> make_plant(const AnyParameters& parameters, const Setup& setup);

// One for each topology, each in a file of its own.
std::unique_ptr<Plant> make_plant(const model::Simplex<double>::Parameters& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::Direct<double>::Parameters& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::ImposedMotion<double>::Parameters& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::Modal<double>::Parameters& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::Electromechanical<double>::Parameters& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Taos<double>>& parameters, const Setup& setup);
std::unique_ptr<Plant> make_plant(const model::InstrumentedVehicle<model::Masv<double>>& parameters, const Setup& setup);

}  // namespace hotfire::plant
