// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tools/interface/plant/plant.hpp"

namespace hotfire::interface {

/// Reads a plant text (interface/plant/setup_text.hpp). Throws std::runtime_error that names the text, line, value and what
/// is allowed.
std::unique_ptr<plant::Plant> plant_of_text(const std::string& text, const std::string& name);

}  // namespace hotfire::interface
