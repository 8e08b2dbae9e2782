// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace hotfire {

/// The text of a file of templates/, or of the sample profile of docs/samples, by its name; empty if there is none.
std::string_view project_template(std::string_view name);

}  // namespace hotfire
