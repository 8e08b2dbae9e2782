// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/trial.hpp"

#include <CppUTest/TestHarness.h>

using hotfire::explain::is_as_good;
using hotfire::explain::is_supported;
using hotfire::explain::Trial;

namespace {

Trial that_changes(double criterion, double held_out_ratio) {
  Trial trial;
  trial.delta_criterion = criterion;
  trial.held_out_ratio = held_out_ratio;
  return trial;
}

}  // namespace

TEST_GROUP(Trial){};

TEST(Trial, AnEffectIsSupportedOnlyWhereTheBicAndHeldOutDataBothSaySo) {
  CHECK_TRUE(is_supported(that_changes(-100.0, 0.8)));
  CHECK_FALSE(is_supported(that_changes(-100.0, 1.3)));
  CHECK_FALSE(is_supported(that_changes(-1.0, 0.8)));
}

TEST(Trial, AModelWithoutAnEffectIsAsGoodOnlyWhereNeitherTheBicNorHeldOutDataSpeakAgainstIt) {
  CHECK_TRUE(is_as_good(that_changes(2.0, 1.001)));
  CHECK_FALSE(is_as_good(that_changes(-250.0, 4.0)));
  CHECK_FALSE(is_as_good(that_changes(250.0, 0.9)));
}
