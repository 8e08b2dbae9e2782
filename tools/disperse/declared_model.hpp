// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::disperse {

/// One number of a model, and the keys that name it: of the axis pitch2, `structure.stiffness`, `structure.pitch.stiffness`
/// and `structure.pitch2.stiffness`.
struct DeclaredNumber {
  std::vector<std::string> keys;  ///< from general to particular
  std::string unit;               ///< SI; of one cell of a matrix empty
  double* value;
};

/// A model file of any topology, whose numbers can be set by key.
class DeclaredModel {
 public:
  /// Throws FileError as load_model and load_vehicle do.
  explicit DeclaredModel(const std::filesystem::path& path);

  /// Every number of the parts, of the active effects, and of several axes those of `[attach]` and `[gimbal]`. They live as
  /// long as the model, and change it.
  std::vector<DeclaredNumber> numbers();

  /// What `[tolerance]` gives, a key and its relative one-sigma: one entry for what all axes have in common.
  std::vector<std::pair<std::string, double>> tolerances() const;

  /// The text of the model file. A mode table is named by its full path, or without folder where the text is only compared.
  enum class TableName { full_path, without_folder };
  std::string text(TableName table = TableName::full_path) const;

  /// Of the mode table; empty if there is none.
  std::filesystem::path modes_table() const;

 private:
  std::variant<ModelFile, VehicleFile> model_;
};

}  // namespace hotfire::disperse
