// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/controller.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hotfire::loop {

namespace {

Complex interpolated(const std::vector<MeasuredPoint>& points, double frequency) {
  const auto above = std::lower_bound(points.begin(), points.end(), frequency,
                                      [](const MeasuredPoint& point, double f) { return point.frequency < f; });
  if (above == points.begin() || above == points.end()) {
    const MeasuredPoint& end = above == points.end() ? points.back() : points.front();
    return std::polar(std::exp(end.log_gain), end.phase);
  }
  const MeasuredPoint& below = *(above - 1);
  const double share = std::log(frequency / below.frequency) / std::log(above->frequency / below.frequency);
  return std::polar(std::exp(below.log_gain + share * (above->log_gain - below.log_gain)),
                    below.phase + share * (above->phase - below.phase));
}

}  // namespace

Complex Controller::response(double frequency, Complex attitude, Complex rate) const {
  if (is_measured()) {
    return interpolated(measured, frequency) * attitude;
  }
  const Law own = law();
  const auto states = own.a.rows();
  const Eigen::Vector2cd y(attitude, rate);
  const Complex turn = std::polar(1.0, kTurn * frequency * period);
  const Eigen::MatrixXcd dynamics = turn * Eigen::MatrixXcd::Identity(states, states) - own.a.cast<Complex>();
  const Eigen::VectorXcd state = dynamics.partialPivLu().solve(own.b * y);
  return own.c.cast<Complex>().dot(state) + own.d.cast<Complex>().dot(y);
}

Controller::Law Controller::law() const {
  // States: the integral, then two of every section (direct form II transposed). `signal` is a row over states and y.
  const auto states = 1 + 2 * static_cast<Eigen::Index>(sections.size());
  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(states, states + 2);
  Eigen::RowVectorXd integral = Eigen::RowVectorXd::Zero(states + 2);
  integral(0) = 1.0;
  integral(states) = period;
  next.row(0) = integral;
  Eigen::RowVectorXd signal = integral_gain * integral;
  signal(states) += gain;
  signal(states + 1) += rate_gain;
  Eigen::Index first = 1;
  for (const Section& own : sections) {
    Eigen::RowVectorXd out = own.b[0] * signal;
    out(first) += 1.0;
    next.row(first) = own.b[1] * signal - own.a[0] * out;
    next(first, first + 1) += 1.0;
    next.row(first + 1) = own.b[2] * signal - own.a[1] * out;
    signal = out;
    first += 2;
  }
  return {next.leftCols(states), next.rightCols(2), signal.head(states), signal.tail<2>()};
}

}  // namespace hotfire::loop
