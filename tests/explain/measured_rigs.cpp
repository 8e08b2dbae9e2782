// SPDX-License-Identifier: Apache-2.0
// The closed loop on other people's rigs: measured_rigs emps|silverbox, whose data are not part of the project (the folder
// that holds emps/ and silverbox/ is named by HOTFIRE_MEASURED_DATA, docs/explain/worked-examples.md; exit 77 without it),
// and measured_rigs mts ARCHIVE FOLDER RECORD..., whose raw logs are in tests/data/measured.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/explain/explain.hpp"
#include "tools/files/import/import.hpp"
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
  for (const auto& effect : result.result.effects) {
    std::printf("found %s\n", effect.name.c_str());
  }
  return result;
}

bool found_first(const hotfire::explain::Explanation& result, const char* name) {
  return !result.result.effects.empty() && result.result.effects.front().name == name;
}

bool check(const char* what, double millis, double limit) {
  std::printf("%s: test RMSE %.3f (limit %.3f) thousandths of the unit\n", what, millis, limit);
  return millis < limit;
}

bool emps(const fs::path& folder) {
  const auto result = explained(folder);
  const auto value = [&](const char* name) {
    const auto& parameters = result.result.effects.at(0).parameters;
    return std::ranges::find(parameters, name, &hotfire::explain::EffectParameter::name)->value;
  };
  // A frictionless mass is off by metres. The friction of the other record is larger by a fortieth, and fits that follow the
  // training record alike give 5.2 to 6.0 mm on it; 7 mm guards what is reached, not what is aimed at
  // (docs/explain/worked-examples.md).
  return found_first(result, "sliding_friction") && value("viscous_forward") < value("viscous_backward") &&
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

/// The servo-hydraulic frame: raw logs in the archive, explained from all of `trained` and judged on the record that no fit
/// saw. The finder is given logs with zeros of their own, of which one has seven times the noise of the others.
bool mts(const fs::path& archive, const fs::path& folder, const std::vector<std::string>& trained) {
  fs::create_directories(folder);
  const std::string unpack = "cd '" + folder.string() + "' && cmake -E tar xf '" + archive.string() + "'";
  if (std::system(unpack.c_str()) != 0) {
    throw std::runtime_error("cannot unpack " + archive.string());
  }
  const fs::path logs = folder / "mts";
  const auto imported = [&](const std::string& name) {
    const auto map = hotfire::load_import_map(logs / (name == "0A" ? "map_0A.toml" : "map_15Hz.toml"));
    return hotfire::import_record(logs / (name + ".txt"), map, folder / (name + ".csv"));
  };
  std::vector<hotfire::Record> records;
  for (const std::string& name : trained) {
    records.push_back(imported(name));
  }
  hotfire::explain::ExplainOptions options;
  options.threads = 2;
  options.kept_back = {imported("15Hz0x5A")};
  const auto result = hotfire::explain::explain(hotfire::load_model(logs / "declared.toml"), records, options);
  std::multiset<std::string> found;
  for (const auto& effect : result.result.effects) {
    found.insert(effect.name);
    std::printf("found %s\n", effect.name.c_str());
  }
  for (const auto& record : result.result.records) {
    const auto& piston = record.channels.front();
    std::printf("%s: noise %.2f um, zero %.1f um\n", record.path.c_str(), 1e6 * piston.noise, 1e6 * piston.zero.value());
  }
  const auto& piston = result.result.held_out_records.front().channels.front();
  const double left = 1e3 * piston.explained.rms;
  std::printf("%s\n", result.result.sentence.c_str());
  std::printf("declared %.4f, calibrated %.4f, linear black box %.4f thousandths\n", 1e3 * piston.declared.rms,
              1e3 * piston.calibrated.rms, 1e3 * piston.black_box.value().rms);
  const std::multiset<std::string> wanted{"valve_asymmetry", "valve_deadband"};
  return check("test record", left, 0.014) && found == wanted;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 5 && std::strcmp(argv[1], "mts") == 0) {
    try {
      return mts(argv[2], argv[3], {argv + 4, argv + argc}) ? 0 : 1;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "measured_rigs: %s\n", error.what());
      return 6;
    }
  }
  const char* data = std::getenv("HOTFIRE_MEASURED_DATA");
  if (argc != 2 || (std::strcmp(argv[1], "emps") != 0 && std::strcmp(argv[1], "silverbox") != 0)) {
    std::fprintf(stderr, "usage: measured_rigs emps|silverbox, or mts ARCHIVE FOLDER RECORD...\n");
    return 2;
  }
  const fs::path folder = fs::path(data != nullptr ? data : "") / argv[1];
  if (data == nullptr || !fs::exists(folder / "train.csv")) {
    std::printf(
        "skipped: HOTFIRE_MEASURED_DATA does not name a folder with %s/train.csv; docs/explain/worked-examples.md says "
        "where to get it\n",
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
