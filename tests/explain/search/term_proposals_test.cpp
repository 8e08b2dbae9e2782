// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/term_proposals.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/terms/assessed.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;
using explain::Screened;
using model::Argument;
using model::Memory;
using model::Site;

using FlowTerm = model::Term<Site::flow>;
using OpeningTerm = model::Term<Site::valve>;
using TorqueTerm = model::Term<Site::engine_torque>;

int factor(Argument argument) { return 1 + static_cast<int>(argument); }

/// The declared model with a term, as `set` sets it.
template <class E, class F>
ModelFile with_term(F&& set) {
  ModelFile model = declared();
  add_effect<E>(std::get<SimplexParameters>(model.parameters), set);
  return model;
}

template <class E>
const auto& term_of(const explain::Fitted& fitted) {
  return std::get<typename E::template Params<double>>(std::get<SimplexParameters>(fitted.base).effects.values);
}

/// Proposals at every likely place, or, where `site` is named, at its place alone: the regression takes seconds a place.
std::vector<Screened> proposed_for(const ModelFile& truth, explain::Fitted around, const std::string& site = "") {
  const explain::Dataset data = data_of(truth);
  explain::Located located = explain::locate(data, around, 2);
  if (!site.empty()) {
    std::erase_if(located.places, [&](const explain::Place& place) { return !place.has(site); });
    CHECK(!located.places.empty() && located.places.front().is_likely);
  }
  std::vector<Screened> starts;
  for (const explain::ScoredForm& proposed : explain::propose_terms(data, around, located, 2, {})) {
    if (auto start = explain::start_of(around, proposed, explain::Scales{})) {
      starts.push_back(std::move(*start));
    }
  }
  return starts;
}

ModelFile with_product() {
  return with_term<FlowTerm>([](auto& term) {
    term.argument = static_cast<int>(Argument::rate);
    term.factor = factor(Argument::position);
    term.gain = 0.3;
  });
}

}  // namespace

TEST_GROUP(TermProposals){};

TEST(TermProposals, AProductOfTwoQuantitiesOfTheAxisIsFoundAsOne) {
  const auto proposals = proposed_for(with_product(), about_declared());
  const auto flow = std::ranges::find_if(proposals, [](const auto& p) { return p.candidate.name == FlowTerm::name; });
  CHECK(flow != proposals.end());
  const auto& term = term_of<FlowTerm>(flow->fitted);
  // What the valve lets through is what the piston takes but for the oil's compression.
  CHECK(term.argument == static_cast<int>(Argument::rate) || term.argument == static_cast<int>(Argument::flow));
  CHECK_EQUAL(factor(Argument::position), term.factor);
}

TEST(TermProposals, AMemoryIsFoundWithItsTime) {
  const auto proposals = proposed_for(with_term<TorqueTerm>([](auto& term) {
                                        term.option = static_cast<int>(Memory::lag);
                                        term.argument = static_cast<int>(Argument::command);
                                        term.gain = 4e5;
                                        term.time = 0.08;
                                      }),
                                      about_declared());
  CHECK(!proposals.empty());
  const Screened& best = proposals.front();
  STRCMP_EQUAL(std::string(TorqueTerm::name).c_str(), best.candidate.name.c_str());
  // A washout and the argument itself make a lag.
  const auto kind = static_cast<Memory>(term_of<TorqueTerm>(best.fitted).option);
  CHECK(kind == Memory::lag || kind == Memory::washout);
  CHECK_EQUAL(static_cast<int>(Argument::command), term_of<TorqueTerm>(best.fitted).argument);
  // A comb of factors of 2.6, refined by 1.25, 1.12 and 1.06 up or down: within half of the last step, or of the first where
  // the comb lies just between.
  DOUBLES_EQUAL(0.08, term_of<TorqueTerm>(best.fitted).time, 0.15 * 0.08);
}

// The pressure of the oil and the command of the valve vary fast. What a smoother makes of their product is mostly noise.
TEST(TermProposals, AMemoryOfAProductIsFoundWhereTheSmoothedSignalHidesIt) {
  const auto proposals = proposed_for(with_term<FlowTerm>([](auto& term) {
                                        term.option = static_cast<int>(Memory::washout);
                                        term.argument = static_cast<int>(Argument::load_pressure);
                                        term.factor = factor(Argument::valve_command);
                                        term.gain = 5e-11;
                                        term.time = 0.455;
                                      }),
                                      about_declared(), "flow");
  const auto right = std::ranges::find_if(proposals, [](const auto& proposal) {
    const auto& term = term_of<FlowTerm>(proposal.fitted);
    const auto kind = static_cast<Memory>(term.option);
    return proposal.candidate.name == FlowTerm::name && (kind == Memory::lag || kind == Memory::washout) &&
           std::pair(term.argument, term.factor) ==
               std::pair(static_cast<int>(Argument::load_pressure), factor(Argument::valve_command));
  });
  CHECK(right != proposals.end());
  DOUBLES_EQUAL(0.455, term_of<FlowTerm>(right->fitted).time, 0.3 * 0.455);
}

namespace {

/// The best proposal at the oil for records of an axis that carries a load and has a term that the declared one does not.
template <class E>
std::string best_under_load(double gain) {
  ModelFile loaded = declared();
  add_effect<model::TorqueOffset>(std::get<SimplexParameters>(loaded.parameters), [](auto& offset) { offset.torque = 4e4; });
  ModelFile truth = loaded;
  add_effect<E>(std::get<SimplexParameters>(truth.parameters), [&](auto& term) {
    term.argument = static_cast<int>(Argument::position);
    term.option = static_cast<int>(Memory::saturation);
    term.width = 1e-3;
    term.gain = gain;
  });
  explain::Fitted around = about_declared();
  around.base = loaded.parameters;
  const auto proposed = proposed_for(truth, around, "flow");
  CHECK(!proposed.empty());
  return proposed.front().candidate.name;
}

}  // namespace

// The load takes a sixth of the supply pressure: what is added to the opening gives a sixth less flow against it than along.
TEST(TermProposals, ALawOfTheOpeningIsSeparatedFromOneOfTheFlow) {
  const double rated = SimplexParameters{}.servovalve.rated_flow;
  STRCMP_EQUAL(std::string(OpeningTerm::name).c_str(), best_under_load<OpeningTerm>(15.0).c_str());
  STRCMP_EQUAL(std::string(FlowTerm::name).c_str(), best_under_load<FlowTerm>(15.0 * rated).c_str());
}

TEST(TermProposals, NothingIsProposedWhereNothingIsMissing) { CHECK(proposed_for(declared(), about_declared()).empty()); }

TEST(TermProposals, ASiteThatHasATermGetsNoSecondOne) {
  auto around = about_declared();
  explain::visit_effects(around.base, [&]<class E>(std::size_t index, auto&) {
    if constexpr (std::is_same_v<E, FlowTerm>) {
      explain::set_active(around.base, index, true);
    }
  });
  for (const auto& proposal : proposed_for(with_product(), around, "flow")) {
    CHECK(proposal.candidate.name != FlowTerm::name);
  }
}

namespace {

/// A gain of the piston's rate at the valve's flow, as a regression gives it.
explain::ScoredForm gain_of_rate(double gain) {
  explain::ScoredForm proposed;
  proposed.form.site = Site::flow;
  proposed.form.argument = Argument::rate;
  proposed.score.coefficients = Eigen::VectorXd::Constant(1, gain);
  proposed.score.move = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(about_declared().free.size()));
  return proposed;
}

/// The start of a proposed gain for records of an axis that has `truth`.
std::optional<Screened> start_for(double truth, double proposed) {
  const explain::Dataset data = data_of(with_term<FlowTerm>([&](auto& term) {
    term.argument = static_cast<int>(Argument::rate);
    term.gain = truth;
  }));
  const explain::Evaluator evaluator(data, explain::Resolution::coarse);
  const explain::Fitted around = about_declared();
  return explain::best_start(evaluator, around, gain_of_rate(proposed), explain::Scales{},
                             explain::left_by(evaluator, around, 2), 2);
}

}  // namespace

TEST(TermProposals, ATermProposedTooLargeStartsWithTheShareThatLeavesLeast) {
  const double truth = -0.1 * SimplexParameters{}.actuator.piston_area;
  const auto start = start_for(truth, 8.0 * truth);
  CHECK(start.has_value());
  // The shares are an eighth, twice that and half of it.
  DOUBLES_EQUAL(truth, term_of<FlowTerm>(start->fitted).gain, 0.1 * std::abs(truth));
}

TEST(TermProposals, ATermOfTheWrongSignHasNoStart) {
  const double truth = -0.1 * SimplexParameters{}.actuator.piston_area;
  CHECK_FALSE(start_for(truth, -truth).has_value());
}

TEST(TermProposals, TheUnitsOfATermAreThoseOfTheWholeHoweverLittleOfItAFitStartsWith) {
  const explain::Fitted around = about_declared();
  const auto whole = explain::start_of(around, gain_of_rate(0.01), explain::Scales{});
  const auto part = explain::start_of(around, gain_of_rate(0.01), explain::Scales{}, 0.06);
  DOUBLES_EQUAL(0.06 * 0.01, term_of<FlowTerm>(part->fitted).gain, 1e-12);
  const auto size = std::ssize(around.free);
  CHECK_EQUAL(whole->fitted.free[static_cast<std::size_t>(size)].unit_size,
              part->fitted.free[static_cast<std::size_t>(size)].unit_size);
  DOUBLES_EQUAL(0.06 * whole->fitted.u.back(), part->fitted.u.back(), 1e-12);
}

namespace {

/// A valve command that is held for seven rows, inside the loop, and a search that proposes four.
struct HeldValveCommand {
  using Term = model::Term<Site::valve_command>;
  static constexpr double kRow = 2e-3;
  static constexpr double kTurn = 2.0 * std::numbers::pi;

  /// A start with the samples of every `rows` rows, of which `passed` have passed at the start, and a gain.
  Screened start(double rows, double passed, double gain, bool replaces) const {
    explain::ScoredForm form;
    form.form.site = Site::valve_command;
    form.form.argument = Argument::valve_command;
    form.form.memory.kind = Memory::hold;
    form.form.memory.time = rows * kRow;
    form.form.memory.phase = passed / rows * kTurn;
    form.form.replaces = replaces;
    form.score.coefficients = Eigen::Vector2d(gain, -gain);
    form.score.move = Eigen::VectorXd::Zero(std::ssize(around.free));
    return explain::start_of(around, form, scales).value();
  }

  /// The declared parameters compensate for a part of the gain: short fits leave up to a tenth of it to them.
  static void check_is_true_one(const Screened& held) {
    constexpr double kTolerance = 0.12;
    const auto parameters = held.fitted.parameters();
    const auto& term = std::get<Term::Params<double>>(std::get<SimplexParameters>(parameters).effects.values);
    DOUBLES_EQUAL(7.0 * kRow, term.time, 1e-9);
    // Samples are taken at a step: those of one row are the same ones.
    DOUBLES_EQUAL(1.0, 7.0 * term.phase / kTurn, 0.1);
    DOUBLES_EQUAL(1.0, term.gain, kTolerance);
    DOUBLES_EQUAL(-1.0, term.direct, kTolerance);
  }

  const explain::Dataset data = data_of(with_term<Term>([](auto& term) {
    term.option = static_cast<int>(Memory::hold);
    term.argument = static_cast<int>(Argument::valve_command);
    term.time = 7.0 * kRow;
    term.phase = 1.02 / 7.0 * kTurn;
    term.gain = 1.0;
    term.direct = -1.0;
  }));
  const explain::Fitted around = about_declared();
  const explain::Evaluator evaluator{data, explain::Resolution::coarse};
  const explain::Scales scales;
  const explain::Watch watch;
  const explain::Refiner refiner{data, evaluator, evaluator, evaluator, scales, 2, watch};
};

}  // namespace

// From another period a fit of the coefficients alone ends at half of the hold and more delay.
TEST(TermProposals, AHeldSignalInsideTheLoopIsFittedWithItsPeriodAndTheInstantOfItsSamples) {
  const HeldValveCommand search;
  const Screened proposed = search.start(4.0, 0.92, 0.5, false);
  const Screened held = search.refiner.with_samples(
      search.evaluator, search.refiner.over_periods(search.evaluator, proposed), search.around.u);
  HeldValveCommand::check_is_true_one(held);

  // Another proposal takes these samples, and this one keeps them.
  const auto of = [&](const Screened& other, const Screened& own) {
    return search.refiner.with_samples_of(search.evaluator, other, own, search.around.u);
  };
  HeldValveCommand::check_is_true_one(of(held, proposed));
  HeldValveCommand::check_is_true_one(of(proposed, held));
}

// Three rows from its samples, half of a period of seven: no instant nearby is right.
TEST(TermProposals, TheSamplesOfASignalThatIsReplacedAreFoundFromAnyInstant) {
  const HeldValveCommand search;
  const Screened start = search.start(9.0, 5.5, 1.0, true);
  CHECK(start.replaces);
  const auto periods = search.refiner.over_periods(search.evaluator, start);
  const auto& best = term_of<HeldValveCommand::Term>(periods.front().proposed.fitted);
  DOUBLES_EQUAL(7.0 * HeldValveCommand::kRow, best.time, 1e-9);
  DOUBLES_EQUAL(1.0, 7.0 * best.phase / HeldValveCommand::kTurn, 0.1);
  // The true law at its own samples leaves noise alone, each other period more.
  CHECK(periods.front().least < 1.1);
  CHECK(periods[1].least > 1.5);
  CHECK(search.refiner.over_periods(search.evaluator, search.start(9.0, 5.5, 1.0, false)).front().least >
        periods.front().least);
}

TEST(TermProposals, ATermWithoutItsMemoryIsAGainThatDoesWhatBothDid) {
  Screened start;
  const auto with_play = [&](double direct) {
    explain::Fitted fitted = about_declared();
    start.candidate.effect = add_effect<FlowTerm>(std::get<SimplexParameters>(fitted.base), [&](auto& term) {
      term.option = static_cast<int>(Memory::play);
      term.argument = static_cast<int>(Argument::rate);
      term.factor = factor(Argument::position);
      term.gain = 0.1;
      term.direct = direct;
      term.width = 1e-6;
    });
    return fitted;
  };
  start.candidate.option = static_cast<int>(Memory::play);
  start.candidate.choices = {static_cast<int>(Argument::rate), factor(Argument::position), 0};
  const explain::Fitted both = with_play(0.3);
  const auto plain = explain::without_memory(both, start.candidate, explain::Scales{});
  CHECK(plain.has_value());
  STRCMP_EQUAL("gain of rate x position", plain->candidate.option_name.c_str());
  explain::Fitted fitted = plain->fitted;
  fitted.base = fitted.parameters();
  const auto& term = term_of<FlowTerm>(fitted);
  LONGS_EQUAL(static_cast<int>(Memory::none), term.option);
  DOUBLES_EQUAL(0.4, term.gain, 1e-12);
  DOUBLES_EQUAL(0.0, term.direct, 0.0);
  LONGS_EQUAL(both.free.size() + 1, fitted.free.size());
  CHECK(!explain::without_memory(with_play(0.0), start.candidate, explain::Scales{}));
}
