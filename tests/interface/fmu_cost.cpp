// SPDX-License-Identifier: Apache-2.0
// Rows of a record on a plant in C++ and through an FMU, for callgrind to count (fmu_cost.cmake); an FMU and `hotfire
// simulate`, timed in turns:
//   fmu_cost unpack FOLDER                          the FMUs of all topologies in both versions
//   fmu_cost count TOPOLOGY plant ROWS
//   fmu_cost count TOPOLOGY 2|3 ROWS FOLDER
//   fmu_cost time PAIRS

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/files/scratch.hpp"
#include "tests/interface/cases.hpp"
#include "tests/interface/importer.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/interface/plant/plant.hpp"
#include "tools/library/declared_plant.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

// callgrind knows it by name and counts what is inside.
extern "C" __attribute__((noinline)) void hotfire_measured_rows(const std::function<void()>& rows);
void hotfire_measured_rows(const std::function<void()>& rows) { rows(); }

namespace hotfire::test {
namespace {

/// A case with an internal step of a row in every topology, so that a row has one set, one step and one get.
Case rows_of(const std::string& topology, std::size_t rows) {
  Case own = case_of(topology, rows);
  if (own.periods_per_row > 1) {
    own.driven[0] = own.simulated.find("force")->values;
    own.periods_per_row = 1;
    own.period = own.simulated.period;
  }
  return own;
}

/// The rows by `hotfire simulate`.
std::function<void()> simulated(const Case& own) {
  if (own.topology == "simplex" || own.topology == "direct") {
    return [&own, model = parse_model(own.text, "case.toml")] { simulate(model, own.simulated); };
  }
  return [&own, model = parse_vehicle(own.text, "case.toml")] { simulate(model, own.simulated); };
}

/// The rows on a plant, without any interface: inputs, steps and readings.
std::function<void()> stepped_in_cpp(const Case& own) {
  const DeclaredPlant declared = declared_plant(own.text, "case.toml", own.period, 1);
  const std::shared_ptr<plant::Plant> plant = plant::make_plant(declared.parameters, declared.setup);
  plant->start(0.0);
  return [&own, plant] {
    bool sane = true;
    for (std::size_t row = 0; row < own.periods(); ++row) {
      for (std::size_t i = 0; i < own.inputs.size(); ++i) {
        plant->input_values()[i] = own.driven[i][row];
      }
      sane = plant->advance() && sane;
    }
    if (!sane) {
      std::fprintf(stderr, "the plant runs away\n");
      std::exit(1);
    }
  };
}

/// The rows by an FMU that an importer sets, steps and reads.
class Stepped {
 public:
  Stepped(const std::filesystem::path& folder, const Case& own, int version)
      : own_(own),
        fmu_(folder, version),
        run_(fmu_, version),
        inputs_(fmu_.references(own.inputs)),
        outputs_(fmu_.references(own.outputs())),
        values_(inputs_.size()),
        readings_(outputs_.size()) {
    run_.enter();
    run_.call("ExitInitializationMode");
  }

  void operator()() {
    int worst = 0;
    for (std::size_t row = 0; row < own_.periods(); ++row, ++steps_) {
      for (std::size_t i = 0; i < values_.size(); ++i) {
        values_[i] = own_.driven[i][row];
      }
      worst = std::max(worst, run_.set(inputs_, values_));
      worst = std::max(worst, run_.step(static_cast<double>(steps_) * own_.period, own_.period));
      worst = std::max(worst, run_.get(outputs_, readings_));
    }
    if (worst != 0) {
      std::fprintf(stderr, "%s\n", last_message.data());
      std::exit(1);
    }
  }

 private:
  const Case& own_;
  Fmu fmu_;
  Run run_;
  std::vector<unsigned> inputs_;
  std::vector<unsigned> outputs_;
  std::vector<double> values_;
  std::vector<double> readings_;
  std::size_t steps_ = 0;
};

double seconds_of(const std::function<void()>& rows) {
  const auto began = std::chrono::steady_clock::now();
  rows();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// Prints the median ratio of the times of an FMU and of `hotfire simulate`, taken in turns in this process.
void compare_times(const Scratch& scratch, int pairs) {
  for (const char* topology : kTopologies) {
    const Case own = rows_of(topology, 20'000);
    const std::function<void()> native = simulated(own);
    for (const int version : {2, 3}) {
      Stepped stepped(Fmu::unpacked(scratch.path(""), own, version), own, version);
      std::vector<double> ratios;
      for (int pair = 0; pair < pairs; ++pair) {
        const double of_native = seconds_of(native);
        ratios.push_back(seconds_of(std::ref(stepped)) / of_native);
      }
      std::nth_element(ratios.begin(), ratios.begin() + pairs / 2, ratios.end());
      std::printf("%-8s FMI %d: time of an FMU over that of hotfire simulate: %.3f (median of %d pairs)\n", topology,
                  version, ratios[static_cast<std::size_t>(pairs / 2)], pairs);
    }
  }
}

}  // namespace
}  // namespace hotfire::test

int main(int argc, char** argv) {
  using hotfire::test::Fmu;
  const std::vector<std::string> words(argv, argv + argc);
  if (words.size() == 3 && words[1] == "time") {
    hotfire::test::compare_times(hotfire::test::Scratch{}, std::stoi(words[2]));
    return 0;
  }
  if (words.size() == 3 && words[1] == "unpack") {
    for (const char* topology : hotfire::test::kTopologies) {
      for (const int version : {2, 3}) {
        Fmu::unpacked(words[2], hotfire::test::rows_of(topology, 20), version);
      }
    }
    return 0;
  }
  if (words.size() < 5 || words[1] != "count") {
    std::fprintf(stderr, "usage: fmu_cost unpack FOLDER, count TOPOLOGY plant|2|3 ROWS [FOLDER], time PAIRS\n");
    return 2;
  }
  const hotfire::test::Case own = hotfire::test::rows_of(words[2], std::stoul(words[4]));
  if (words[3] == "plant") {
    hotfire_measured_rows(hotfire::test::stepped_in_cpp(own));
  } else {
    const std::filesystem::path folder = std::filesystem::path(words.at(5)) / (words[2] + words[3]);
    hotfire::test::Stepped(folder, own, std::stoi(words[3]))();
  }
  return 0;
}
