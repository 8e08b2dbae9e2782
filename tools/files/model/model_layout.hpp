// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "tools/files/model/model_file.hpp"

namespace hotfire {

/// One number of a table of a model file, bound to its place in the parameters. Unit, bounds and meaning as in model::Field.
struct NumberKey {
  std::string_view name;
  std::string_view unit;
  double lower;
  double upper;
  std::string_view meaning;
  double* value;
  unsigned options;
  bool has_usual_value = false;  ///< a rig is built otherwise on purpose only: the reference value needs no warning
};

/// One curve of a table of a model file: two arrays, bound to their places. As in model::TableField.
struct CurveKey {
  std::string_view x_name;
  std::string_view x_unit;
  std::string_view y_name;
  std::string_view y_unit;
  double y_lower;
  double y_upper;
  std::string_view meaning;
  double* x;
  double* y;
  int* points;
  std::size_t capacity;
  unsigned options;
  bool is_optional;
};

/// A choice among names, bound to its place. As in model::Choice.
struct ChoiceKey {
  std::string_view key;
  std::vector<std::string_view> names;
  int* value;
};

/// One table of a model file: a declared part or an effect.
struct KeyGroup {
  std::string_view name;
  std::vector<NumberKey> numbers;
  std::vector<CurveKey> curves;
  std::string_view option_key;                        ///< "law" or "channel"; empty if there is nothing to choose
  std::vector<std::string_view> options;              ///< what `option_key` may be
  int* option = nullptr;                              ///< null for a part
  std::vector<ChoiceKey> choices;                     ///< what else there is to choose
  bool* active = nullptr;                             ///< null for a part
  std::string_view site;                              ///< empty for a part
  bool needs_other_axis = false;                      ///< of an effect that an axis alone has no use for
  std::function<std::string_view()> broken_relation;  ///< what the values break, empty if nothing

  /// True if a key with these option bits acts under the chosen option.
  bool uses(unsigned option_bits) const { return options.empty() || model::is_used(option_bits, *option); }
};

/// A channel of the model, as `[sensors]` names it.
struct ModelChannel {
  std::string_view name;
  std::string_view unit;
};

/// Every key a model of one topology has, built from the fields of its parts and effects. Pointers lead into the parameters
/// it was made from and live as long as they do.
struct ModelLayout {
  std::string_view topology;
  std::string_view input_channel;
  std::vector<ModelChannel> channels;
  std::vector<KeyGroup> parts;
  std::vector<KeyGroup> effects;
};

ModelLayout layout_of(ModelFile& model);

}  // namespace hotfire
