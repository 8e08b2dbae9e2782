// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/c/hotfire.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <span>

#include "model/checks.hpp"
#include "tools/interface/c/model_handle.hpp"
#include "tools/interface/c/saved_state.hpp"

using hotfire::plant::Plant;
using hotfire::plant::Seed;
using hotfire::plant::Variable;

namespace {

__attribute__((format(printf, 3, 4))) hotfire_status fail(hotfire_model* model, hotfire_status status, const char* format,
                                                          ...) {
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(model->message.data(), model->message.size(), format, values);
  va_end(values);
  return status;
}

const char* table_name(hotfire_kind kind) {
  return kind == HOTFIRE_INPUT ? "input" : kind == HOTFIRE_OUTPUT ? "output" : "parameter";
}

const std::vector<Variable>* table_of(const hotfire_model* model, hotfire_kind kind) {
  switch (kind) {
    case HOTFIRE_INPUT:
      return &model->plant->inputs();
    case HOTFIRE_OUTPUT:
      return &model->plant->outputs();
    case HOTFIRE_PARAMETER:
      return &model->plant->parameters();
    default:
      return nullptr;
  }
}

std::span<const double> values_of(hotfire_model* model, hotfire_kind kind) {
  return kind == HOTFIRE_INPUT    ? std::span<const double>(model->plant->input_values())
         : kind == HOTFIRE_OUTPUT ? model->plant->output_values()
                                  : model->plant->parameter_values();
}

/// The table, or null with the message written.
const std::vector<Variable>* checked_table(hotfire_model* model, hotfire_kind kind) {
  const std::vector<Variable>* table = table_of(model, kind);
  if (table == nullptr) {
    fail(model, HOTFIRE_WRONG_USE, "kind = %d: allowed: HOTFIRE_INPUT, HOTFIRE_OUTPUT, HOTFIRE_PARAMETER",
         static_cast<int>(kind));
  }
  return table;
}

hotfire_status refuse_index(hotfire_model* model, hotfire_kind kind, std::size_t index) {
  return fail(model, HOTFIRE_WRONG_USE, "index %zu: the model has no such %s; allowed: 0 to %zu", index, table_name(kind),
              table_of(model, kind)->size() - 1);
}

/// Refuses a value that the variable does not take.
hotfire_status check_value(hotfire_model* model, const Variable& variable, double value) {
  if (!std::isfinite(value)) {
    return fail(model, HOTFIRE_BAD_DATA, "%s = %g: not a finite number; allowed: a number in %s", variable.name.c_str(),
                value, variable.unit.c_str());
  }
  if (!hotfire::model::is_inside(value, variable.lower, variable.upper)) {
    return fail(model, HOTFIRE_BAD_DATA, "%s = %g: outside its bounds; allowed: %g to %g %s", variable.name.c_str(), value,
                variable.lower, variable.upper, variable.unit.c_str());
  }
  return HOTFIRE_OK;
}

hotfire_status set_parameters(hotfire_model* model, const std::size_t* indices, const double* values, std::size_t count) {
  const std::span<const double> present = model->plant->parameter_values();
  std::copy(present.begin(), present.end(), model->wanted.begin());
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& variable = model->plant->parameters()[indices[i]];
    if (model->started && !variable.tunable) {
      return fail(model, HOTFIRE_WRONG_USE, "%s: is not tunable; set it before the start", variable.name.c_str());
    }
    model->wanted[indices[i]] = values[i];
  }
  const std::string_view broken = model->plant->set_parameters(model->wanted);
  return broken.empty() ? HOTFIRE_OK
                        : fail(model, HOTFIRE_BAD_DATA, "%s = %g: %.*s", model->plant->parameters()[indices[0]].name.c_str(),
                               values[0], static_cast<int>(broken.size()), broken.data());
}

hotfire_status refuse_null(hotfire_model* model, const char* call) {
  return fail(model, HOTFIRE_WRONG_USE, "%s: a null pointer; allowed: a pointer to as many values as the call says", call);
}

hotfire_status refuse_before_start(hotfire_model* model, const char* call) {
  return fail(model, HOTFIRE_WRONG_USE, "%s: the model has not been started; call hotfire_start first", call);
}

}  // namespace

hotfire_model::hotfire_model(std::unique_ptr<Plant> own)
    : plant(std::move(own)),
      wanted(plant->parameters().size()),
      seeds(2 * (plant->inputs().size() + plant->parameters().size())) {}

namespace hotfire::interface {

std::string_view broken_period(double period) {
  return period >= kShortestPeriod && period <= kLongestPeriod ? std::string_view{}
                                                               : "outside its bounds; allowed: 1e-06 to 1 s";
}

hotfire_status refuse_step(hotfire_model& model) noexcept {
  return model.started
             ? fail(&model, HOTFIRE_RAN_AWAY,
                    "the model runs away at %g s: its parameters make it unstable for these inputs", model.plant->time())
             : refuse_before_start(&model, "hotfire_step");
}

void copy_message(std::string_view text, char* message, std::size_t size) noexcept {
  if (message == nullptr || size == 0) {
    return;
  }
  const std::size_t length = std::min(text.size(), size - 1);
  if (length > 0) {
    std::memcpy(message, text.data(), length);
  }
  message[length] = '\0';
}

}  // namespace hotfire::interface

extern "C" {

void hotfire_default_options(hotfire_options* options) {
  const hotfire::plant::Setup setup;
  *options = {sizeof(hotfire_options), setup.period, setup.seed};
}

void hotfire_close(hotfire_model* model) { delete model; }

const char* hotfire_message(const hotfire_model* model) { return model->message.data(); }

// The names of topologies are literals.
const char* hotfire_topology(const hotfire_model* model) { return model->plant->topology().data(); }

size_t hotfire_count(const hotfire_model* model, hotfire_kind kind) {
  const std::vector<Variable>* table = table_of(model, kind);
  return table != nullptr ? table->size() : 0;
}

hotfire_status hotfire_describe(hotfire_model* model, hotfire_kind kind, size_t index, hotfire_variable* variable) {
  const std::vector<Variable>* table = checked_table(model, kind);
  if (table == nullptr) {
    return HOTFIRE_WRONG_USE;
  }
  if (index >= table->size()) {
    return refuse_index(model, kind, index);
  }
  if (variable == nullptr) {
    return refuse_null(model, "hotfire_describe");
  }
  const Variable& own = (*table)[index];
  *variable = {own.name.c_str(), own.unit.c_str(), own.description.c_str(), own.start,
               own.lower,        own.upper,        own.tunable ? 1 : 0};
  return HOTFIRE_OK;
}

hotfire_status hotfire_find(hotfire_model* model, hotfire_kind kind, const char* name, size_t* index) {
  const std::vector<Variable>* table = checked_table(model, kind);
  if (table == nullptr) {
    return HOTFIRE_WRONG_USE;
  }
  if (name == nullptr || index == nullptr) {
    return refuse_null(model, "hotfire_find");
  }
  const auto found = std::find_if(table->begin(), table->end(), [name](const Variable& own) { return own.name == name; });
  if (found == table->end()) {
    return fail(model, HOTFIRE_WRONG_USE, "%s: the model has no such %s; the first of %zu is %s", name, table_name(kind),
                table->size(), table->front().name.c_str());
  }
  *index = static_cast<std::size_t>(found - table->begin());
  return HOTFIRE_OK;
}

hotfire_status hotfire_set(hotfire_model* model, hotfire_kind kind, const size_t* indices, const double* values,
                           size_t count) {
  const std::vector<Variable>* table = checked_table(model, kind);
  if (table == nullptr) {
    return HOTFIRE_WRONG_USE;
  }
  if (kind == HOTFIRE_OUTPUT) {
    return fail(model, HOTFIRE_WRONG_USE, "an output cannot be set; allowed: HOTFIRE_INPUT, HOTFIRE_PARAMETER");
  }
  if (count > 0 && (indices == nullptr || values == nullptr)) {
    return refuse_null(model, "hotfire_set");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (indices[i] >= table->size()) {
      return refuse_index(model, kind, indices[i]);
    }
    if (const hotfire_status bad = check_value(model, (*table)[indices[i]], values[i]); bad != HOTFIRE_OK) {
      return bad;
    }
  }
  if (kind == HOTFIRE_PARAMETER) {
    return count == 0 ? HOTFIRE_OK : set_parameters(model, indices, values, count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    model->plant->input_values()[indices[i]] = values[i];
  }
  return HOTFIRE_OK;
}

hotfire_status hotfire_get(hotfire_model* model, hotfire_kind kind, const size_t* indices, double* values, size_t count) {
  const std::vector<Variable>* table = checked_table(model, kind);
  if (table == nullptr) {
    return HOTFIRE_WRONG_USE;
  }
  if (kind == HOTFIRE_OUTPUT && !model->started) {
    return refuse_before_start(model, "hotfire_get of outputs");
  }
  if (count > 0 && (indices == nullptr || values == nullptr)) {
    return refuse_null(model, "hotfire_get");
  }
  const std::span<const double> present = values_of(model, kind);
  for (std::size_t i = 0; i < count; ++i) {
    if (indices[i] >= present.size()) {
      return refuse_index(model, kind, indices[i]);
    }
    values[i] = present[indices[i]];
  }
  return HOTFIRE_OK;
}

hotfire_status hotfire_start(hotfire_model* model, double time) {
  if (!std::isfinite(time)) {
    return fail(model, HOTFIRE_WRONG_USE, "hotfire_start: time = %g: not a finite number; allowed: a time in s", time);
  }
  model->started = model->plant->start(time);
  return model->started ? HOTFIRE_OK
                        : fail(model, HOTFIRE_RAN_AWAY,
                               "the model has no steady state under these inputs: its parameters make it unstable for them");
}

hotfire_status hotfire_step(hotfire_model* model) { return hotfire::interface::step(*model); }

double hotfire_time(const hotfire_model* model) { return model->plant->time(); }

double hotfire_period(const hotfire_model* model) { return model->plant->period(); }

hotfire_status hotfire_differentiate(hotfire_model* model, const hotfire_seed* seeds, size_t count, double* sensitivity,
                                     size_t outputs) {
  if (!model->started) {
    return refuse_before_start(model, "hotfire_differentiate");
  }
  if (outputs != model->plant->outputs().size() || count > model->seeds.size()) {
    return fail(model, HOTFIRE_WRONG_USE,
                "hotfire_differentiate: %zu seeds, %zu places; allowed: at most %zu seeds, %zu places", count, outputs,
                model->seeds.size(), model->plant->outputs().size());
  }
  if (sensitivity == nullptr || (count > 0 && seeds == nullptr)) {
    return refuse_null(model, "hotfire_differentiate");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (seeds[i].kind != HOTFIRE_INPUT && seeds[i].kind != HOTFIRE_PARAMETER) {
      return fail(model, HOTFIRE_WRONG_USE, "seed %zu: allowed: HOTFIRE_INPUT, HOTFIRE_PARAMETER", i);
    }
    if (seeds[i].index >= table_of(model, seeds[i].kind)->size()) {
      return refuse_index(model, seeds[i].kind, seeds[i].index);
    }
    model->seeds[i] = {seeds[i].kind == HOTFIRE_INPUT ? Seed::Kind::input : Seed::Kind::parameter, seeds[i].index,
                       seeds[i].value};
  }
  model->plant->differentiate(std::span(model->seeds).first(count), {sensitivity, outputs});
  return HOTFIRE_OK;
}

size_t hotfire_state_size(const hotfire_model* model) { return hotfire::interface::saved_size(*model->plant); }

hotfire_status hotfire_save(hotfire_model* model, void* bytes, size_t size) {
  if (size < hotfire_state_size(model)) {
    return fail(model, HOTFIRE_WRONG_USE, "hotfire_save: %zu bytes; allowed: at least %zu", size, hotfire_state_size(model));
  }
  if (bytes == nullptr) {
    return refuse_null(model, "hotfire_save");
  }
  hotfire::interface::save(*model->plant, model->started, static_cast<std::byte*>(bytes));
  return HOTFIRE_OK;
}

hotfire_status hotfire_load(hotfire_model* model, const void* bytes, size_t size) {
  if (bytes == nullptr) {
    return refuse_null(model, "hotfire_load");
  }
  const std::string_view broken =
      hotfire::interface::broken_state(*model->plant, std::span(static_cast<const std::byte*>(bytes), size));
  if (!broken.empty()) {
    return fail(model, HOTFIRE_BAD_DATA, "hotfire_load: %.*s", static_cast<int>(broken.size()), broken.data());
  }
  model->started = hotfire::interface::load(*model->plant, static_cast<const std::byte*>(bytes));
  return HOTFIRE_OK;
}
}
