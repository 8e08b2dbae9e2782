// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire {

/// The page with its style and scripts, dygraphs among them, and with the places `@title@`, `@headline@` and `@data@` to
/// fill, once each and in this order. Written at build time by embed_page.cmake from the files in page/.
std::string page_template();

}  // namespace hotfire
