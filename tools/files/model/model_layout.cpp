// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/model_layout.hpp"

#include "tools/files/model/key_groups.hpp"

namespace hotfire {

ModelLayout layout_of(SimplexParameters& parameters) { return layout_of_plant<model::Simplex<double>>(parameters); }

ModelLayout layout_of(DirectParameters& parameters) { return layout_of_plant<model::Direct<double>>(parameters); }

ModelLayout layout_of(ModelFile& model) {
  return std::visit([](auto& parameters) { return layout_of(parameters); }, model.parameters);
}

}  // namespace hotfire
