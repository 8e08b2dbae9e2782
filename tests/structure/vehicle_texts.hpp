// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/structure/vehicle_file.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {

inline const std::string kTaos = "schema = 1\ntopology = \"taos\"\n";
inline const std::string kMasv = "schema = 1\ntopology = \"masv\"\n";

/// For tests of what is said in a model file of several axes.
struct VehicleTexts : Utest {
  Scratch scratch;

  VehicleFile load(const std::string& text) const { return load_vehicle(scratch.write("v.toml", text)); }
  std::string refused(const std::string& text) const {
    return refusal([&] { load(text); });
  }
};

}  // namespace hotfire::test
