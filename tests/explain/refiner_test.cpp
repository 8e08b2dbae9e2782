#include "tools/explain/refiner.hpp"

#include "tools/simulate/simulate.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Evaluator;
using explain::Fitted;
using explain::Resolution;
using explain::SimplexFamily;

/// Steps of a degree and back, simulated by the declared model, the piston read 0.1 mm off; with or without the load
/// pressure, to which rough steps do most.
Dataset stepped(const ModelFile& model, bool with_pressure) {
  Record record;
  record.name = "steps.csv";
  record.path = record.name;
  record.period = 2e-3;
  record.rows = 6000;
  Channel command{"command", "rad", std::vector<double>(record.rows, 0.0)};
  for (std::size_t row = 500; row < record.rows; ++row) {
    command.values[row] = row / 1000 % 2 == 0 ? 0.0175 : 0.0;
  }
  record.channels.push_back(command);
  const Record modelled = simulate(model, record);
  record.channels.push_back(*modelled.find("piston"));
  for (double& piston : record.channels.back().values) {
    piston += 1e-4;
  }
  if (with_pressure) {
    record.channels.push_back(*modelled.find("load_pressure"));
  }
  return explain::make_dataset(model, {record});
}

bool screens_roughly(bool with_pressure) {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", 8e-6}, {"load_pressure", 8e3}};
  const Dataset data = stepped(model, with_pressure);
  const Evaluator<SimplexFamily> rough(data, Resolution::rough);
  const Evaluator<SimplexFamily> coarse(data, Resolution::coarse);
  const Evaluator<SimplexFamily> fine(data, Resolution::fine);
  const explain::Scales scales;
  const explain::Watch watch;
  const explain::Refiner<SimplexFamily> refiner(data, rough, coarse, fine, scales, 1, watch);
  Fitted<SimplexFamily> declared;
  declared.base = std::get<SimplexParameters>(model.parameters);
  declared.temper.assign(data.channels.size(), 1.0);
  return refiner.for_screening(declared).resolution() == Resolution::rough;
}

}  // namespace

TEST_GROUP(Refiner){};

TEST(Refiner, ScreensWithRoughStepsWhereTheyChangeLittleOfWhatIsLeft) { CHECK_TRUE(screens_roughly(false)); }

// What the pressure channel lacks is a thousandth of what the piston's does: over both channels together rough steps change
// next to nothing.
TEST(Refiner, ScreensWithRankingStepsWhereRoughOnesChangeOneChannelThatIsMetAlready) { CHECK_FALSE(screens_roughly(true)); }
