// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>
#include <random>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/latent/correlation.hpp"
#include "tools/explain/latent/form_comb.hpp"
#include "tools/explain/latent/oscillation_search.hpp"
#include "tools/explain/policy/policy.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;
using explain::Form;
using explain::FormRegression;
using explain::LatentPlace;
using explain::ScoredForm;
using model::Argument;
using model::Memory;

constexpr LatentPlace kPistonSensor{std::nullopt, 0};

/// What a piston sensor adds that is a law of the command, which no smoother changes. A row is read before its command acts.
template <class Law>
Record with_reading(Law&& law, Record record = record_of(declared())) {
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[1].values[row] += law(record.channels[0].values[row == 0 ? 0 : row - 1]);
  }
  return record;
}

/// The smoothed signal of a place for a record.
struct AtPlace {
  AtPlace(const Record& record, const LatentPlace& where, double period = 0.0)
      : place(where),
        data(explain::thinned(explain::make_dataset(declared(), {record}), period)),
        problem(explain::latent_problem(data, data, about_declared(), explain::Resolution::coarse, 2)),
        input(explain::most_likely_input(problem, place)) {
    explain::smooth(problem, place, input);
  }

  FormRegression regression() const { return {problem, place, input, FormRegression::Arguments::simulated}; }

  LatentPlace place;
  explain::Dataset data;
  explain::LatentProblem problem;
  explain::LatentInput input;
};

/// The best form of the sensor's place for a record.
struct Best {
  explicit Best(const Record& record, double period = 0.0) {
    const AtPlace sensor(record, kPistonSensor, period);
    form = explain::search_forms(sensor.regression(), kPistonSensor, 1, 2).at(0);
  }

  ScoredForm form;
};

}  // namespace

TEST_GROUP(FormSearch){};

TEST(FormSearch, MemoriesThatRunSideBySideAreThoseOfEachAlone) {
  Eigen::VectorXd entering(500);
  for (Eigen::Index row = 0; row < entering.size(); ++row) {
    entering(row) = std::sin(0.1 * static_cast<double>(row)) + 0.4 * std::sin(0.37 * static_cast<double>(row));
  }
  constexpr double kRow = 0.004;
  for (std::size_t kind = 0; kind < model::kMemoryNames.size(); ++kind) {
    if (static_cast<Memory>(kind) == Memory::stops) {
      continue;
    }
    std::array<Form, explain::kSideBySide> forms;
    double size = 1.0;
    for (Form& form : forms) {
      size *= 1.5;
      form.memory = {static_cast<Memory>(kind), 0.01 * size, 2.0 * size, 0.2 * size, 0.1 * size, 0.3 * size, 1.2 * size};
    }
    const auto together = explain::remembered_side_by_side(forms, entering, kRow);
    for (std::size_t k = 0; k < forms.size(); ++k) {
      const Eigen::VectorXd alone = explain::remembered(forms[k], entering, kRow);
      CHECK(together.row(static_cast<Eigen::Index>(k)).transpose() == alone);
    }
  }
}

// Eleven points over the range would put none inside of +-0.3 mrad, a twentieth of it.
TEST(FormSearch, ANarrowKinkIsFoundWithItsWidth) {
  static constexpr double kWidth = 3e-4;
  const Best best(with_reading([](double command) { return -0.5 * std::clamp(command, -kWidth, kWidth); }));
  CHECK(best.form.form.argument == Argument::command);
  CHECK(best.form.score.left < 1.1);
  const bool is_kink = best.form.form.memory.kind == Memory::saturation;
  CHECK(is_kink || best.form.form.has_curve());
  if (is_kink) {
    DOUBLES_EQUAL(kWidth, best.form.form.memory.width, 0.1 * kWidth);
  }
}

TEST(FormSearch, ACurveWithWavesIsFollowedToTheNoise) {
  const Best best(with_reading([](double command) { return 12.0 * kPistonNoise * std::sin(600.0 * command); }));
  CHECK(best.form.form.argument == Argument::command);
  CHECK(best.form.score.left < 1.3);
}

// At any other period the samples are soon out of step.
TEST(FormSearch, AHeldSignalIsFoundAtItsOwnNumberOfRows) {
  static constexpr int kRows = 5;
  const Best best(with_reading([row = 0, held = 0.0](double command) mutable {
    held = row++ % kRows == 0 ? command : held;
    return 0.5 * (held - command);
  }));
  CHECK(best.form.form.memory.kind == Memory::hold);
  CHECK(best.form.form.argument == Argument::command);
  DOUBLES_EQUAL(kRows * 2e-3, best.form.form.memory.time, 1e-9);
}

// The sampling of a real signal is at no special row when a record starts.
TEST(FormSearch, AHeldSignalIsFoundWithThePhaseOfItsSamples) {
  static constexpr int kRows = 10;
  static constexpr int kPassed = 3;
  const Best best(with_reading([row = 0, held = 0.0](double command) mutable {
    held = (row++ + kPassed) % kRows == 0 ? command : held;
    return 0.5 * (held - command);
  }));
  CHECK(best.form.form.memory.kind == Memory::hold);
  DOUBLES_EQUAL(kRows * 2e-3, best.form.form.memory.time, 1e-9);
  DOUBLES_EQUAL(2.0 * std::numbers::pi * kPassed / kRows, best.form.form.memory.phase, 2.0 * std::numbers::pi * 0.5 / kRows);
}

// Every other row is left out, and with them half of the samples.
TEST(FormSearch, AHeldSignalIsFoundInThinnedRowsThatMissItsSamples) {
  static constexpr int kRows = 7;
  const Best best(with_reading([row = 0, held = 0.0](double command) mutable {
                    held = row++ % kRows == 0 ? command : held;
                    return 0.5 * (held - command);
                  }),
                  4e-3);
  CHECK(best.form.form.memory.kind == Memory::hold);
  CHECK(best.form.form.argument == Argument::command);
  DOUBLES_EQUAL(kRows * 2e-3, best.form.form.memory.time, 1e-9);
}

// Only the steps exceed the limit: it takes something off in one row of 200.
TEST(FormSearch, ARateLimitThatIsExceededForMomentsOnlyIsFound) {
  static constexpr double kLimit = 0.4;  // rad/s
  const Best best(with_reading([limited = 0.0](double command) mutable {
    limited += std::clamp(command - limited, -kLimit * 2e-3, kLimit * 2e-3);
    return 0.5 * (limited - command);
  }));
  CHECK(best.form.form.memory.kind == Memory::slew);
  CHECK(best.form.form.argument == Argument::command);
  DOUBLES_EQUAL(kLimit, best.form.form.memory.width, 0.05 * kLimit);
}

TEST(FormSearch, ALawWhoseSizeDriftsIsAProductWithTime) {
  const Best best(with_reading([row = 0](double command) mutable { return 5e-4 * command * (2e-3 * row++); }));
  CHECK(best.form.form.argument == Argument::command && best.form.form.factor == Argument::time);
  CHECK(best.form.score.left < 1.1);
}

// In the resonance of the load. Filters of the deflection, and curves over what they make of it, leave twice as much.
TEST(FormSearch, ACurveInFrontOfAFilterIsFoundThatNothingBehindTheFilterShows) {
  ModelFile truth = declared();
  add_effect<model::Term<model::Site::engine_torque>>(std::get<SimplexParameters>(truth.parameters), [](auto& term) {
    term.option = static_cast<int>(Memory::washout);
    term.argument = static_cast<int>(Argument::deflection);
    term.order = static_cast<int>(model::term::Order::curve_first);
    term.time = 0.03;
    term.table.points = 9;
    for (std::size_t i = 0; i < 9; ++i) {
      const double x = 0.25 * (static_cast<double>(i) - 4.0);
      term.table.x[i] = 4e-4 * x;
      term.table.y[i] = 4e3 * x * std::pow(std::abs(x), 1.4);
    }
  });
  constexpr LatentPlace kEngine{explain::Port::engine, 0};
  const AtPlace engine(record_of(truth), kEngine);
  const ScoredForm best = explain::search_forms(engine.regression(), kEngine, 1, 2).at(0);
  CHECK(best.form.curve_first && best.form.is_filter());
  CHECK(best.form.argument == Argument::deflection || best.form.argument == Argument::load_pressure);
  CHECK(best.score.left < explain::policy().left_by_single);
}

// The smoothed signal contains what the problem's parameters move too: here as much of the command as of the torque. A
// regression on the readings moves them beside a form. A gain explains nothing of a curve that is even.
TEST(FormSearch, AnEvenCurveIsFoundInTheReadingsWhereHalfOfTheSignalIsOfAParameter) {
  ModelFile truth = declared();
  add_effect<model::Term<model::Site::engine_torque>>(std::get<SimplexParameters>(truth.parameters), [](auto& term) {
    term.argument = static_cast<int>(Argument::error);
    term.table.points = 9;
    for (std::size_t i = 0; i < 9; ++i) {
      const double x = 0.25 * (static_cast<double>(i) - 4.0);
      term.table.x[i] = 3e-3 * x;
      term.table.y[i] = 600.0 * (1.0 - std::cos(std::numbers::pi * x));
    }
  });
  constexpr LatentPlace kEngine{explain::Port::engine, 0};
  AtPlace engine(record_of(truth), kEngine);
  Eigen::VectorXd& signal = engine.input.signal.front();
  const Eigen::VectorXd command = engine.regression().quantities().front().col(static_cast<Eigen::Index>(Argument::command));
  signal += signal.norm() / command.norm() * command;
  const ScoredForm best = explain::search_forms(engine.regression(), kEngine, 1, 2).at(0);
  CHECK(best.form.argument == Argument::error);
  CHECK(best.form.memory.kind == Memory::none || best.form.memory.kind == Memory::saturation);
  CHECK(best.score.left < 1.1);
}

// A quantum that is off by a hundredth is off by half a quantum at the ends of the range.
TEST(FormSearch, AFineQuantumOfASignalIsFound) {
  static constexpr double kQuantum = 1.5e-4;  // m, a fiftieth of the range
  Record record = record_of(declared());
  for (double& value : record.channels[1].values) {
    value = kQuantum * std::round(value / kQuantum);
  }
  const Best best(record);
  CHECK(best.form.form.memory.kind == Memory::quantise || best.form.form.memory.kind == Memory::periodic);
  CHECK(best.form.form.argument == Argument::position);
  DOUBLES_EQUAL(kQuantum, best.form.form.memory.width, 2e-3 * kQuantum);
}

// A curve through points would end with the records.
TEST(FormSearch, APowerIsFoundWithItsExponent) {
  static constexpr double kUnit = 5e-3;  // rad
  for (const double exponent : {1.6, 2.4}) {
    for (const bool even : {true, false}) {
      const Best best(with_reading([&](double command) {
        const double size = 12.0 * kPistonNoise * std::pow(std::abs(command) / kUnit, exponent);
        return even || command > 0.0 ? size : -size;
      }));
      CHECK(best.form.form.memory.kind == (even ? Memory::even_power : Memory::odd_power));
      CHECK(best.form.form.argument == Argument::command && !best.form.form.factor);
      DOUBLES_EQUAL(exponent, best.form.form.memory.exponent, 0.1);
    }
  }
}

// Half as wide again: the refinement goes on until the response explains most.
TEST(FormSearch, AFormThatWasFoundElsewhereIsTunedToThePlaceThatItIsMovedTo) {
  static constexpr double kWidth = 2e-3;
  const AtPlace sensor(with_reading([](double command) { return -0.5 * std::clamp(command, -kWidth, kWidth); }),
                       kPistonSensor);
  ScoredForm elsewhere;
  elsewhere.form.site = model::Site::flow;
  elsewhere.form.argument = Argument::command;
  elsewhere.form.memory.kind = Memory::saturation;
  elsewhere.form.memory.width = 1.5 * kWidth;
  const FormRegression regression = sensor.regression();
  const auto moved = explain::moved_forms(regression, kPistonSensor, {elsewhere}, {}, 2);
  CHECK_EQUAL(1, moved.size());
  CHECK(moved.front().form.site == model::Site::sensor);
  CHECK_EQUAL(0, moved.front().form.channel);
  DOUBLES_EQUAL(kWidth, moved.front().form.memory.width, 0.1 * kWidth);
  CHECK(explain::moved_forms(regression, kPistonSensor, {elsewhere}, moved, 2).empty());
}

// In a loop a regression finds less of the memory and of the signal that it replaces. The whole of both is one more start.
TEST(FormSearch, AMemoryOfTheSignalOfASiteMayReplaceIt) {
  const auto form_of = [](model::Site site, Argument argument, Memory kind, double criterion) {
    ScoredForm scored;
    scored.form.site = site;
    scored.form.argument = argument;
    scored.form.memory.kind = kind;
    scored.score.criterion = criterion;
    scored.score.coefficients = Eigen::Vector2d(0.6, -0.9);
    scored.score.move = Eigen::VectorXd::Constant(3, 0.5);
    return scored;
  };
  using enum model::Site;
  ScoredForm product = form_of(flow, Argument::spool, Memory::hold, 1.0);
  product.form.factor = Argument::rate;
  ScoredForm curved = form_of(flow, Argument::spool, Memory::hold, 2.0);
  curved.form.memory.time = 0.028;
  curved.form.curve_first = true;
  curved.form.points = {-1.0, 1.0};
  const auto replaced = explain::replacing({product, curved, form_of(flow, Argument::spool, Memory::hold, 3.0),
                                            form_of(flow, Argument::spool, Memory::washout, 1.0),
                                            form_of(valve_command, Argument::spool, Memory::lag, 1.0),
                                            form_of(valve_command, Argument::valve_command, Memory::lag, 4.0)});
  CHECK_EQUAL(2, replaced.size());
  // What the spool does acts at the valve, by the samples of the better one.
  CHECK(replaced[0].form.site == valve);
  DOUBLES_EQUAL(0.028, replaced[0].form.memory.time, 0.0);
  CHECK(replaced[0].form.points.empty() && !replaced[0].form.curve_first);
  CHECK(replaced[1].form.site == valve_command);
  for (const ScoredForm& form : replaced) {
    DOUBLES_EQUAL(1.0, form.score.coefficients(0), 0.0);
    DOUBLES_EQUAL(-1.0, form.score.coefficients(1), 0.0);
    DOUBLES_EQUAL(0.0, form.score.move.norm(), 0.0);
  }
}

// A curve that rises and falls within the motion: behind one that only rises, a play is one in front of it.
TEST(FormSearch, APlayBehindACurveIsFoundWithItsWidth) {
  constexpr double kHalfWidth = 3.0 * kPistonNoise;
  double follows = 0.0;
  const Best best(with_reading([&](double command) {
    const double curve = 12.0 * kPistonNoise * std::sin(1500.0 * command);
    follows = curve - std::clamp(curve - follows, -kHalfWidth, kHalfWidth);
    return follows;
  }));
  const Form& form = best.form.form;
  CHECK(form.argument == Argument::command);
  CHECK(form.curve_first);
  CHECK(form.memory.kind == Memory::play || form.memory.kind == Memory::stop);
  CHECK(best.form.score.left < 1.5);
  DOUBLES_EQUAL(kHalfWidth, form.memory.width * std::abs(best.form.score.coefficients(0)), 0.2 * kHalfWidth);
}

namespace {

/// Checks that an oscillation at the piston's sensor is found, with its curve at the commands `at`. `shift` adds to
/// `frequency` [Hz] by the command. `tall` is the amplitude over the noise.
template <class Shift>
void check_oscillation_is_found(const Record& quiet, double frequency, double tall, Shift shift,
                                std::initializer_list<double> at) {
  const AtPlace sensor(with_reading(
                           [&, turns = 0.0](double command) mutable {
                             turns += 2e-3 * (frequency + shift(command));
                             return tall * kPistonNoise * std::sin(2.0 * std::numbers::pi * turns);
                           },
                           quiet),
                       kPistonSensor);
  const FormRegression regression = sensor.regression();
  CHECK(regression.left_without() > explain::policy().left_by_single);
  const std::vector<Form> forms = explain::find_oscillations(regression, kPistonSensor, 2);
  const std::vector<explain::FormScore> scores = regression.score(forms, 1);
  const auto best = std::ranges::min_element(scores, {}, &explain::FormScore::left);
  CHECK(best != scores.end());
  const Form& form = forms[static_cast<std::size_t>(best - scores.begin())];
  CHECK(form.argument == Argument::command);
  CHECK(best->left < 1.3);
  // A quarter of a cycle over the 20 s of the record is 0.01 Hz; a straight piece of the curve is off by a tenth of it.
  for (const double command : at) {
    DOUBLES_EQUAL(frequency + shift(command), form.memory.frequency + form.entering(command), 0.25);
  }
}

}  // namespace

TEST(FormSearch, AnOscillationWhoseFrequencyMovesIsFoundWithItsCurve) {
  check_oscillation_is_found(record_of(declared()), 7.3, 4.0,
                             [](double command) { return 2.0 * std::tanh(300.0 * command); },
                             {-5e-3, -2e-3, 0.0, 2e-3, 5e-3});
}

// In a slow motion a phase is off by turns before the frequency comes back. A straight line through the whole range, and one
// through a third of it, both start a fit that ends so.
TEST(FormSearch, AnOscillationWhoseFrequencyStopsMovingIsFoundInASlowMotionWithoutALostTurn) {
  const Record slow =
      record_under(declared(), [](double t) { return t < 0.5 ? 0.0 : 8e-3 * std::sin(0.62 * t) * std::sin(0.9 * t); });
  check_oscillation_is_found(slow, 10.0, 2.0, [](double command) { return 6.0 * std::clamp(command / 5e-3, -1.0, 1.0); },
                             {-6e-3, -2e-3, 0.0, 2e-3, 6e-3});
}

TEST_GROUP(CorrelationRatio){};

TEST(CorrelationRatio, AFunctionOfAnyShapeExplainsAllAndAnIndependentSignalNothing) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> x;
  std::vector<double> even;
  std::vector<double> noise;
  for (int i = 0; i < 20000; ++i) {
    x.push_back(uniform(random));
    even.push_back(x.back() * x.back() - 1.0 / 3.0);
    noise.push_back(uniform(random));
  }
  // Within a bin a parabola varies by a thousandth of its variance; 31 degrees of freedom of 20,000 are by chance.
  CHECK(explain::correlation_ratio(x, even) > 0.99);
  CHECK(explain::correlation_ratio(x, noise) < 0.005);
}

TEST(CorrelationRatio, AValueWithAFewLargePeaksExplainsASignalThatFollowsIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const double elsewhere : {0.0, 1e-3}) {
    std::vector<double> x;
    for (int i = 0; i < 20000; ++i) {
      x.push_back(i % 1000 == 0 ? uniform(random) : elsewhere * uniform(random));
    }
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    std::vector<double> signal;
    for (const double value : x) {
      signal.push_back(value - mean);
    }
    CHECK(explain::correlation_ratio(x, signal) > 0.99);
  }
}
