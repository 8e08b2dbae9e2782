// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/fmu/slave.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

#include "tools/interface/c/model_handle.hpp"
#include "tools/interface/c/saved_state.hpp"

namespace hotfire::fmu {

/// What a state has beyond that of the model.
struct Slave::Saved {
  std::uint32_t phase;
  std::uint32_t current;
  std::uint32_t set_up;
  std::uint32_t stop_defined;
  std::uint64_t periods;
  double start;
  double stop;
  double time;
  std::uint64_t fingerprint;  ///< of all above; the model's own bytes have theirs

  std::uint64_t expected() const noexcept {
    return interface::fingerprint_of(0, std::as_bytes(std::span(this, 1)).first(offsetof(Saved, fingerprint)));
  }
};

std::unique_ptr<Slave> Slave::open(const std::string& text, const char* token, Log log, void* instance,
                                   std::string& message) {
  constexpr std::string_view kKey = "token ";
  const std::size_t end = text.find('\n');
  if (!text.starts_with(kKey) || end == std::string::npos) {
    message = "resources/plant.txt: line 1: expected `token value`; unpack the FMU again";
    return nullptr;
  }
  const std::string own = text.substr(kKey.size(), end - kKey.size());
  if (token == nullptr || own != token) {
    message = std::string("the token of the importer is ") + (token == nullptr ? "missing" : token) + "; allowed: " + own +
              ", as modelDescription.xml says";
    return nullptr;
  }
  std::array<char, 512> problem{};
  hotfire_model* model = nullptr;
  if (hotfire_open_plant(text.c_str() + end + 1, "resources/plant.txt", &model, problem.data(), problem.size()) !=
      HOTFIRE_OK) {
    message = problem.data();
    return nullptr;
  }
  return std::unique_ptr<Slave>(new Slave(model, log, instance));
}

Slave::Slave(hotfire_model* model, Log log, void* instance)
    : model_(model), log_(log), instance_(instance), period_(model->plant->period()), early_(kEarly * period_) {
  for (const hotfire_kind kind : {HOTFIRE_INPUT, HOTFIRE_OUTPUT, HOTFIRE_PARAMETER}) {
    counts_.at(kind) = hotfire_count(model, kind);
  }
  const std::size_t variables = counts_[HOTFIRE_INPUT] + counts_[HOTFIRE_OUTPUT] + counts_[HOTFIRE_PARAMETER];
  indices_.resize(variables);
  values_.resize(variables);
  seeds_.resize(variables);
  sensitivity_.resize(counts_[HOTFIRE_OUTPUT]);
  for (const plant::Variable& input : model->plant->inputs()) {
    input_bounds_.push_back({input.lower, input.upper});
  }
  inputs_ = model->plant->input_values();
  outputs_ = model->plant->output_values();
}

Slave::~Slave() { hotfire_close(model_); }

void Slave::say(Status status, Category category, const char* message) noexcept {
  const auto index = static_cast<std::size_t>(category);
  if (log_ != nullptr && logged_.at(index)) {
    log_(instance_, status, kCategories.at(index), message);
  }
}

Status Slave::refuse(Status status, const char* function, const char* problem) noexcept {
  std::array<char, 640> message{};
  std::snprintf(message.data(), message.size(), "%s: %s", function, problem);
  say(status, status == Status::discard ? Category::discard : Category::error, message.data());
  if (status == Status::error && phase_ != Phase::terminated) {
    phase_ = Phase::failed;
  }
  return status;
}

Status Slave::refuse_phase(const char* function) noexcept {
  constexpr std::array<const char*, 5> kNames{"instantiated", "in initialization mode", "in step mode", "terminated",
                                              "failed: reset it or set a state"};
  std::array<char, 128> problem{};
  std::snprintf(problem.data(), problem.size(), "is not allowed now; the instance is %s",
                kNames.at(static_cast<std::size_t>(phase_)));
  return refuse(Status::error, function, problem.data());
}

Status Slave::refuse_reference(const char* function, Reference reference) noexcept {
  std::array<char, 128> problem{};
  std::snprintf(problem.data(), problem.size(),
                "value reference %u: no such variable for this call; see modelDescription.xml", reference);
  return refuse(Status::error, function, problem.data());
}

Status Slave::refuse_model(const char* function, hotfire_status status) noexcept {
  return refuse(status == HOTFIRE_BAD_DATA ? Status::discard : Status::error, function, hotfire_message(model_));
}

Status Slave::set_logging(bool on, std::span<const char* const> categories) noexcept {
  if (categories.data() == nullptr && !categories.empty()) {
    return refuse(Status::error, "SetDebugLogging", "the categories are missing");
  }
  std::array<bool, kCategories.size()> wanted{};
  wanted.fill(on && categories.empty());
  if (!on && categories.empty()) {
    logged_ = {true, true, false};
    return Status::ok;
  }
  if (!categories.empty()) {
    wanted = logged_;
  }
  for (const char* category : categories) {
    const auto found = std::find_if(kCategories.begin(), kCategories.end(), [category](const char* own) {
      return category != nullptr && std::strcmp(own, category) == 0;
    });
    if (found == kCategories.end()) {
      return refuse(Status::error, "SetDebugLogging",
                    "unknown category; allowed: logStatusError, logStatusDiscard, logEvents");
    }
    wanted.at(static_cast<std::size_t>(found - kCategories.begin())) = on;
  }
  logged_ = wanted;
  return Status::ok;
}

Status Slave::set_up(double start, bool stop_defined, double stop) noexcept {
  if (phase_ != Phase::instantiated) {
    return refuse_phase("setting up the experiment");
  }
  if (!std::isfinite(start) || (stop_defined && !(stop > start))) {
    return refuse(Status::error, "setting up the experiment",
                  "start or stop time; allowed: a finite start time, and a stop time after it");
  }
  set_up_ = true;
  start_ = start;
  time_ = start;
  stop_defined_ = stop_defined;
  stop_ = stop;
  latest_end_ = latest_end();
  return Status::ok;
}

Status Slave::enter_initialization() noexcept {
  if (phase_ != Phase::instantiated) {
    return refuse_phase("EnterInitializationMode");
  }
  if (!set_up_) {
    return refuse(Status::error, "EnterInitializationMode", "the start time is unknown; call SetupExperiment first");
  }
  phase_ = Phase::initialization;
  return Status::ok;
}

Status Slave::start_if_needed(const char* function) noexcept {
  if (current_) {
    return Status::ok;
  }
  if (const hotfire_status status = hotfire_start(model_, start_); status != HOTFIRE_OK) {
    return refuse(Status::error, function, hotfire_message(model_));
  }
  current_ = true;
  periods_ = 0;
  return Status::ok;
}

Status Slave::exit_initialization() noexcept {
  if (phase_ != Phase::initialization) {
    return refuse_phase("ExitInitializationMode");
  }
  const Status status = start_if_needed("ExitInitializationMode");
  if (status == Status::ok) {
    phase_ = Phase::step;
    say(Status::ok, Category::event, "the model is in its steady state");
  }
  return status;
}

Status Slave::terminate() noexcept {
  if (phase_ != Phase::step) {
    return refuse_phase("Terminate");
  }
  phase_ = Phase::terminated;
  say(Status::ok, Category::event, "the run is over");
  return Status::ok;
}

Status Slave::reset() noexcept {
  model_->started = false;
  current_ = false;
  phase_ = Phase::instantiated;
  for (const hotfire_kind kind : {HOTFIRE_INPUT, HOTFIRE_PARAMETER}) {
    for (std::size_t i = 0; i < counts_.at(kind); ++i) {
      hotfire_variable variable{};
      hotfire_describe(model_, kind, i, &variable);
      indices_[i] = i;
      values_[i] = variable.start;
    }
    if (const hotfire_status status = hotfire_set(model_, kind, indices_.data(), values_.data(), counts_.at(kind));
        status != HOTFIRE_OK) {
      return refuse(Status::error, "Reset", hotfire_message(model_));
    }
  }
  start_ = time_ = 0.0;
  set_up_ = false;
  stop_defined_ = false;
  latest_end_ = latest_end();
  say(Status::ok, Category::event, "the instance is as it was made");
  return Status::ok;
}

Status Slave::refuse_step(double current, double step) noexcept {
  if (phase_ != Phase::step) {
    return refuse_phase("DoStep");
  }
  if (!(step > 0.0 && step <= std::numeric_limits<double>::max())) {
    return refuse(Status::error, "DoStep", "communicationStepSize; allowed: a finite number above 0");
  }
  if (is_reached(current)) {
    return refuse(Status::error, "DoStep", "the step ends after the stop time of the experiment; allowed: up to it");
  }
  std::array<char, 160> problem{};
  std::snprintf(problem.data(), problem.size(),
                "currentCommunicationPoint = %.17g: allowed: %.17g, where the last step ended", current, time_);
  return refuse(Status::error, "DoStep", problem.data());
}

Status Slave::refuse_run() noexcept {
  time_ = start_ + static_cast<double>(periods_) * period_;
  return refuse(Status::error, "DoStep", hotfire_message(model_));
}

std::size_t Slave::saved_size() const noexcept { return sizeof(Saved) + hotfire_state_size(model_); }

Status Slave::save(std::span<std::byte> bytes) noexcept {
  if (bytes.size() < saved_size()) {
    return refuse(Status::error, "saving a state", "too few bytes; allowed: as many as the size of the state");
  }
  Saved saved{static_cast<std::uint32_t>(phase_),
              current_ ? 1U : 0U,
              set_up_ ? 1U : 0U,
              stop_defined_ ? 1U : 0U,
              periods_,
              start_,
              stop_,
              time_,
              0};
  saved.fingerprint = saved.expected();
  std::memcpy(bytes.data(), &saved, sizeof saved);
  hotfire_save(model_, bytes.data() + sizeof saved, bytes.size() - sizeof saved);
  return Status::ok;
}

Status Slave::load(std::span<const std::byte> bytes) noexcept {
  Saved saved{};
  if (bytes.size() < sizeof saved) {
    return refuse(Status::error, "setting a state", "too few bytes for a state of this FMU");
  }
  std::memcpy(&saved, bytes.data(), sizeof saved);
  if (saved.fingerprint != saved.expected()) {
    return refuse(Status::error, "setting a state", "a damaged state, or not one of this FMU");
  }
  if (hotfire_load(model_, bytes.data() + sizeof saved, bytes.size() - sizeof saved) != HOTFIRE_OK) {
    return refuse(Status::error, "setting a state", hotfire_message(model_));
  }
  phase_ = static_cast<Phase>(saved.phase);
  current_ = saved.current == 1;
  set_up_ = saved.set_up == 1;
  stop_defined_ = saved.stop_defined == 1;
  periods_ = saved.periods;
  start_ = saved.start;
  stop_ = saved.stop;
  latest_end_ = latest_end();
  time_ = saved.time;
  return Status::ok;
}

}  // namespace hotfire::fmu
