// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/curve_points.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Places where a point may lie: a feature narrower than three of them is lost.
constexpr std::size_t kPlaces = 200;
/// Points are laid once more, one by one beside the others, so many times.
constexpr int kRounds = 3;

/// A cloud, as the mean of each of `kPlaces` equal intervals.
class Cloud {
 public:
  Cloud(std::span<const double> x, std::span<const double> y, double low, double high)
      : low_(low), width_((high - low) / static_cast<double>(kPlaces)), weight_(kPlaces, 0.0), mean_(kPlaces, 0.0) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto place = std::min(kPlaces - 1, static_cast<std::size_t>((x[i] - low) / width_));
      weight_[place] += 1.0;
      mean_[place] += y[i];
    }
    for (std::size_t place = 0; place < kPlaces; ++place) {
      mean_[place] /= std::max(1.0, weight_[place]);
    }
  }

  double center(std::size_t place) const { return low_ + width_ * (static_cast<double>(place) + 0.5); }

  /// What the best broken line with points at `places` (ascending) leaves of the sum of squares.
  double left_by(const std::vector<std::size_t>& places) const {
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
    double square = 0.0;
    Eigen::Index k = 0;
    for (std::size_t place = 0; place < kPlaces; ++place) {
      while (k + 2 < count && place > places[static_cast<std::size_t>(k) + 1]) {
        ++k;
      }
      const auto below = static_cast<double>(places[static_cast<std::size_t>(k)]);
      const auto above = static_cast<double>(places[static_cast<std::size_t>(k) + 1]);
      const Eigen::Vector2d share((above - static_cast<double>(place)) / (above - below),
                                  (static_cast<double>(place) - below) / (above - below));
      normal.block<2, 2>(k, k) += weight_[place] * share * share.transpose();
      gradient.segment<2>(k) += weight_[place] * mean_[place] * share;
      square += weight_[place] * mean_[place] * mean_[place];
    }
    // A point that no row is near must not make the matrix singular.
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
    return square - gradient.dot(normal.ldlt().solve(gradient));
  }

 private:
  double low_;
  double width_;
  std::vector<double> weight_;
  std::vector<double> mean_;
};

/// Adds a point to `places` where it helps most. Returns what is then left.
double add_best(const Cloud& cloud, std::vector<std::size_t>& places) {
  double least = cloud.left_by(places);
  std::vector<std::size_t> best = places;
  for (std::size_t place = places.front() + 1; place < places.back(); ++place) {
    const auto behind = std::lower_bound(places.begin(), places.end(), place);
    if (*behind == place) {
      continue;
    }
    std::vector<std::size_t> tried = places;
    tried.insert(tried.begin() + (behind - places.begin()), place);
    const double left = cloud.left_by(tried);
    if (left < least) {
      least = left;
      best = std::move(tried);
    }
  }
  places = std::move(best);
  return least;
}

/// Lays every inner point once more, the others where they are.
void lay_again(const Cloud& cloud, std::vector<std::size_t>& places) {
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    std::vector<std::size_t> others = places;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const std::size_t count = places.size();
    add_best(cloud, others);
    if (others.size() == count) {
      places = std::move(others);
    }
  }
}

}  // namespace

std::vector<double> curve_points(std::span<const double> x, std::span<const double> y, std::size_t most) {
  if (x.empty()) {
    return {};
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (!(*high > *low)) {
    return {};
  }
  const Cloud cloud(x, y, *low, *high);
  std::vector<std::size_t> places{0, kPlaces - 1};
  // Strong evidence, for the best of so many places.
  const double worth = policy().strong_evidence + 2.0 * std::log(static_cast<double>(kPlaces));
  double left = cloud.left_by(places);
  while (places.size() < most) {
    // Of the three points of a bump the first two show little: they are let in on trust.
    std::vector<std::size_t> tried = places;
    double after = left;
    double price = 0.0;
    do {
      after = add_best(cloud, tried);
      price += worth;
    } while (left - after <= price && price < 3.0 * worth && tried.size() < most);
    if (left - after <= price) {
      break;
    }
    places = std::move(tried);
    left = after;
  }
  for (int round = 0; round < kRounds; ++round) {
    lay_again(cloud, places);
  }
  std::vector<double> points;
  points.reserve(places.size());
  for (const std::size_t place : places) {
    points.push_back(cloud.center(place));
  }
  points.front() = *low;
  points.back() = *high;
  return points;
}

}  // namespace hotfire::explain
