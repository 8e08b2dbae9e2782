// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/latin_hypercube.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace hotfire::disperse {

namespace {

/// Numbers whose bits do not depend on the standard library, as those of its distributions do.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  /// Between 0 and 1, neither of them.
  double uniform() { return (static_cast<double>(bits_() >> 11U) + 0.5) * 0x1p-53; }

  /// 0 to count - 1, in random order [Durstenfeld 1964, Communications of the ACM 7, algorithm 235].
  std::vector<int> permutation(int count) {
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t left = order.size(); left > 1; --left) {
      std::swap(order[left - 1], order[static_cast<std::size_t>(uniform() * static_cast<double>(left))]);
    }
    return order;
  }

 private:
  std::mt19937_64 bits_;
};

/// Ranks from 0 of the rows of a column; equal values in the order of the rows.
std::vector<int> ranks_of(const Eigen::VectorXd& column) {
  std::vector<int> order(static_cast<std::size_t>(column.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int one, int other) { return column(one) < column(other); });
  std::vector<int> ranks(order.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    ranks[static_cast<std::size_t>(order[place])] = static_cast<int>(place);
  }
  return ranks;
}

template <std::size_t Terms>
double polynomial(const std::array<double, Terms>& coefficients, double x) {
  return std::accumulate(coefficients.rbegin(), coefficients.rend(), 0.0,
                         [x](double sum, double coefficient) { return sum * x + coefficient; });
}

/// The correlation matrix of the columns, whose means are zero.
Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& scores) {
  const Eigen::MatrixXd products = scores.transpose() * scores;
  const Eigen::VectorXd scale = products.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * products * scale.asDiagonal();
}

}  // namespace

double normal_quantile(double probability) {
  constexpr std::array kCentre{3.387132872796366608,  133.14166789178437745, 1971.5909503065514427, 13731.693765509461125,
                               45921.953931549871457, 67265.770927008700853, 33430.575583588128105, 2509.0809287301226727};
  constexpr std::array kBelowCentre{1.0,
                                    42.313330701600911252,
                                    687.1870074920579083,
                                    5394.1960214247511077,
                                    21213.794301586595867,
                                    39307.89580009271061,
                                    28729.085735721942674,
                                    5226.495278852854561};
  constexpr std::array kFlank{1.42343711074968357734,   4.6303378461565452959,   5.7694972214606914055,
                              3.64784832476320460504,   1.27045825245236838258,  0.24178072517745061177,
                              0.0227238449892691845833, 7.7454501427834140764e-4};
  constexpr std::array kBelowFlank{1.0,
                                   2.05319162663775882187,
                                   1.6763848301838038494,
                                   0.68976733498510000455,
                                   0.14810397642748007459,
                                   0.0151986665636164571966,
                                   5.475938084995344946e-4,
                                   1.05075007164441684324e-9};
  constexpr std::array kTail{6.6579046435011037772,     5.4637849111641143699,    1.7848265399172913358,
                             0.29656057182850489123,    0.026532189526576123093,  0.0012426609473880784386,
                             2.71155556874348757815e-5, 2.01033439929228813265e-7};
  constexpr std::array kBelowTail{1.0,
                                  0.59983220655588793769,
                                  0.13692988092273580531,
                                  0.0148753612908506148525,
                                  7.868691311456132591e-4,
                                  1.8463183175100546818e-5,
                                  1.4215117583164458887e-7,
                                  2.04426310338993978564e-15};
  const double from_centre = probability - 0.5;
  if (std::abs(from_centre) <= 0.425) {
    const double r = 0.180625 - from_centre * from_centre;
    return from_centre * polynomial(kCentre, r) / polynomial(kBelowCentre, r);
  }
  const double r = std::sqrt(-std::log(from_centre < 0.0 ? probability : 1.0 - probability));
  const double size = r <= 5.0 ? polynomial(kFlank, r - 1.6) / polynomial(kBelowFlank, r - 1.6)
                               : polynomial(kTail, r - 5.0) / polynomial(kBelowTail, r - 5.0);
  return from_centre < 0.0 ? -size : size;
}

double normal_probability(double value) { return 0.5 * std::erfc(-value / std::numbers::sqrt2); }

Eigen::MatrixXd latin_hypercube(int draws, const Eigen::MatrixXd& correlation, std::uint64_t seed) {
  const Eigen::Index variables = correlation.rows();
  Random random(seed);
  // Scores of van der Waerden, in an order of its own for each variable.
  Eigen::MatrixXd scores(draws, variables);
  for (Eigen::Index variable = 0; variable < variables; ++variable) {
    const std::vector<int> order = random.permutation(draws);
    for (int draw = 0; draw < draws; ++draw) {
      scores(draw, variable) = normal_quantile((order[static_cast<std::size_t>(draw)] + 1.0) / (draws + 1.0));
    }
  }
  const Eigen::MatrixXd wanted = correlation.llt().matrixL();
  Eigen::MatrixXd paired = scores * wanted.transpose();
  if (draws > variables) {
    // What the scores happen to have in common is taken out first: scores L^-T are uncorrelated.
    if (const Eigen::LLT<Eigen::MatrixXd> own(correlation_of(scores)); own.info() == Eigen::Success) {
      const Eigen::MatrixXd uncorrelated = own.matrixL().solve(scores.transpose()).transpose();
      paired = uncorrelated * wanted.transpose();
    }
  }
  Eigen::MatrixXd sample(draws, variables);
  for (Eigen::Index variable = 0; variable < variables; ++variable) {
    const std::vector<int> ranks = ranks_of(paired.col(variable));
    for (int draw = 0; draw < draws; ++draw) {
      sample(draw, variable) = (ranks[static_cast<std::size_t>(draw)] + random.uniform()) / draws;
    }
  }
  return sample;
}

}  // namespace hotfire::disperse
