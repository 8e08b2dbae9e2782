// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// The known word nearest to `word` by edit distance, empty if none is near: at most a third of its letters, and at least
/// two, may differ.
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& known);

/// Up to `most` known words, the nearest to `word` by edit distance first, capitals or not.
std::vector<std::string_view> nearest_words(std::string_view word, const std::vector<std::string_view>& known,
                                            std::size_t most);

/// `did you mean "piston_area"? ` if a known word is near, then `allowed: a, b, c`.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace hotfire
