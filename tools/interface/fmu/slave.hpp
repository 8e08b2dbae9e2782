// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/checks.hpp"
#include "tools/interface/c/hotfire.h"
#include "tools/interface/c/model_handle.hpp"
#include "tools/interface/plant/plant.hpp"

namespace hotfire::fmu {

/// What a function of FMI 2.0 or 3.0 returns: both standards have these numbers.
enum class Status { ok = 0, warning = 1, discard = 2, error = 3, fatal = 4 };

/// The states of a co-simulation FMU that both standards have.
enum class Phase : std::uint32_t { instantiated, initialization, step, terminated, failed };

/// Categories of log messages, as modelDescription.xml names them.
inline constexpr std::array<const char*, 3> kCategories{"logStatusError", "logStatusDiscard", "logEvents"};
enum class Category { error, discard, event };

/// Gives a message to the importer.
using Log = void (*)(void* instance, Status status, const char* category, const char* message);

/// The numbers of the model as value references: 0 is time, then inputs, outputs and parameters in the order of their
/// tables.
using Reference = std::uint32_t;
inline constexpr Reference kTime = 0;
inline constexpr Reference kFirstInput = 1;

/// A communication point may be this part of a period before a multiple of the period, and is taken for it: an importer that
/// adds up its steps is never exact.
inline constexpr double kEarly = 1e-3;

/// What both versions of the standard have in common: one model, its phase and its communication time. Every function checks
/// that the phase allows it. No allocation but in `open` and `saved`.
class Slave {
 public:
  /// `text` is resources/plant.txt of the FMU: its token, then a plant text. Null with a message if it is refused.
  static std::unique_ptr<Slave> open(const std::string& text, const char* token, Log log, void* instance,
                                     std::string& message);
  ~Slave();
  Slave(const Slave&) = delete;
  Slave& operator=(const Slave&) = delete;

  /// Turns messages of all categories on or off, or of those that are named.
  Status set_logging(bool on, std::span<const char* const> categories) noexcept;

  Status set_up(double start, bool stop_defined, double stop) noexcept;
  Status enter_initialization() noexcept;
  Status exit_initialization() noexcept;
  Status terminate() noexcept;
  Status reset() noexcept;

  // These three are most of the calls of an importer: what they do in step mode is in this header, so that a function of the
  // standard is one function.
  Status set(std::span<const Reference> references, std::span<const double> values) noexcept;
  Status get(std::span<const Reference> references, std::span<double> values) noexcept;

  /// Advances to `current` + `step`: the model by its whole periods up to there. Outputs are those of the last of them.
  Status do_step(double current, double step) noexcept;
  double last_successful_time() const noexcept { return time_; }

  /// In initialization mode the derivatives of the outputs at the start, then those of the outputs after one internal step.
  Status differentiate(std::span<const Reference> unknowns, std::span<const Reference> knowns, std::span<const double> seed,
                       std::span<double> sensitivity) noexcept;

  /// The state as bytes.
  std::size_t saved_size() const noexcept;
  Status save(std::span<std::byte> bytes) noexcept;
  Status load(std::span<const std::byte> bytes) noexcept;

  /// Logs a failure. `error` makes the instance unusable until it is reset or gets a state; `discard` does not.
  [[gnu::cold]] Status refuse(Status status, const char* function, const char* problem) noexcept;

 private:
  struct Place {
    hotfire_kind kind;
    std::size_t index;
  };
  struct Saved;

  Slave(hotfire_model* model, Log log, void* instance);

  bool find(Reference reference, Place& place) const noexcept;
  // What is cold stays a function of its own: the calls of every step then need no stack for it.
  Status refuse_reference(const char* function, Reference reference) noexcept;
  [[gnu::cold]] Status refuse_phase(const char* function) noexcept;
  Status refuse_model(const char* function, hotfire_status status) noexcept;
  Status start_if_needed(const char* function) noexcept;
  /// What `set` and `get` do beside inputs and outputs in step mode, which are most of the calls.
  [[gnu::cold]] Status set_any(std::span<const Reference> references, std::span<const double> values) noexcept;
  [[gnu::cold]] Status get_any(std::span<const Reference> references, std::span<double> values) noexcept;
  /// Why a step is refused.
  [[gnu::cold]] Status refuse_step(double current, double step) noexcept;
  /// A step that ended early: the time is that of the last period before.
  [[gnu::cold]] Status refuse_run() noexcept;
  Status set_of_kind(hotfire_kind kind, std::span<const Reference> references, std::span<const double> values) noexcept;
  /// A point that is not a number is near to none.
  bool is_reached(double point) const noexcept { return std::abs(point - time_) <= early_; }
  /// Where the last step ends at the latest: at the stop time, or at the last finite time.
  double latest_end() const noexcept { return stop_defined_ ? stop_ + early_ : std::numeric_limits<double>::max(); }
  void say(Status status, Category category, const char* message) noexcept;

  hotfire_model* model_;
  Log log_;
  void* instance_;
  std::array<bool, kCategories.size()> logged_{true, true, false};
  std::array<std::size_t, 3> counts_{};  ///< of the tables
  Phase phase_ = Phase::instantiated;
  bool current_ = false;  ///< the model has been started under the present values
  bool set_up_ = false;   ///< the start time is known
  double start_ = 0.0;
  double period_;  ///< of the plant [s]
  double early_;   ///< `kEarly` of it
  bool stop_defined_ = false;
  double stop_ = 0.0;
  double latest_end_ = std::numeric_limits<double>::max();
  double time_ = 0.0;  ///< the communication point that was reached; of a step that failed, where the model is
  std::uint64_t periods_ = 0;
  struct Bounds {
    double lower;
    double upper;
  };
  std::vector<Bounds> input_bounds_;
  // Of the plant, which keeps them in one place.
  std::span<double> inputs_;
  std::span<const double> outputs_;
  // Room for the arguments of the C interface.
  std::vector<std::size_t> indices_;
  std::vector<double> values_;
  std::vector<plant::Seed> seeds_;
  std::vector<double> sensitivity_;
};

inline Status Slave::set(std::span<const Reference> references, std::span<const double> values) noexcept {
  if (phase_ != Phase::step || references.size() != values.size() || references.data() == nullptr ||
      values.data() == nullptr) {
    return set_any(references, values);
  }
  for (std::size_t i = 0; i < references.size(); ++i) {
    const std::size_t index = references[i] - kFirstInput;
    if (index >= inputs_.size() || !model::is_inside(values[i], input_bounds_[index].lower, input_bounds_[index].upper)) {
      return set_any(references, values);
    }
  }
  for (std::size_t i = 0; i < references.size(); ++i) {
    inputs_[references[i] - kFirstInput] = values[i];
  }
  return Status::ok;
}

inline Status Slave::get(std::span<const Reference> references, std::span<double> values) noexcept {
  if (phase_ != Phase::step || references.size() != values.size() || references.data() == nullptr ||
      values.data() == nullptr) {
    return get_any(references, values);
  }
  const std::size_t first = kFirstInput + inputs_.size();
  for (std::size_t i = 0; i < references.size(); ++i) {
    const std::size_t index = references[i] - first;
    if (index >= outputs_.size()) {
      return get_any(references, values);
    }
    values[i] = outputs_[index];
  }
  return Status::ok;
}

inline Status Slave::do_step(double current, double step) noexcept {
  const double end = current + step;
  if (phase_ != Phase::step || !(step > 0.0) || !is_reached(current) || !(end <= latest_end_)) {
    return refuse_step(current, step);
  }
  // No run has more periods than a double counts.
  const auto wanted =
      static_cast<std::uint64_t>(static_cast<std::int64_t>(std::min((end - start_) / period_ + kEarly, 0x1p53)));
  time_ = end;
  while (periods_ < wanted) {
    if (interface::step(*model_) != HOTFIRE_OK) {
      return refuse_run();
    }
    ++periods_;
  }
  return Status::ok;
}

/// The text in resources/plant.txt of a folder, or what was compiled into the FMU. Throws std::runtime_error.
std::string plant_document(const std::string& resources);

/// The folder of a file URI: "file:///a/b%20c" gives "/a/b c". Throws std::runtime_error.
std::string path_of_uri(const std::string& uri);

/// Compiled into an FMU from its sources: the plant, so that a target needs no files. Null where it is read from resources/.
extern const char* const kCompiledPlant;

}  // namespace hotfire::fmu
