// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/flight.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>

#include "tools/files/text/error.hpp"

namespace hotfire::loop {

namespace {

std::size_t place_of(const std::vector<plant::Variable>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const plant::Variable& own) { return own.name == name; });
  if (found == all.end()) {
    throw UsageError("the plant has no signal " + name + "; allowed topology: masv");
  }
  return static_cast<std::size_t>(found - all.begin());
}

/// A stage, its plant and its controller between two steps of the plant.
class Flight {
 public:
  Flight(const plant::AnyParameters& parameters, const Stage& stage, const Controller& controller)
      : stage_(stage), controller_(controller), law_(controller.law()) {
    plant::Setup setup;
    setup.period = controller.period;
    steps_ = plant::make_plant(parameters, setup)->steps();
    setup.period = controller.period / steps_;
    plant_ = plant::make_plant(parameters, setup);
    for (int i = 0; i < stage.axes(); ++i) {
      if (axis_name(i).starts_with(controller.axis)) {
        commands_.push_back(place_of(plant_->inputs(), "command." + axis_name(i)));
      }
      engines_.push_back(place_of(plant_->outputs(), "engine." + axis_name(i)));
    }
    plant_->start(0.0);
    rest_ = outputs();
    angles_ = Eigen::VectorXd::Zero(stage.axes());
    step_ = stage.step(setup.period);
    memory_ = Eigen::VectorXd::Zero(law_.a.rows());
    const auto delay = static_cast<std::size_t>(std::lround(controller.delay / setup.period));
    given_.assign(delay + 1, 0.0);
  }

  void turn(double attitude) { state_ = stage_.turned(attitude); }

  /// Runs the plant alone under the command of a cycle, then puts stage and controller on the cycle. False if the plant ran
  /// away.
  bool run_in(const LimitCycle& cycle);

  FlightRecord fly(double seconds);

 private:
  Eigen::VectorXd outputs() const {
    Eigen::VectorXd all(stage_.axes());
    for (int i = 0; i < stage_.axes(); ++i) {
      all(i) = plant_->output_values()[engines_[static_cast<std::size_t>(i)]];
    }
    return all;
  }

  /// A step of the plant under the command that its controller gave a delay ago. False if it ran away.
  bool advance(double command) {
    given_[now_] = command;
    now_ = (now_ + 1) % given_.size();
    for (const std::size_t own : commands_) {
      plant_->input_values()[own] = given_[now_];
    }
    if (!plant_->advance()) {
      return false;
    }
    angles_ = outputs() - rest_;
    return true;
  }

  void settle_on(const LimitCycle& cycle, const Eigen::VectorXcd& angles, std::int64_t sample);

  const Stage& stage_;
  const Controller& controller_;
  const Controller::Law law_;
  int steps_ = 1;  ///< of the plant between two samples
  std::unique_ptr<plant::Plant> plant_{};
  std::vector<std::size_t> commands_{};
  std::vector<std::size_t> engines_{};
  Eigen::VectorXd rest_{};
  Eigen::VectorXd angles_{};  ///< of the engines, from rest [rad]
  Stage::Step step_{};
  Eigen::VectorXd state_{};         ///< of the stage
  Eigen::VectorXd memory_{};        ///< of the controller
  std::vector<double> given_{0.0};  ///< commands of the steps that are on their way
  std::size_t now_ = 0;
};

bool Flight::run_in(const LimitCycle& cycle) {
  // Under friction the angles settled within 24 periods, or beat for ever by 2 %, which the closed loop forgets.
  constexpr int kMostPeriods = 24;
  constexpr double kSettled = 1e-3;  // change of the fundamentals over a period, as a balance may be off
  const double angle = kTurn * cycle.frequency * controller_.period;  // from sample to sample
  const auto samples = static_cast<std::int64_t>(std::lround(1.0 / (cycle.frequency * controller_.period)));
  Eigen::VectorXcd last = Eigen::VectorXcd::Zero(stage_.axes());
  std::int64_t sample = 0;
  for (int period = 0; period < kMostPeriods; ++period) {
    // Least squares of mean, cosine and sine: a period is no whole number of samples.
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, stage_.axes());
    for (std::int64_t own = 0; own < samples; ++own, ++sample) {
      const double command = cycle.amplitude * std::cos(angle * static_cast<double>(sample));
      for (int k = 0; k < steps_; ++k) {
        if (!advance(command)) {
          return false;
        }
        const double at = angle * (static_cast<double>(sample) + (k + 1.0) / steps_);
        const Eigen::Vector3d basis(1.0, std::cos(at), std::sin(at));
        products += basis * basis.transpose();
        sums += basis * angles_.transpose();
      }
    }
    const Eigen::Matrix3Xd fit = products.ldlt().solve(sums);
    const Eigen::VectorXcd now = fit.row(1).transpose() - Complex(0.0, 1.0) * fit.row(2).transpose();
    const double change = (now - last).norm();
    last = now;
    if (change < kSettled * last.norm()) {
      break;
    }
  }
  settle_on(cycle, last, sample);
  return true;
}

/// Stage and controller in the periodic state at a sample, under these fundamentals of the engine angles.
void Flight::settle_on(const LimitCycle& cycle, const Eigen::VectorXcd& angles, std::int64_t sample) {
  const double turned = kTurn * cycle.frequency * controller_.period;
  const auto phasor = [](const Eigen::MatrixXd& dynamics, const Complex& z, const Eigen::VectorXcd& driven) {
    const auto states = dynamics.rows();
    const Eigen::MatrixXcd own = z * Eigen::MatrixXcd::Identity(states, states) - dynamics.cast<Complex>();
    return Eigen::VectorXcd(own.partialPivLu().solve(driven));
  };
  const Complex step = std::polar(1.0, turned / steps_);
  const Eigen::VectorXcd moved = phasor(step_.by_state, step, step_.by_angle * angles * (0.5 * (1.0 + step)));
  const Eigen::VectorXcd kept = phasor(law_.a, std::polar(1.0, turned), law_.b * (step_.read * moved));
  const Complex now = std::polar(1.0, turned * static_cast<double>(sample));
  state_ = (moved * now).real();
  memory_ = (kept * now).real();
}

FlightRecord Flight::fly(double seconds) {
  FlightRecord record;
  constexpr double kRunaway = 1.0;  // rad
  const auto samples = static_cast<int>(std::ceil(seconds / controller_.period));
  for (int sample = 0; sample < samples; ++sample) {
    const Eigen::Vector2d read = step_.read * state_;
    const double command = -(law_.c.dot(memory_) + law_.d.dot(read));
    memory_ = (law_.a * memory_ + law_.b * read).eval();
    record.time.push_back(sample * controller_.period);
    record.command.push_back(command);
    record.attitude.push_back(read(0));
    record.ran_away = !(std::abs(read(0)) < kRunaway);
    for (int k = 0; k < steps_ && !record.ran_away; ++k) {
      const Eigen::VectorXd before = angles_;
      record.ran_away = !advance(command);
      state_ = (step_.by_state * state_ + step_.by_angle * (0.5 * (before + angles_))).eval();
    }
    if (record.ran_away) {
      break;
    }
  }
  return record;
}

}  // namespace

FlightRecord fly(const plant::AnyParameters& parameters, const Stage& stage, const Controller& controller,
                 const FlightPlan& plan) {
  if (controller.is_measured()) {
    throw UsageError(
        "a measured frequency response is not a law in time; remedy: leave out --attitudes, or give gain and filters");
  }
  Flight flight(parameters, stage, controller);
  if (plan.on) {
    if (!flight.run_in(*plan.on)) {
      return {{}, {}, {}, true};
    }
  } else {
    flight.turn(plan.attitude);
  }
  return flight.fly(plan.seconds);
}

}  // namespace hotfire::loop
