// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hotfire {

/// The type of a word of the command line that is a table, an effect or a key: what completion takes `key_words` for.
inline constexpr const char* kKeyType = "KEY";

/// A key of a model file as a person reads it.
struct ModelKey {
  std::string name;
  std::string unit;                     ///< "1": none; "": that of the records, or no number
  double lower = 0.0;                   ///< allowed, in the unit
  double upper = 0.0;                   ///< the same
  std::optional<double> reference;      ///< value without the key; a curve and a word have none
  std::size_t points = 0;               ///< most points of a curve; 0: no curve
  std::vector<std::string> words;       ///< allowed, of a key that takes a word
  std::vector<std::string> of_options;  ///< the laws or channels under which it acts; empty: all
  std::string meaning;
};

/// A table of a model file: a declared part, an effect, or what a vehicle has besides.
struct KeyTable {
  std::string path;  ///< "servovalve", "effects.gimbal_friction"
  std::string site;  ///< where an effect acts; empty: no effect
  std::vector<ModelKey> keys;
};

/// The topologies that a model file may have.
std::vector<std::string> topologies();

/// Every table with keys of fixed names that a model of a topology may have. `taos` and `masv` have the tables of an axis
/// and those of gimbal, attach points and sensors. Throws UsageError for another topology.
std::vector<KeyTable> key_tables(const std::string& topology);

/// What `hotfire keys` takes, of all topologies: tables, effects by their name alone, and keys with their table.
std::vector<std::string> key_words();

}  // namespace hotfire
