// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/similar.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tools/files/model/model_layout.hpp"

namespace hotfire::study {
namespace {

double factor_of_base(std::string_view base, std::string_view unit, const Similarity& to) {
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
  throw std::invalid_argument(fmt::format("unit \"{}\": \"{}\" has no scale", unit, base));
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
  double factor = 1.0;
  std::size_t at = 0;
  bool divides = false;
  while (at <= unit.size()) {
    const std::size_t end = std::min(unit.find_first_of("./", at), unit.size());
    // A power may hold a point, "kg^-0.5": it ends where a letter or a slash follows.
    std::size_t stop = end;
    const std::size_t hat = unit.find('^', at);
    double power = 1.0;
    if (hat < end) {
      const auto read = std::from_chars(unit.data() + hat + 1, unit.data() + unit.size(), power);
      stop = static_cast<std::size_t>(read.ptr - unit.data());
      stop -= unit[stop - 1] == '.' ? 1 : 0;  // "m^2.s"
    }
    const std::string_view base = unit.substr(at, std::min(hat, end) - at);
    factor *= std::pow(factor_of_base(base, unit, similarity), divides ? -power : power);
    if (stop >= unit.size()) {
      break;
    }
    divides = unit[stop] == '/';
    at = stop + 1;
  }
  return factor;
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
