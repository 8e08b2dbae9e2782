// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/finalists.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

namespace {

using namespace hotfire::explain;

/// Screened candidates, the best first, as a screening leaves them.
std::vector<Screened> screened(const std::vector<double>& criteria) {
  std::vector<Screened> all;
  for (const double criterion : criteria) {
    all.emplace_back();
    all.back().criterion = criterion;
    all.back().good = true;
  }
  return all;
}

}  // namespace

TEST_GROUP(Finalists){};

TEST(Finalists, OfTermsOfUnknownLawThoseThatLookStrongAreFitted) {
  CHECK_EQUAL(2U, unlisted_finalists(screened({-500.0, -12.0, -3.0, 40.0, 80.0})));
  CHECK_EQUAL(kUnlistedFinalists, unlisted_finalists(screened({-500.0, -400.0, -300.0, -200.0, -100.0, -50.0})));
}

TEST(Finalists, WhereNoneLooksStrongTheBestAreFittedAllTheSame) {
  CHECK_EQUAL(kUnlistedFinalists, unlisted_finalists(screened({-9.6, 23.0, 41.0, 42.0, 64.0})));
  CHECK_EQUAL(1U, unlisted_finalists(screened({5.0})));
  CHECK_EQUAL(0U, unlisted_finalists(screened({})));
}

TEST(Finalists, ASlowResidualKeepsNoNameThatLeavesClearlyLessFromTheJointFit) {
  std::vector<Screened> all = screened({-9.0, -2.5, -1.0, 3.0});
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].candidate.name = std::string(1, static_cast<char>('a' + i));
  }
  CHECK_TRUE(finalists_of(all).empty());
  all[1].left = 0.2;
  CHECK((finalists_of(all) == std::vector<std::size_t>{1}));
  all[0].criterion = -50.0;
  CHECK((finalists_of(all) == std::vector<std::size_t>{0, 1}));
}

TEST(Finalists, WhereNoneReachesTheNoiseTheClosestLawOfEachNameMayWinYet) {
  const std::vector<std::pair<std::string, double>> left{
      {"backlash", 1.8}, {"soft_stiffness", 1.5}, {"soft_stiffness", 1.6}, {"piston_friction", 3.3}, {"unsimulable", 0.0}};
  std::vector<Screened> all = screened({-50.0, -40.0, -39.0, -20.0, -15.0});
  std::vector<Assessed> finalists(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].candidate.name = left[i].first;
    if (left[i].second > 0.0) {
      finalists[i].prediction.resize(1);
      finalists[i].goodness.fitted = {{.rows = 100.0, .mean_square = left[i].second * left[i].second}};
    }
  }
  // 3.3 is clearly more than 1.5.
  const std::vector<std::size_t> contenders = contenders_of({0, 1, 2, 3, 4}, all, finalists);
  CHECK((contenders == std::vector<std::size_t>{1, 0}));
}
