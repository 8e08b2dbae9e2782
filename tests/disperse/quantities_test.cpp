// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/quantities.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include <CppUTest/TestHarness.h>

namespace hotfire::disperse {

TEST_GROUP(Quantities){};

TEST(Quantities, EveryNumberHasItsPathAsName) {
  const auto numbers = numbers_of(nlohmann::ordered_json::parse(
      R"({"engine": [{"rise_time": 0.25, "note": "text"}, {"rise_time": null}], "reached": true})"));
  LONGS_EQUAL(3, numbers.size());
  STRCMP_EQUAL("engine.0.rise_time", numbers[0].first.c_str());
  DOUBLES_EQUAL(0.25, numbers[0].second, 0.0);
  STRCMP_EQUAL("engine.1.rise_time", numbers[1].first.c_str());
  CHECK(std::isnan(numbers[1].second));
  STRCMP_EQUAL("reached", numbers[2].first.c_str());
  DOUBLES_EQUAL(1.0, numbers[2].second, 0.0);
}

TEST(Quantities, AQuantileLiesBetweenTheNearestValues) {
  const std::vector<double> ordered{1.0, 2.0, 4.0, 8.0};
  DOUBLES_EQUAL(1.0, quantile(ordered, 0.0), 0.0);
  DOUBLES_EQUAL(3.0, quantile(ordered, 0.5), 1e-15);
  DOUBLES_EQUAL(6.0, quantile(ordered, 2.5 / 3.0), 1e-14);
  DOUBLES_EQUAL(8.0, quantile(ordered, 1.0), 0.0);
  DOUBLES_EQUAL(5.0, quantile({5.0}, 0.3), 0.0);
}

TEST(Quantities, StatisticsLeaveOutWhatIsNoNumber) {
  const Statistics own = statistics_of({3.0, std::numeric_limits<double>::quiet_NaN(), 1.0, 2.0});
  LONGS_EQUAL(3, own.ordered.size());
  DOUBLES_EQUAL(2.0, own.mean, 1e-15);
  DOUBLES_EQUAL(1.0, own.standard_deviation, 1e-15);
}

TEST(Quantities, RankCorrelationSeesEveryRisingLawAsOne) {
  std::vector<double> x;
  std::vector<double> rising;
  std::vector<double> falling;
  for (int i = 0; i < 20; ++i) {
    x.push_back((7 * i) % 20);
    rising.push_back(std::exp(x.back()));
    falling.push_back(-x.back() * x.back() * x.back());
  }
  DOUBLES_EQUAL(1.0, rank_correlation(x, rising), 1e-15);
  DOUBLES_EQUAL(-1.0, rank_correlation(x, falling), 1e-15);
  CHECK(std::isnan(rank_correlation(x, std::vector<double>(20, 4.0))));
}

// By hand: ranks 1, 2.5, 2.5, 4 against 1, 3, 2, 4.
TEST(Quantities, EqualValuesShareTheMeanOfTheirRanks) {
  DOUBLES_EQUAL(4.5 / std::sqrt(4.5 * 5.0), rank_correlation({1.0, 2.0, 2.0, 3.0}, {10.0, 30.0, 20.0, 40.0}), 1e-15);
}

}  // namespace hotfire::disperse
