// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/plant/plant.hpp"

#include <array>
#include <cstring>

namespace hotfire::plant {

namespace {

/// Copies a span of numbers into or out of bytes that go on behind it.
template <class Bytes, class Copy>
void pass(Bytes& bytes, std::size_t size, Copy&& copy) {
  if (size > 0) {
    copy(bytes.data(), size);
  }
  bytes = bytes.subspan(size);
}

std::vector<double> starts_of(const std::vector<Variable>& variables) {
  std::vector<double> values;
  values.reserve(variables.size());
  for (const Variable& variable : variables) {
    values.push_back(variable.start);
  }
  return values;
}

}  // namespace

void Plant::complete_tables(std::uint64_t identity) {
  input_values_ = starts_of(inputs_);
  output_values_ = starts_of(outputs_);
  parameter_values_ = starts_of(parameters_);
  identity_ = identity;
}

std::size_t Plant::state_size() const noexcept {
  return sizeof periods_ + sizeof start_time_ +
         (input_values_.size() + output_values_.size() + parameter_values_.size()) * sizeof(double) + block().size();
}

void Plant::save(std::span<std::byte> bytes) const noexcept {
  const auto put = [&bytes](const void* from, std::size_t size) {
    pass(bytes, size, [from](std::byte* to, std::size_t count) { std::memcpy(to, from, count); });
  };
  put(&periods_, sizeof periods_);
  put(&start_time_, sizeof start_time_);
  for (const auto* values : {&input_values_, &output_values_, &parameter_values_}) {
    put(values->data(), values->size() * sizeof(double));
  }
  put(block().data(), block().size());
}

void Plant::load(std::span<const std::byte> bytes) noexcept {
  const auto take = [&bytes](void* to, std::size_t size) {
    pass(bytes, size, [to](const std::byte* from, std::size_t count) { std::memcpy(to, from, count); });
  };
  take(&periods_, sizeof periods_);
  take(&start_time_, sizeof start_time_);
  for (auto* values : {&input_values_, &output_values_}) {
    take(values->data(), values->size() * sizeof(double));
  }
  // New constants only for new parameters: they cost far more than a copy.
  const std::size_t size = parameter_values_.size() * sizeof(double);
  if (size > 0 && std::memcmp(bytes.data(), parameter_values_.data(), size) != 0) {
    take(parameter_values_.data(), size);
    use_parameters();
  } else {
    bytes = bytes.subspan(size);
  }
  take(block().data(), block().size());
}

std::unique_ptr<Plant> make_plant(const AnyParameters& parameters, const Setup& setup) {
  return std::visit([&](const auto& own) { return make_plant(own, setup); }, parameters);
}

}  // namespace hotfire::plant
