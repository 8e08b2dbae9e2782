// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/latin_hypercube.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <CppUTest/TestHarness.h>

namespace hotfire::disperse {

namespace {

Eigen::MatrixXd equal_correlation(int variables, double correlation) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(variables, variables, correlation);
  matrix.diagonal().setOnes();
  return matrix;
}

/// Correlation of the normal variables that a sample gives.
double normal_correlation(const Eigen::MatrixXd& sample, int one, int other) {
  const Eigen::VectorXd x = sample.col(one).unaryExpr([](double p) { return normal_quantile(p); });
  const Eigen::VectorXd y = sample.col(other).unaryExpr([](double p) { return normal_quantile(p); });
  return x.dot(y) / std::sqrt(x.squaredNorm() * y.squaredNorm());
}

}  // namespace

TEST_GROUP(LatinHypercube){};

TEST(LatinHypercube, EveryIntervalOfEveryVariableHoldsOneDraw) {
  constexpr int kDraws = 200;
  const Eigen::MatrixXd sample = latin_hypercube(kDraws, equal_correlation(7, 0.5), 3);
  LONGS_EQUAL(kDraws, sample.rows());
  LONGS_EQUAL(7, sample.cols());
  for (Eigen::Index variable = 0; variable < sample.cols(); ++variable) {
    std::set<int> intervals;
    for (const double probability : sample.col(variable)) {
      CHECK(probability > 0.0 && probability < 1.0);
      intervals.insert(static_cast<int>(probability * kDraws));
    }
    LONGS_EQUAL(kDraws, intervals.size());
  }
}

// Random pairing of 1,000 draws has correlations of 0.03 (one sigma); what the ranks leave of it is below a third of that.
TEST(LatinHypercube, VariablesHaveTheCorrelationThatIsAskedFor) {
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Identity(5, 5);
  wanted.topLeftCorner(3, 3) = equal_correlation(3, 0.6);
  const Eigen::MatrixXd sample = latin_hypercube(1000, wanted, 11);
  for (int one = 0; one < 5; ++one) {
    for (int other = 0; other < one; ++other) {
      DOUBLES_EQUAL(wanted(one, other), normal_correlation(sample, one, other), 0.01);
    }
  }
}

TEST(LatinHypercube, AFewDrawsOfManyVariablesAreDrawnAsWell) {
  const Eigen::MatrixXd sample = latin_hypercube(3, equal_correlation(8, 0.2), 1);
  CHECK(sample.allFinite());
}

TEST(LatinHypercube, ASeedGivesTheSameDrawsAndAnotherSeedOthers) {
  const Eigen::MatrixXd wanted = equal_correlation(3, 0.0);
  CHECK(latin_hypercube(50, wanted, 1) == latin_hypercube(50, wanted, 1));
  CHECK(latin_hypercube(50, wanted, 1) != latin_hypercube(50, wanted, 2));
}

// Values: NIST/SEMATECH e-Handbook, and R's qnorm.
TEST(LatinHypercube, TheNormalQuantileIsThatOfTables) {
  DOUBLES_EQUAL(0.0, normal_quantile(0.5), 0.0);
  DOUBLES_EQUAL(1.959963984540054, normal_quantile(0.975), 1e-14);
  DOUBLES_EQUAL(-2.326347874040841, normal_quantile(0.01), 1e-14);
  DOUBLES_EQUAL(-6.361340902404056, normal_quantile(1e-10), 1e-13);
}

TEST(LatinHypercube, TheNormalQuantileInvertsTheProbability) {
  for (double x = -8.0; x < 5.0; x += 0.0625) {
    // Beyond 5, 1 - p has too few digits to tell x.
    DOUBLES_EQUAL(x, normal_quantile(normal_probability(x)), 1e-9 * std::max(1.0, std::abs(x)));
  }
}

}  // namespace hotfire::disperse
