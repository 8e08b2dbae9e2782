// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "model/direct.hpp"
#include "model/electromechanical.hpp"
#include "model/imposed_motion.hpp"
#include "model/modal.hpp"
#include "model/simplex.hpp"

namespace hotfire {

using SimplexParameters = model::Simplex<double>::Parameters;
using DirectParameters = model::Direct<double>::Parameters;
using ImposedMotionParameters = model::ImposedMotion<double>::Parameters;
using ModalParameters = model::Modal<double>::Parameters;
using ElectromechanicalParameters = model::Electromechanical<double>::Parameters;

/// A model as its TOML file declares it, in SI.
struct ModelFile {
  std::filesystem::path path;
  std::string name;
  std::variant<SimplexParameters, DirectParameters, ImposedMotionParameters, ModalParameters, ElectromechanicalParameters>
      parameters;
  std::map<std::string, double> noise;      ///< rms by channel ("piston"), in the channel's SI unit; absent: estimated
  std::map<std::string, double> tolerance;  ///< relative one-sigma by key ("engine.inertia"); absent: exact
  std::vector<std::string> left_out = {};   ///< declared parameters the file does not give: they have their reference value
};

/// Reads and checks a model file. Throws FileError naming file, line, key, value and what is allowed: unknown key, wrong
/// dimension, value outside its bounds, NaN, a relation between fields that is broken, a missing `schema` or `topology`.
///
/// A declared parameter that the file does not give takes the reference value of its topology and is listed in `left_out`;
/// one that has none (the inertia of a `direct` mass) is refused. A parameter of an active effect that is not given has no
/// action (its neutral value); the choice of a law or channel must be given.
ModelFile load_model(const std::filesystem::path& path);

/// The same of the text of a model file; `path` represents the file in messages.
ModelFile parse_model(std::string text, const std::filesystem::path& path);

/// The TOML text of a model: every declared parameter, every active effect, noise and tolerance, each number with the
/// digits that restore it exactly, each line with its unit and meaning as a comment. `load_model` reads it back bit for bit.
/// Parameters that do not act (of an inactive effect, or of a law not chosen) are not part of the text.
std::string model_text(const ModelFile& model);

}  // namespace hotfire
