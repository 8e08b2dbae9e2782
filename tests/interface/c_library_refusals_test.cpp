// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tools/interface/c/hotfire.h"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

/// A model file with as little as it may have.
std::string text_of(const std::string& topology) {
  return "schema = 1\ntopology = \"" + topology + "\"\n" +
         (topology == "direct" ? "[mass]\ninertia = 2.0\nstiffness = 5e4\n" : "");
}

std::shared_ptr<hotfire_model> open(const std::string& topology) {
  hotfire_model* model = nullptr;
  LONGS_EQUAL(HOTFIRE_OK, hotfire_open_text(text_of(topology).c_str(), "own.toml", nullptr, &model, nullptr, 0));
  return {model, hotfire_close};
}

/// The sentence about a text that is refused with this status.
std::string problem_of_text(const std::string& text, const hotfire_options* options = nullptr,
                            hotfire_status expected = HOTFIRE_BAD_DATA) {
  std::array<char, 512> message{};
  hotfire_model* model = nullptr;
  LONGS_EQUAL(expected, hotfire_open_text(text.c_str(), "own.toml", options, &model, message.data(), message.size()));
  CHECK(model == nullptr);
  return message.data();
}

}  // namespace

TEST_GROUP(CLibraryRefusals){};

TEST(CLibraryRefusals, RefusesWithTheWordsOfTheCommand) {
  STRCMP_EQUAL("own.toml:3:22: engine.inertia = -1: outside its bounds; allowed: 1e-06 to 1e+09 kg.m^2",
               problem_of_text("schema = 1\ntopology = \"simplex\"\nengine = { inertia = -1 }\n").c_str());
}

TEST(CLibraryRefusals, RefusesValuesOutsideTheirBoundsAndSetsNoneOfThem) {
  const auto model = open("simplex");
  const std::size_t both[]{0, 1};
  const double values[]{0.01, std::nan("")};
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_set(model.get(), HOTFIRE_INPUT, both, values, 2));
  STRCMP_EQUAL("torque = nan: not a finite number; allowed: a number in N.m", hotfire_message(model.get()));
  double command = 1.0;
  hotfire_get(model.get(), HOTFIRE_INPUT, &both[0], &command, 1);
  DOUBLES_EQUAL(0.0, command, 0.0);
  std::size_t inertia = 0;
  hotfire_find(model.get(), HOTFIRE_PARAMETER, "engine.inertia", &inertia);
  const double negative = -1.0;
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_set(model.get(), HOTFIRE_PARAMETER, &inertia, &negative, 1));
  STRCMP_EQUAL("engine.inertia = -1: outside its bounds; allowed: 1e-06 to 1e+09 kg.m^2", hotfire_message(model.get()));
}

TEST(CLibraryRefusals, RefusesCallsInTheWrongOrder) {
  const auto model = open("direct");
  const std::size_t first = 0;
  double value = 0.0;
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_step(model.get()));
  STRCMP_EQUAL("hotfire_step: the model has not been started; call hotfire_start first", hotfire_message(model.get()));
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_get(model.get(), HOTFIRE_OUTPUT, &first, &value, 1));
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_set(model.get(), HOTFIRE_OUTPUT, &first, &value, 1));
  std::size_t start = 0;
  hotfire_find(model.get(), HOTFIRE_PARAMETER, "start.position", &start);
  value = 0.25;
  LONGS_EQUAL(HOTFIRE_OK, hotfire_set(model.get(), HOTFIRE_PARAMETER, &start, &value, 1));
  LONGS_EQUAL(HOTFIRE_OK, hotfire_start(model.get(), 0.0));
  double position = 0.0;
  LONGS_EQUAL(HOTFIRE_OK, hotfire_get(model.get(), HOTFIRE_OUTPUT, &first, &position, 1));
  DOUBLES_EQUAL(0.25, position, 0.0);
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_set(model.get(), HOTFIRE_PARAMETER, &start, &value, 1));
  STRCMP_EQUAL("start.position: is not tunable; set it before the start", hotfire_message(model.get()));
}

TEST(CLibraryRefusals, RefusesAPeriodThatNoModelTakes) {
  hotfire_options options;
  hotfire_default_options(&options);
  options.period = 2.0;
  STRCMP_EQUAL("options.period = 2: outside its bounds; allowed: 1e-06 to 1 s",
               problem_of_text(text_of("simplex"), &options, HOTFIRE_WRONG_USE).c_str());
  options.period = 1e-3;
  options.size = 4;
  STRCMP_CONTAINS("options.size = 4", problem_of_text(text_of("simplex"), &options, HOTFIRE_WRONG_USE).c_str());
}

TEST(CLibraryRefusals, RefusesToOpenWithoutATextOrAPlaceForTheModel) {
  std::array<char, 512> message{};
  hotfire_model* model = nullptr;
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_open(nullptr, nullptr, &model, message.data(), message.size()));
  STRCMP_EQUAL("a path, a text, a name or the place for the model is NULL", message.data());
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_open_text("", nullptr, nullptr, &model, nullptr, 0));
  LONGS_EQUAL(HOTFIRE_WRONG_USE, hotfire_open_plant("", "plant.txt", nullptr, nullptr, 0));
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_open_plant("", "plant.txt", &model, nullptr, 0));
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_open("/no/such/file.toml", nullptr, &model, message.data(), message.size()));
  STRCMP_CONTAINS("/no/such/file.toml", message.data());
}

TEST(CLibraryRefusals, RefusesANullPointerInsteadOfValues) {
  const auto model = open("direct");
  hotfire_model* own = model.get();
  LONGS_EQUAL(HOTFIRE_OK, hotfire_start(own, 0.0));
  const std::size_t place = 0;
  std::size_t found = 0;
  double value = 0.0;
  const hotfire_seed seed{HOTFIRE_INPUT, 0, 1.0};
  const std::vector<hotfire_status> all{hotfire_describe(own, HOTFIRE_INPUT, 0, nullptr),
                                        hotfire_find(own, HOTFIRE_INPUT, nullptr, &found),
                                        hotfire_find(own, HOTFIRE_INPUT, "force", nullptr),
                                        hotfire_set(own, HOTFIRE_INPUT, nullptr, &value, 1),
                                        hotfire_set(own, HOTFIRE_INPUT, &place, nullptr, 1),
                                        hotfire_get(own, HOTFIRE_OUTPUT, nullptr, &value, 1),
                                        hotfire_get(own, HOTFIRE_OUTPUT, &place, nullptr, 1),
                                        hotfire_differentiate(own, nullptr, 1, &value, hotfire_count(own, HOTFIRE_OUTPUT)),
                                        hotfire_differentiate(own, &seed, 1, nullptr, hotfire_count(own, HOTFIRE_OUTPUT)),
                                        hotfire_save(own, nullptr, hotfire_state_size(own)),
                                        hotfire_load(own, nullptr, hotfire_state_size(own))};
  for (const hotfire_status status : all) {
    LONGS_EQUAL(HOTFIRE_WRONG_USE, status);
  }
  STRCMP_EQUAL("hotfire_load: a null pointer; allowed: a pointer to as many values as the call says", hotfire_message(own));
  LONGS_EQUAL(HOTFIRE_OK, hotfire_set(own, HOTFIRE_INPUT, nullptr, nullptr, 0));
  LONGS_EQUAL(HOTFIRE_OK, hotfire_step(own));
}

}  // namespace hotfire::test
