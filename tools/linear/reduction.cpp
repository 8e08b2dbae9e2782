// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/reduction.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "tools/files/text/error.hpp"

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Eigenvalues of a step between which motions end and memories of iterations begin: where their sizes are furthest apart. A
/// memory of 0.3 has a time constant below a step; its eigenvalue may be negative, which no motion has.
constexpr double kMotion = 0.5;
constexpr double kMemory = 0.3;

Index motions_of(const MatrixXd& a) {
  VectorXd sizes = Eigen::EigenSolver<MatrixXd>(a, false).eigenvalues().cwiseAbs();
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  Index count = sizes.size();
  double widest = 1.0;
  for (Index k = 1; k < sizes.size(); ++k) {
    const double ratio = sizes(k - 1) / std::max(sizes(k), 1e-12);
    if (sizes(k) < kMotion && sizes(k - 1) > kMemory && ratio > widest) {
      widest = ratio;
      count = k;
    }
  }
  return count;
}

/// States that act on what comes or is read, found by leaving out column after column of zeros. What only keeps itself, as
/// the output of an effect that is not active does, is no motion, unless it is a quantity of the equations.
std::vector<Index> acting_states(const StepMap& map) {
  const MatrixXd& a = map.by_state;
  std::vector<Index> acting(static_cast<std::size_t>(a.rows()));
  std::iota(acting.begin(), acting.end(), Index{0});
  for (bool changed = true; changed;) {
    const auto acts = [&](Index column) {
      return (map.output_by_state.col(column).array() != 0.0).any() ||
             std::any_of(acting.begin(), acting.end(), [&](Index row) {
               return (row != column || map.continuous[static_cast<std::size_t>(column)]) && a(row, column) != 0.0;
             });
    };
    std::vector<Index> left;
    std::copy_if(acting.begin(), acting.end(), std::back_inserter(left), acts);
    changed = left.size() < acting.size();
    acting = std::move(left);
  }
  return acting;
}

}  // namespace

VectorXd balancing(MatrixXd a) {
  VectorXd scale = VectorXd::Ones(a.rows());
  constexpr int kSweeps = 20;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Index i = 0; i < a.rows(); ++i) {
      const double row = a.row(i).cwiseAbs().sum() - std::abs(a(i, i));
      const double column = a.col(i).cwiseAbs().sum() - std::abs(a(i, i));
      if (row > 0.0 && column > 0.0) {
        const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
        scale(i) *= factor;
        a.row(i) /= factor;
        a.col(i) *= factor;
      }
    }
  }
  return scale;
}

namespace {

/// An orthonormal basis of the motions of `a` that outlast a step, by subspace iteration.
MatrixXd lasting_motions(const MatrixXd& a, Index count) {
  constexpr int kRounds = 15;  // of eight steps each
  MatrixXd several = a * a;
  several = (several * several).eval();
  several = (several * several).eval();
  MatrixXd basis = MatrixXd::Identity(a.rows(), a.rows());
  basis = basis.leftCols(count).eval();
  // A start that has a part of every motion.
  for (Index i = 0; i < basis.rows(); ++i) {
    for (Index k = 0; k < count; ++k) {
      basis(i, k) += 0.1 * std::cos(static_cast<double>((i + 1) * (k + 2)));
    }
  }
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::HouseholderQR<MatrixXd> factors(several * basis);
    basis = factors.householderQ() * MatrixXd::Identity(a.rows(), count);
  }
  return basis;
}

/// Rows of `basis` that span it, the preferred first.
std::vector<Index> spanning_rows(MatrixXd basis, const std::vector<bool>& preferred, Index count) {
  constexpr double kRounding = 1e-9;     // a state that motions leave where it is
  constexpr double kIndependent = 1e-6;  // of a row: what is left of it after the others
  for (Index i = 0; i < basis.rows(); ++i) {
    const double size = basis.row(i).norm();
    basis.row(i) *= size > kRounding ? 1.0 / size : 0.0;
  }
  std::vector<Index> rows;
  for (const bool stage : {true, false}) {
    while (static_cast<Index>(rows.size()) < count) {
      Index best = -1;
      for (Index i = 0; i < basis.rows(); ++i) {
        if (preferred[static_cast<std::size_t>(i)] == stage && basis.row(i).norm() > kIndependent &&
            (best < 0 || basis.row(i).norm() > basis.row(best).norm())) {
          best = i;
        }
      }
      if (best < 0) {
        break;
      }
      rows.push_back(best);
      const VectorXd direction = basis.row(best).transpose().normalized();
      basis -= (basis * direction) * direction.transpose();
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

MatrixXd rows_of(const MatrixXd& all, const std::vector<Index>& rows) { return all(rows, Eigen::all); }

/// The square root whose eigenvalues have positive real parts [Denman and Beavers 1976, Appl. Math. Comput. 2].
MatrixXd square_root(const MatrixXd& a) {
  constexpr int kMostRounds = 60;
  constexpr double kRounding = 1e-15;
  MatrixXd root = a;
  MatrixXd inverse = MatrixXd::Identity(a.rows(), a.cols());
  for (int round = 0; round < kMostRounds; ++round) {
    const MatrixXd next = 0.5 * (root + inverse.inverse());
    inverse = (0.5 * (inverse + root.inverse())).eval();
    const double change = (next - root).norm();
    root = next;
    if (!(change > kRounding * root.norm())) {
      break;
    }
  }
  return root;
}

}  // namespace

ReducedMap reduced(const StepMap& map) {
  const std::vector<Index> acting = acting_states(map);
  const MatrixXd plain = map.by_state(acting, acting);
  const VectorXd scale = balancing(plain);
  const MatrixXd a = scale.asDiagonal().inverse() * plain * scale.asDiagonal();
  const Index count = motions_of(a);
  std::vector<bool> preferred;
  std::transform(acting.begin(), acting.end(), std::back_inserter(preferred),
                 [&](Index own) { return map.continuous[static_cast<std::size_t>(own)]; });
  const MatrixXd basis = lasting_motions(a, count);
  const std::vector<Index> rows = spanning_rows(basis, preferred, count);
  if (static_cast<Index>(rows.size()) < count) {
    throw UsageError("the model has motions that no quantity of it shows; remedy: fewer effects with a memory");
  }
  // Among the acting states: all of them by those that are kept, while nothing moves the inputs.
  const MatrixXd of_kept_scaled = basis * rows_of(basis, rows).inverse();
  const VectorXd kept_scale = scale(rows);
  const MatrixXd of_kept = scale.asDiagonal() * of_kept_scaled * kept_scale.asDiagonal().inverse();
  const MatrixXd inputs = map.by_input(acting, Eigen::all);
  // The rest, as far as inputs put it off that: it has settled. deviation+ = away deviation + driven input.
  MatrixXd selected = MatrixXd::Zero(count, static_cast<Index>(acting.size()));
  for (Index k = 0; k < count; ++k) {
    selected(k, rows[static_cast<std::size_t>(k)]) = 1.0;
  }
  // In balanced states, as the pivots need it.
  const MatrixXd all = MatrixXd::Identity(a.rows(), a.rows());
  const MatrixXd projected = all - of_kept_scaled * selected;
  const MatrixXd driven = projected * (scale.asDiagonal().inverse() * inputs);
  const MatrixXd settled = (all - projected * a * projected).partialPivLu().solve(driven);
  const MatrixXd of_input = scale.asDiagonal() * settled;

  ReducedMap result;
  std::transform(rows.begin(), rows.end(), std::back_inserter(result.kept),
                 [&](Index row) { return static_cast<int>(acting[static_cast<std::size_t>(row)]); });
  result.a = selected * plain * of_kept;
  result.b = selected * (plain * of_input + inputs);
  // Every state, those that do not act included: acting ones as above, the others as the step before left them.
  const auto states = static_cast<Index>(map.states.size());
  result.of_kept = MatrixXd::Zero(states, count);
  result.of_input = MatrixXd::Zero(states, inputs.cols());
  for (std::size_t i = 0; i < acting.size(); ++i) {
    result.of_kept.row(acting[i]) = of_kept.row(static_cast<Index>(i));
    result.of_input.row(acting[i]) = of_input.row(static_cast<Index>(i));
  }
  return result;
}

ContinuousMap continuous(const MatrixXd& a, const MatrixXd& b, double h) {
  const Index states = a.rows();
  const VectorXd scale = balancing(a);
  const MatrixXd balanced = scale.asDiagonal().inverse() * a * scale.asDiagonal();
  const Eigen::VectorXcd eigenvalues = Eigen::EigenSolver<MatrixXd>(balanced, false).eigenvalues();
  const bool has_logarithm = std::none_of(eigenvalues.begin(), eigenvalues.end(), [](const std::complex<double>& own) {
    return own.real() <= 0.0 && std::abs(own.imag()) <= 1e-9 * std::abs(own);
  });
  const MatrixXd one = MatrixXd::Identity(states, states);
  if (!has_logarithm) {
    const MatrixXd inverse = (a + one).inverse();
    return {2.0 / h * (a - one) * inverse, 2.0 / h * inverse * b, false};
  }
  const MatrixXd scaled_b = scale.asDiagonal().inverse() * b;
  VectorXd input_scale = scaled_b.colwise().norm();
  input_scale = (input_scale.array() > 0.0).select(input_scale, VectorXd::Ones(b.cols()));
  MatrixXd block = MatrixXd::Identity(states + b.cols(), states + b.cols());
  block.topLeftCorner(states, states) = balanced;
  block.topRightCorner(states, b.cols()) = scaled_b * input_scale.asDiagonal().inverse();
  // log m = 2^k log m^(1/2^k) = 2^(k+1) artanh((r - 1) (r + 1)^-1), r the root [Higham 2008, Functions of Matrices, 11].
  constexpr int kRoots = 3;
  constexpr int kTerms = 40;
  MatrixXd root = block;
  for (int k = 0; k < kRoots; ++k) {
    root = square_root(root);
  }
  const MatrixXd all = MatrixXd::Identity(block.rows(), block.cols());
  const MatrixXd z = (root + all).transpose().partialPivLu().solve((root - all).transpose()).transpose();
  const MatrixXd squared = z * z;
  MatrixXd power = z;
  MatrixXd sum = z;
  for (int k = 1; k < kTerms; ++k) {
    power = (power * squared).eval();
    sum += power / (2.0 * k + 1.0);
  }
  const MatrixXd logarithm = std::exp2(kRoots + 1) / h * sum;
  return {scale.asDiagonal() * logarithm.topLeftCorner(states, states) * scale.asDiagonal().inverse(),
          scale.asDiagonal() * logarithm.topRightCorner(states, b.cols()) * input_scale.asDiagonal(), true};
}

}  // namespace hotfire::linear
