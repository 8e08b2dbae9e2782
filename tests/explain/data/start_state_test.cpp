// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/start_state.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

namespace {

constexpr double kStartStatePeriod = 0.001;
constexpr double kStartStateNoise = 1e-7;

/// A mass of 95 kg with an undeclared constant friction of 20 N, under a force that jumps to 90 N and rises: closed form.
struct Pushed {
  std::vector<double> force;
  std::vector<std::vector<double>> measured = std::vector<std::vector<double>>(3);  ///< by channel of the plant

  Pushed(double velocity, double noise) {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal(0.0, noise);
    for (int row = 0; row < 200; ++row) {
      const double t = row * kStartStatePeriod;
      force.push_back(90.0 + 2000.0 * t);
      measured[0].push_back(0.1 + velocity * t + (70.0 * t * t / 2 + 2000.0 * t * t * t / 6) / 95.0 + normal(generator));
    }
  }
};

hotfire::explain::StartState start_of(const Pushed& pushed) {
  hotfire::DirectParameters mass;
  mass.mass.inertia = 95.0;
  mass.mass.damping = 0.0;
  mass.mass.stiffness = 0.0;
  const std::vector<double> noise(3, kStartStateNoise);
  return hotfire::explain::start_state(mass, pushed.force, pushed.measured, kStartStatePeriod, noise);
}

}  // namespace

TEST_GROUP(StartState){};

TEST(StartState, AMassThatMovesAtTheFirstRowIsFoundMovingWithinFourStandardErrors) {
  const auto start = start_of(Pushed(0.0065, kStartStateNoise));
  CHECK(start.moves());
  CHECK(std::abs(start.velocity - 0.0065) < 4.0 * start.velocity_error);
  CHECK(std::abs(start.position - 0.1) < 4.0 * start.position_error);
  // Twenty rows and a free constant force: 192 noise / (n^3)^(1/2) / period bounds the slope's error of a parabola fit.
  CHECK(start.velocity_error < 192.0 * kStartStateNoise / std::sqrt(8000.0) / kStartStatePeriod);
}

TEST(StartState, AMassThatIsPushedFromRestIsNotTakenToMove) { CHECK(!start_of(Pushed(0.0, kStartStateNoise)).moves()); }

TEST(StartState, AVelocityAloneSaysHowFastAMassWithoutASpringStartsAndNotWhere) {
  Pushed pushed(0.0, 0.0);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0.0, 1e-4);
  pushed.measured[0].clear();
  for (int row = 0; row < 200; ++row) {
    const double t = row * kStartStatePeriod;
    pushed.measured[1].push_back(0.0065 + (70.0 * t + 2000.0 * t * t / 2) / 95.0 + normal(generator));
  }
  const auto start = start_of(pushed);
  CHECK(start.moves());
  CHECK(std::abs(start.velocity - 0.0065) < 4.0 * start.velocity_error);
  DOUBLES_EQUAL(0.0, start.position_error, 0.0);
}

TEST(StartState, ARecordOfFewRowsTakesItsFirstRowAsPosition) {
  Pushed pushed(0.0, 0.0);
  pushed.force.resize(3);
  pushed.measured[0].resize(3);
  const auto start = start_of(pushed);
  DOUBLES_EQUAL(0.1, start.position, 0.0);
  CHECK(!start.moves());
}

namespace {

/// White noise of one, and at the start what the axis remembers, `size` at the first row and e^-1 of it every 100 rows.
std::vector<double> left_by_a_model(double size, double noise, std::size_t rows) {
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<double> left;
  for (std::size_t row = 0; row < rows; ++row) {
    left.push_back(size * std::exp(-0.01 * static_cast<double>(row)) + normal(generator));
  }
  return left;
}

}  // namespace

// A start of twice the noise stands out: 1.2 is below it, 5 is above it.
TEST(StartState, WhatDiesOutAtTheStartIsAMotionBeforeTheRecord) {
  using hotfire::explain::dies_out_at_start;
  constexpr std::size_t kMemory = 900;
  CHECK(dies_out_at_start(left_by_a_model(5.0, 1.0, 5000), kMemory, 1.0));
  CHECK(!dies_out_at_start(left_by_a_model(1.2, 1.0, 5000), kMemory, 1.0));
  CHECK(!dies_out_at_start(left_by_a_model(0.0, 1.0, 5000), kMemory, 1.0));
  // It is no larger than what the model leaves anyhow.
  CHECK(!dies_out_at_start(left_by_a_model(5.0, 3.0, 5000), kMemory, 1.0));
  // It stays.
  std::vector<double> stays = left_by_a_model(0.0, 1.0, 5000);
  for (std::size_t row = 0; row < kMemory; ++row) {
    stays[row] += 5.0;
  }
  CHECK(!dies_out_at_start(stays, kMemory, 1.0));
  // There is nothing beyond the memory to compare with.
  CHECK(!dies_out_at_start(left_by_a_model(5.0, 1.0, kMemory), kMemory, 1.0));
}
