// The closed loop on other people's rigs: measured_rigs emps|silverbox. The data are not part of the project; the folder
// that holds emps/ and silverbox/ is named by HOTFIRE_MEASURED_DATA (docs/explain.md). Exit 77 without it.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "tools/explain/explain.hpp"
#include "tools/simulate/simulate.hpp"

namespace {

namespace fs = std::filesystem;

double test_error(const hotfire::ModelFile& model, const fs::path& file, std::size_t fit_start, std::size_t first,
                  std::size_t last) {
  const hotfire::Record record = hotfire::load_record(file);
  const hotfire::Record modelled = hotfire::simulate(model, record, fit_start);
  const auto& a = record.find("position")->values;
  const auto& b = modelled.find("position")->values;
  double sum = 0.0;
  last = std::min(last, a.size());
  for (std::size_t i = first; i < last; ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(sum / static_cast<double>(last - first));
}

hotfire::explain::Explanation explained(const fs::path& folder) {
  auto result = hotfire::explain::explain(hotfire::load_model(folder / "declared.toml"),
                                          {hotfire::load_record(folder / "train.csv")}, {2, 4, {}});
  for (const auto& effect : result.report["effects"]) {
    std::printf("found %s\n", effect["name"].get<std::string>().c_str());
  }
  return result;
}

bool found_first(const hotfire::explain::Explanation& result, const char* name) {
  return !result.report["effects"].empty() && result.report["effects"][0]["name"] == name;
}

bool check(const char* what, double millis, double limit) {
  std::printf("%s: test RMSE %.3f (limit %.3f) thousandths of the unit\n", what, millis, limit);
  return millis < limit;
}

bool emps(const fs::path& folder) {
  const auto result = explained(folder);
  const auto& friction = result.report["effects"][0]["parameters"];
  const bool asymmetric = friction["viscous_forward"]["value"] < friction["viscous_backward"]["value"];
  // A frictionless mass is off by metres. The friction of the other record is larger by a fortieth, and fits that follow the
  // training record alike give 5.2 to 6.0 mm on it; 7 mm guards what is reached, not what is aimed at (docs/explain.md).
  return found_first(result, "sliding_friction") && asymmetric &&
         check("EMPS", 1e3 * test_error(result.model, folder / "test.csv", 0, 20, SIZE_MAX), 7.0);
}

bool silverbox(const fs::path& folder) {
  const auto result = explained(folder);
  bool good = found_first(result, "cubic_stiffness");
  good = check("multisine", 1e3 * test_error(result.model, folder / "test_multisine.csv", 50, 50, SIZE_MAX), 0.36) && good;
  good = check("arrow", 1e3 * test_error(result.model, folder / "test_arrow.csv", 50, 50, SIZE_MAX), 0.40) && good;
  return check("arrow, rows 0-31999", 1e3 * test_error(result.model, folder / "test_arrow.csv", 50, 50, 32000), 0.32) &&
         good;
}

}  // namespace

int main(int argc, char** argv) {
  const char* data = std::getenv("HOTFIRE_MEASURED_DATA");
  if (argc != 2 || (std::strcmp(argv[1], "emps") != 0 && std::strcmp(argv[1], "silverbox") != 0)) {
    std::fprintf(stderr, "usage: measured_rigs emps|silverbox\n");
    return 2;
  }
  const fs::path folder = fs::path(data != nullptr ? data : "") / argv[1];
  if (data == nullptr || !fs::exists(folder / "train.csv")) {
    std::printf(
        "skipped: HOTFIRE_MEASURED_DATA does not name a folder with %s/train.csv; docs/explain.md says where to get it\n",
        argv[1]);
    return 77;
  }
  try {
    return (std::strcmp(argv[1], "emps") == 0 ? emps(folder) : silverbox(folder)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measured_rigs: %s\n", error.what());
    return 6;
  }
}
