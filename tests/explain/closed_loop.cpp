// SPDX-License-Identifier: Apache-2.0
// The closed loop on one challenge case: closed_loop CASE.tar.xz FOLDER. Explains what is in given/, compares the names with
// kept/truth.json, and the explained model with the noise-free record it has never seen. Exit 0 if the names are right and
// the model is closer to the truth than the sensor is.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support/rms_difference.hpp"
#include "tools/explain/explain.hpp"
#include "tools/simulate/simulate.hpp"

namespace {

std::string joined(const std::multiset<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : " + ") + name;
  }
  return text.empty() ? "nothing" : text;
}

bool explain_case(const std::string& archive, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::string unpack = "cd '" + folder.string() + "' && cmake -E tar xf '" + archive + "'";
  if (std::system(unpack.c_str()) != 0) {
    throw std::runtime_error("cannot unpack " + archive);
  }
  const std::filesystem::path root = folder / std::filesystem::path(archive).stem().stem();
  const hotfire::ModelFile declared = hotfire::load_model(root / "given/declared.toml");
  std::vector<hotfire::Record> records;
  for (const char* name : {"ramps.csv", "steps.csv", "sweep.csv"}) {
    records.push_back(hotfire::load_record(root / "given" / name));
  }
  const auto result = hotfire::explain::explain(declared, records, {2, 4, {}});

  const auto truth = nlohmann::json::parse(std::ifstream(root / "kept/truth.json"));
  const std::multiset<std::string> wanted = truth["effects"];
  std::multiset<std::string> found;  // a name that is found twice is not right
  for (const auto& effect : result.result.effects) {
    found.insert(effect.name);
  }
  const hotfire::Record unseen = hotfire::load_record(root / "kept/score_noisefree.csv");
  const hotfire::Record modelled = hotfire::simulate(result.model, unseen);
  bool below_noise = true;
  std::printf("wanted %s, found %s (%s)\n", joined(wanted).c_str(), joined(found).c_str(),
              std::string(hotfire::explain::name_of(result.result.verdict)).c_str());
  for (const char* channel : {"piston", "engine"}) {
    const double noise = declared.noise.at(channel);
    const double error = hotfire::test::rms_difference(unseen.find(channel)->values, modelled.find(channel)->values) / noise;
    std::printf("  %-7s effect %.2f, model error %.3f, both in sensor noise\n", channel,
                truth["effect_size"][channel].get<double>(), error);
    below_noise = below_noise && error < 1.0;
  }
  return found == wanted && below_noise;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: closed_loop CASE.tar.xz FOLDER\n");
    return 2;
  }
  try {
    return explain_case(argv[1], argv[2]) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "closed_loop: %s\n", error.what());
    return 6;
  }
}
