// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/model_layout.hpp"

#include "tools/files/model/key_groups.hpp"
#include "tools/files/model/plant_of.hpp"

namespace hotfire {

ModelLayout layout_of(ModelFile& model) {
  return std::visit([](auto& own) { return layout_of_plant<PlantOf<decltype(own), double>>(own); }, model.parameters);
}

}  // namespace hotfire
