// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/private_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "tools/files/text/error.hpp"

namespace hotfire {

PrivateFolder::PrivateFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "hotfire-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw FileError(fmt::format("{}: cannot be made: {}", name, std::generic_category().message(errno)));
  }
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace hotfire
