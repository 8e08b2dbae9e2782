#include "tools/explain/finalists.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

/// Screened candidates, the best first, as a screening leaves them.
std::vector<Screened<SimplexFamily>> screened(const std::vector<double>& criteria) {
  std::vector<Screened<SimplexFamily>> all;
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
