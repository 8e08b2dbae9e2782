// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// How every row of a channel changes with parameters.
struct ChannelSlopes {
  std::string name;            ///< "piston"
  std::vector<double> slopes;  ///< d channel / d parameter, in SI: a row of the record after the other, a parameter a column
};

/// The exact derivatives of what `simulate` gives for the model and the record, start included, by the parameters of these
/// keys, "engine.inertia": the run is made with dual numbers. Throws UsageError for a key that does not
/// act in the model, of an inactive effect or of a law that is not chosen, and what `simulate` throws.
std::vector<ChannelSlopes> gradients(const ModelFile& model, const Record& inputs, const std::vector<std::string>& keys);

}  // namespace hotfire
