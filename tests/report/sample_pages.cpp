// SPDX-License-Identifier: Apache-2.0
// Writes the sample pages into a folder, for the browser: sample_pages FOLDER
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "tests/report/samples.hpp"

int main(int count, char** arguments) {
  using namespace hotfire;
  if (count != 2) {
    fmt::print(stderr, "sample_pages FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  const std::pair<const char*, test::Sample> samples[] = {{"explained.html", test::explained_actuator()},
                                                          {"nothing-missing.html", test::nothing_missing_mass()},
                                                          {"hostile.html", test::hostile_long_records()}};
  for (const auto& [name, sample] : samples) {
    std::ofstream file(folder / name, std::ios::binary);
    file << report_page(sample.report, sample.series);
    if (!file.flush()) {
      fmt::print(stderr, "cannot write {}\n", (folder / name).string());
      return 1;
    }
  }
  return 0;
}
