// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/files/scratch.hpp"
#include "tools/doctor/doctor.hpp"

namespace hotfire::test {

/// A machine made of files and of what commands say.
class PatientFiles {
 public:
  doctor::Patient patient() {
    doctor::Patient patient;
    patient.root = scratch_.path("");
    patient.run = [this](const std::string& command) { return said[command]; };
    return patient;
  }

  void put(const std::string& path, const std::string& content) const {
    std::filesystem::create_directories(scratch_.path(path).parent_path());
    scratch_.write(path, content + "\n");
  }

  std::map<std::string, std::string> said;  ///< output by command

 private:
  Scratch scratch_;
};

/// The finding of a check; fails if there is none.
inline doctor::Finding finding_of(const std::vector<doctor::Finding>& findings, const std::string& check) {
  const auto found =
      std::find_if(findings.begin(), findings.end(), [&](const doctor::Finding& f) { return f.check == check; });
  if (found == findings.end()) {
    FAIL(("no finding of " + check).c_str());
    return {};
  }
  return *found;
}

inline void expect_good(const doctor::Finding& finding) {
  CHECK(finding.level == doctor::Level::good);
  STRCMP_EQUAL("", finding.remedy.c_str());
}

/// A finding that is not good says what was found and its remedy.
inline void expect_remedy(const doctor::Finding& finding, doctor::Level level, const char* what, const char* remedy) {
  CHECK(finding.level == level);
  STRCMP_CONTAINS(what, finding.what.c_str());
  STRCMP_CONTAINS(remedy, finding.remedy.c_str());
}

}  // namespace hotfire::test
