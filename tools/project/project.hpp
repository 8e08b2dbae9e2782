// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hotfire {

/// The kinds of model that a project may begin with: the topologies that `explain` takes.
std::vector<std::string> project_kinds();

/// A project as it was written.
struct Project {
  std::filesystem::path folder;
  std::vector<std::string> files;     ///< names inside the folder
  std::vector<std::string> commands;  ///< what to run next, in the folder
};

/// Makes a folder of that name with a declared model of the kind, two example records in which an effect acts that the model
/// does not have, a profile of `hotfire lab` for one actuator, and a README.md with the commands to run next. The last part
/// of the path is the name of the model. Throws UsageError for an unknown kind and for a folder that has files already, and
/// FileError where it cannot be written.
Project make_project(const std::filesystem::path& folder, const std::string& kind);

}  // namespace hotfire
