// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire::test {

/// How a file of OUTPUT2 is written.
struct Op2Layout {
  bool has_long_words = false;   ///< of eight bytes
  bool is_swapped = false;       ///< in the other byte order
  bool in_basic_system = false;  ///< table BOUGV1
};

/// The hand-made case as PARAM,POST,-1 writes it: a label, a matrix and a table that are not of interest, LAMA, and OUGV1.
std::string four_modes_op2(const Op2Layout& layout);

}  // namespace hotfire::test
