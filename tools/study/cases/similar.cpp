// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/similar.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "tools/files/model/model_layout.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire::study {
namespace {

std::optional<double> factor_of_base(std::string_view base, const Similarity& to) {
  const double force = to.pressure * to.length * to.length;
  if (base == "1" || base == "rad") {
    return 1.0;
  }
  if (base == "m") {
    return to.length;
  }
  if (base == "s") {
    return to.time;
  }
  if (base == "Hz") {
    return 1.0 / to.time;
  }
  if (base == "Pa") {
    return to.pressure;
  }
  if (base == "N") {
    return force;
  }
  if (base == "kg") {
    return force * to.time * to.time / to.length;
  }
  return std::nullopt;
}

void scale_group(const KeyGroup& group, const Similarity& to) {
  for (const NumberKey& key : group.numbers) {
    if (*key.value != 0.0) {
      *key.value *= factor_of(key.unit, to);
    }
  }
  for (const CurveKey& key : group.curves) {
    for (int i = 0; i < *key.points; ++i) {
      key.x[i] *= factor_of(key.x_unit, to);
      key.y[i] *= factor_of(key.y_unit, to);
    }
  }
}

}  // namespace

double factor_of(std::string_view unit, const Similarity& similarity) {
  const auto factor = unit_product(unit, [&](std::string_view base) { return factor_of_base(base, similarity); });
  if (!factor) {
    throw std::invalid_argument(fmt::format("unit \"{}\" has no scale", unit));
  }
  return *factor;
}

ModelFile similar(ModelFile model, const Similarity& similarity) {
  const ModelLayout layout = layout_of(model);
  for (const KeyGroup& part : layout.parts) {
    scale_group(part, similarity);
  }
  for (const KeyGroup& effect : layout.effects) {
    if (*effect.active) {
      scale_group(effect, similarity);
    }
  }
  for (const ModelChannel& channel : layout.channels) {
    if (const auto noise = model.noise.find(std::string(channel.name)); noise != model.noise.end()) {
      noise->second *= factor_of(channel.unit, similarity);
    }
  }
  return model;
}

Record similar(Record record, const Similarity& similarity) {
  record.start *= similarity.time;
  record.period *= similarity.time;
  for (Channel& channel : record.channels) {
    const double factor = factor_of(channel.unit, similarity);
    for (double& value : channel.values) {
      value *= factor;
    }
  }
  return record;
}

}  // namespace hotfire::study
