// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire {

/// One example record and the name of its file.
struct ExampleRecord {
  std::string file;
  Record record;
};

/// An effect that acts in the example records of a kind, beside the declared model.
struct ExampleEffect {
  std::string words;  ///< "friction of the gimbal (`gimbal_friction`)"
  std::string toml;   ///< its table in a model file
};

ExampleEffect example_effect(const std::string& kind);

/// Steps and a multisine of a rig that is as a model file declares it, but for `example_effect`, with the noise of the
/// declared sensors. `declared` is the text of that file, whose axes need not be those of one engine alone.
std::vector<ExampleRecord> example_records(const std::string& declared, const std::string& kind);

}  // namespace hotfire
