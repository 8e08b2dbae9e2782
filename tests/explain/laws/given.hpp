// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// What the finder is given.
struct Given {
  ModelFile declared;
  std::vector<Record> records;
  unsigned threads = 2;
};

/// A rig of which one thing is not declared, small enough to be explained in a few seconds.
struct LawCase {
  const char* name;
  Given (*make)();
  const char* found;  ///< the name that is right; nullptr: nothing is missing
  const char* site;   ///< where it acts; of what is not listed the likely sites may hold others beside it
};

/// A listed effect whose parameter has a sign.
extern const LawCase kListed;
/// A curve that is in no list.
extern const LawCase kUnlisted;
/// Nothing is missing.
extern const LawCase kNull;
/// A listed effect with two parameters, one of them hardly seen by itself.
extern const LawCase kSoft;

}  // namespace hotfire::test
