// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "model/checks.hpp"
#include "tools/interface/c/model_handle.hpp"
#include "tools/interface/fmu/slave.hpp"

namespace hotfire::fmu {

namespace {

constexpr const char* kMissing = "an argument is missing: a null pointer is valid only for no values";

template <class T>
bool is_missing(std::span<T> values) noexcept {
  return values.data() == nullptr && !values.empty();
}

}  // namespace

bool Slave::find(Reference reference, Place& place) const noexcept {
  if (reference < kFirstInput) {
    return false;
  }
  std::size_t index = reference - kFirstInput;
  for (const hotfire_kind kind : {HOTFIRE_INPUT, HOTFIRE_OUTPUT, HOTFIRE_PARAMETER}) {
    if (index < counts_.at(kind)) {
      place = {kind, index};
      return true;
    }
    index -= counts_.at(kind);
  }
  return false;
}

Status Slave::set_of_kind(hotfire_kind kind, std::span<const Reference> references,
                          std::span<const double> values) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    Place place{};
    find(references[i], place);
    if (place.kind == kind) {
      indices_[count] = place.index;
      values_[count++] = values[i];
    }
  }
  if (count == 0) {
    return Status::ok;
  }
  if (phase_ == Phase::initialization) {
    // The start is calculated again with the new values.
    model_->started = false;
    current_ = false;
  }
  const hotfire_status status = hotfire_set(model_, kind, indices_.data(), values_.data(), count);
  return status == HOTFIRE_OK ? Status::ok : refuse_model("setting variables", status);
}

Status Slave::set_any(std::span<const Reference> references, std::span<const double> values) noexcept {
  if (is_missing(references) || is_missing(values)) {
    return refuse(Status::error, "setting variables", kMissing);
  }
  if (phase_ != Phase::instantiated && phase_ != Phase::initialization && phase_ != Phase::step) {
    return refuse_phase("setting variables");
  }
  if (references.size() != values.size() || references.size() > indices_.size()) {
    return refuse(Status::error, "setting variables", "as many values as value references are allowed, each variable once");
  }
  bool are_inputs_inside = true;
  for (std::size_t i = 0; i < references.size(); ++i) {
    Place place{};
    if (!find(references[i], place) || place.kind == HOTFIRE_OUTPUT) {
      return refuse_reference("setting variables", references[i]);
    }
    are_inputs_inside = are_inputs_inside &&
                        (place.kind != HOTFIRE_INPUT ||
                         model::is_inside(values[i], input_bounds_[place.index].lower, input_bounds_[place.index].upper));
  }
  // A refused call changes nothing: a parameter is set only if no input is refused after it.
  if (!are_inputs_inside) {
    return set_of_kind(HOTFIRE_INPUT, references, values);
  }
  const Status status = set_of_kind(HOTFIRE_PARAMETER, references, values);
  return status == Status::ok ? set_of_kind(HOTFIRE_INPUT, references, values) : status;
}

Status Slave::get_any(std::span<const Reference> references, std::span<double> values) noexcept {
  if (is_missing(references) || is_missing(values)) {
    return refuse(Status::error, "getting variables", kMissing);
  }
  if (references.size() != values.size()) {
    return refuse(Status::error, "getting variables", "as many values as value references are allowed");
  }
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i] == kTime) {
      values[i] = time_;
      continue;
    }
    Place place{};
    if (!find(references[i], place)) {
      return refuse_reference("getting variables", references[i]);
    }
    if (place.kind == HOTFIRE_OUTPUT) {
      if (phase_ == Phase::instantiated) {
        return refuse_phase("getting outputs");
      }
      if (const Status status = phase_ == Phase::initialization ? start_if_needed("getting outputs") : Status::ok;
          status != Status::ok) {
        return status;
      }
    }
    if (const hotfire_status status = hotfire_get(model_, place.kind, &place.index, &values[i], 1); status != HOTFIRE_OK) {
      return refuse_model("getting variables", status);
    }
  }
  return Status::ok;
}

Status Slave::differentiate(std::span<const Reference> unknowns, std::span<const Reference> knowns,
                            std::span<const double> seed, std::span<double> sensitivity) noexcept {
  constexpr const char* kName = "GetDirectionalDerivative";
  if (phase_ == Phase::instantiated) {
    return refuse_phase(kName);
  }
  if (is_missing(unknowns) || is_missing(knowns) || is_missing(seed) || is_missing(sensitivity)) {
    return refuse(Status::error, kName, kMissing);
  }
  if (unknowns.size() != sensitivity.size() || knowns.size() != seed.size() || knowns.size() > seeds_.size()) {
    return refuse(Status::error, kName, "as many seeds as knowns and as many places as unknowns are allowed");
  }
  for (std::size_t i = 0; i < knowns.size(); ++i) {
    Place place{};
    if (!find(knowns[i], place) || place.kind == HOTFIRE_OUTPUT) {
      return refuse_reference(kName, knowns[i]);
    }
    using Kind = plant::Seed::Kind;
    seeds_[i] = {place.kind == HOTFIRE_INPUT ? Kind::input : Kind::parameter, place.index, seed[i]};
  }
  for (const Reference unknown : unknowns) {
    if (Place place{}; !find(unknown, place) || place.kind != HOTFIRE_OUTPUT) {
      return refuse_reference(kName, unknown);
    }
  }
  const std::span<const plant::Seed> seeds(seeds_.data(), knowns.size());
  if (phase_ == Phase::initialization) {
    model_->plant->differentiate_start(start_, seeds, sensitivity_);
  } else if (model_->started) {
    model_->plant->differentiate(seeds, sensitivity_);
  } else {
    return refuse_phase(kName);
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    Place place{};
    find(unknowns[i], place);
    sensitivity[i] = sensitivity_[place.index];
  }
  return Status::ok;
}

}  // namespace hotfire::fmu
