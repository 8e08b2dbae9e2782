// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <fstream>
#include <memory>

#include "tests/explain/words/sentence_check.hpp"
#include "tools/explain/experiment/test_profiles.hpp"
#include "tools/explain/latent/form.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/result/trace.hpp"
#include "tools/explain/result/verdict.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/terms/unlisted_words.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/reasons.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/explain/words/warnings.hpp"

// Every sentence that `hotfire explain` can print about a result, with usual names and numbers in it. The sentences are in
// sentences.txt of the build folder, for a person to read.

namespace {

using namespace hotfire::explain;
namespace model = hotfire::model;

/// Records of an axis that is one of two, with every channel: every candidate may be tried on them.
Dataset every_channel() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, true, true};
  Experiment experiment;
  experiment.other.angle = {0.0};
  experiment.other.rate = {0.0};
  data.experiments.push_back(experiment);
  return data;
}

/// Terms of the grammar at one site: every memory of every quantity, alone and times another.
std::vector<Candidate> terms_of_grammar() {
  std::vector<Candidate> terms;
  for (int memory = 0; memory < static_cast<int>(model::kMemoryNames.size()); ++memory) {
    for (int argument = 0; argument < static_cast<int>(model::kArgumentNames.size()); ++argument) {
      for (const int factor : {0, 6}) {
        terms.push_back({0,
                         memory,
                         "term_torque",
                         std::string(model::kMemoryNames[static_cast<std::size_t>(memory)]),
                         "engine_torque",
                         {argument, factor, 0}});
      }
    }
  }
  return terms;
}

Trial tried(const Candidate& candidate, const char* decision = "kept") {
  Trial trial;
  trial.round = 1;
  trial.candidate = candidate;
  trial.refined = true;
  trial.delta_criterion = -1234.0;
  trial.held_out_ratio = 0.123;
  trial.decision = decision;
  return trial;
}

const ModelParameters kAxis = hotfire::SimplexParameters();
const ModelParameters kMass = hotfire::DirectParameters();

SearchResult result_with(const ModelParameters& plant, const std::vector<Candidate>& kept) {
  ChannelFit fit;
  fit.rows = 100.0;
  SearchResult found;
  found.explained.model.base = plant;
  fit.mean_square = 64.0;
  found.declared.goodness.held_out = {fit};
  fit.mean_square = 16.0;
  found.calibrated.goodness.held_out = {fit};
  fit.mean_square = 1.0;
  found.explained.goodness.held_out = {fit};
  for (const Candidate& candidate : kept) {
    // The same at another site, which the records do not separate from it.
    Trial tied = tried(candidate, "tied");
    tied.candidate.site = "valve_command";
    found.kept.push_back({tried(candidate), {tied}});
  }
  return found;
}

class EverySentence {
 public:
  explicit EverySentence(SentenceCheck& check) : check_(check) {}

  void of_listed_effects() {
    for (const Candidate& candidate : all_candidates(kAxis, every_channel())) {
      of_verdicts(kAxis, {candidate});
      // The longest that a model of three effects can have.
      of_verdicts(kAxis, {candidate, candidate, {0, 0, "sensor_nonlinearity", "load_pressure", "sensor.load_pressure"}});
    }
    for (const Candidate& candidate : all_candidates(kMass, every_channel())) {
      of_verdicts(kMass, {candidate});
    }
  }

  void of_unlisted_terms() {
    std::vector<Candidate> terms = unlisted_candidates(kAxis, every_channel());
    for (const Candidate& term : terms_of_grammar()) {
      terms.push_back(with_index_of_a_term(term));
    }
    for (const Candidate& term : terms) {
      of_unlisted(kAxis, term);
    }
    for (const Candidate& term : unlisted_candidates(kMass, every_channel())) {
      of_unlisted(kMass, term);
    }
    of_tables();
    of_forms();
  }

  void of_places() {
    SearchResult found = result_with(kAxis, {});
    for (const bool is_single : {true, false}) {
      found.located.is_single = is_single;
      found.located.places.clear();
      for (const char* site :
           {"command", "valve_command", "flow", "piston", "load_spring", "engine_torque", "sensor.engine"}) {
        Place place;
        place.sites = {site};
        place.is_likely = true;
        found.located.places.push_back(place);
        check_.add(sentence_of(Verdict::unlisted_effect, found, true));
      }
    }
  }

  void of_verdicts_without_effects() {
    for (const bool noise_is_known : {true, false}) {
      SearchResult found = result_with(kAxis, {});
      for (const Verdict verdict : {Verdict::nothing_missing, Verdict::unlisted_effect, Verdict::undecided}) {
        check_.add(sentence_of(verdict, found, noise_is_known));
      }
      found.searched = false;
      check_.add(sentence_of(Verdict::undecided, found, noise_is_known));
      found.searched = true;
      for (const bool refined : {true, false}) {
        Trial trial = tried({0, 0, "gimbal_friction", "lugre", "engine_torque"});
        trial.refined = refined;
        found.trials = {trial};
        check_.add(sentence_of(Verdict::undecided, found, noise_is_known));
      }
    }
    check_.add(words::wrong_declaration(1.02, "servovalve.position_gain", 4.3));
    check_.add(words::black_box_is_better());
    check_.add(words::of_axis("pitch", words::nothing_missing(1.01)));
  }

  void of_reasons() {
    for (std::size_t i = 0; i < words::kReasons; ++i) {
      const std::string text(words::text(static_cast<words::Reason>(i)));
      check_.add(std::string(",:;").find(text.front()) != std::string::npos ? words::leaves(0.123) + text : text);
    }
    const std::string label = "gimbal_friction (lugre)";
    for (std::size_t i = 0; i < words::kLawChanges; ++i) {
      check_.add(words::text(static_cast<words::LawChange>(i), label));
    }
    check_.add(words::leaves_far_above_noise(0.6));
    check_.add(words::leaves_noise(0.998));
    check_.add(words::leaves(0.123) + words::replaces_listed(0.5));
    check_.add(words::explained_by_signal("load_spring or structure"));
    check_.add(words::imitates(label) + ". " + words::has_a_law(label) + ". " + words::is_revised(label, label));
    for (const std::string& harm :
         {words::worse_record("sweep_low.csv", 0.3, "load_pressure"), words::worse_band("load_pressure", 0.4, 2.0, 2.83)}) {
      check_.add(words::refused(harm));
      check_.add(words::lowers(0.3, 1234.0) + "; " + words::refused(harm));
      check_.add(words::leaves(0.3) + "; " + words::refused(harm));
    }
    of_trials();
  }

  void of_warnings() {
    using namespace words;
    for (const std::string& text :
         {ended_early(), drifts("unlisted_torque", "engine_torque", true), drifts("term_flow", "flow", false),
          fault_of_record("sensor_scale", "load_pressure"), left_out("servovalve.position_gain"), no_tolerance(),
          moved_far("engine.inertia", 3.4), at_a_bound("effects.gimbal_friction.coulomb_torque"),
          undetermined("effects.leakage.laminar"), not_supported("gimbal_friction (coulomb)"),
          noise_differs("load_pressure", 1e4, 2.5e4), unused_channel("sweep.csv", "supply", every_channel().channels),
          unused_channel("sweep.csv", "supply", {"position"}), not_at_rest("sweep.csv", 0.35),
          excluded("sweep.csv", 3.0, 3.5), input_held("sweep.csv"), common_bias(0.012)}) {
      check_.add(text);
      check_.add("pitch: " + text);
    }
  }

  void of_comparisons() {
    using namespace words;
    for (const bool is_better : {true, false}) {
      check_.add(baseline(is_better) + " " + baseline_channel("load_pressure", 4, 0.012, 0.00123, 0.00234) + " " +
                 baseline_difference(2.0, 2.83, 0.001, 0.002));
    }
    check_.add(explain_equally("gimbal_friction (lugre)", "unlisted_torque (friction_along_position)"));
    for (const std::string& limits : {limits_of_rig(), limits_of_records()}) {
      check_.add(no_profile(limits));
      for (const TestProfile& profile : test_profiles({-0.01, 0.1, 1.0}, 20.0)) {
        check_.add(separating_profile(profile.words, 1.23, limits));
        check_.add(weak_profile(profile.words, 0.012, limits));
      }
    }
    for (std::size_t i = 0; i < kCombinations; ++i) {
      check_.add(combination_identified(name_of(static_cast<Combination>(i)), 0.012,
                                        {factor("actuator.bulk_modulus", 0.12), factor("actuator.piston_area", 0.23),
                                         factor("actuator.moment_arm", 0.012), factor("engine.inertia", 0.34)}));
    }
    const std::vector<std::string> others{moves_along("servovalve.rated_flow", 0.8), moves_along("actuator.area", -1.2),
                                          moves_along("engine.inertia", 0.4)};
    for (std::size_t count = 1; count <= others.size(); ++count) {
      check_.add(hardly_separated("structure.stiffness", {others.begin(), others.begin() + static_cast<long>(count)}, 0.12));
    }
    check_.add(not_determined({"structure.stiffness", "engine.inertia", "servovalve.time_constant"}));
    for (const char* equation : {"engine", "flow", "mass"}) {
      for (const double share : {0.01, 0.9}) {
        Trace trace;
        trace.equation = equation;
        trace.missing = {"torque against the motion", "N.m", {1.0, -1.0}};
        trace.depends_on = {"angle about the other axis", "rad", {1.0, -1.0}};
        trace.signal_to_noise = 12.0;
        trace.share = share;
        check_.add(in_words(trace));
      }
    }
  }

  void of_refusals() {
    using namespace words;
    const std::string record = "records/sweep.csv";
    check_.add(turned_mass(record, 0.00123, 0.0234));
    for (const char* culprit : {"it", "the command"}) {
      check_.add(inverted_channel(record, "channel load_pressure", -0.98, culprit));
      for (const char* hint : {"", " (millimetres taken for metres?)"}) {
        check_.add(mis_scaled_channel(record, "channel load_pressure", 57.3, 0.998, culprit, hint));
      }
    }
    for (const std::string& text :
         {diverges_held_out(record), diverges_declared("taos.toml"), malformed_exclusion("sweep"),
          unknown_record("sweep.csv", {"a.csv", "b.csv"}), no_such_rows("sweep.csv", 30.0, 35.0, 0.0, 20.0),
          nothing_to_fit("sweep.csv"), missing_value("sweep.csv", "load_pressure", 3.25), missing_start(record, "command"),
          drives_the_model(), drives_axes({"pitch", "yaw"}), nothing_to_explain(), axis_not_measured(record, "pitch")}) {
      check_.add(text);
    }
    for (std::size_t i = 0; i < kUnsupported; ++i) {
      check_.add(unsupported("taos.toml", static_cast<Unsupported>(i)));
    }
  }

 private:
  /// `is_unlisted` asks for the place in the list of effects.
  static Candidate with_index_of_a_term(Candidate term) {
    const hotfire::SimplexParameters neutral;
    model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
      if (E::name == term.name) {
        term.effect = index;
      }
    });
    return term;
  }

  void of_verdicts(const ModelParameters& plant, const std::vector<Candidate>& kept) {
    const SearchResult found = result_with(plant, kept);
    for (const bool noise_is_known : {true, false}) {
      check_.add(sentence_of(Verdict::explained, found, noise_is_known));
      check_.add(sentence_of(Verdict::partly_explained, found, noise_is_known));
    }
  }

  void of_unlisted(const ModelParameters& plant, const Candidate& term) {
    CHECK_TRUE(is_unlisted(plant, term));
    const Candidate listed{0, 0, "gimbal_friction", "lugre", "engine_torque"};
    SearchResult found = result_with(plant, {term});
    for (const bool noise_is_known : {true, false}) {
      check_.add(sentence_of(Verdict::unlisted_effect, found, noise_is_known));
    }
    check_.add(what_it_is_not(found));
    Trial other = tried(term, "dropped");
    other.candidate.option_name += "2";
    found.trials = {tried(listed, "dropped"), other};
    check_.add(what_it_is_not(found));
    found.kept.push_back({tried(listed), {}});
    check_.add(sentence_of(Verdict::unlisted_effect, found, true));
    if (const std::string law = law_in_words(term); !law.empty()) {
      check_.add(law + width_in_words(plant, term));
    }
    check_.add(in_words(with_own_axes({"at", "", "added", "m", "torque", {-1.0, 0.0, 1.0}, {-1.0, 0.2, 1.0}}, term)));
  }

  /// Tables that are constant, odd with a jump, even, rising, falling, and none of it.
  void of_tables() {
    const std::vector<std::vector<double>> curves{{1.0, 1.01, 1.0, 0.99, 1.0},    {-1.0, -0.9, 0.0, 0.9, 1.0},
                                                  {1.0, 0.25, 0.0, 0.25, 1.0},    {-1.0, -0.5, 0.0, 0.5, 1.0},
                                                  {1.0, 0.5, 0.0, -0.5, -1.0},    {0.3, -0.4, 0.1, 0.8, -0.2},
                                                  {-1.0, -0.999, 0.0, 0.999, 1.0}};
    for (const std::vector<double>& y : curves) {
      check_.add(in_words(
          {"engine rate", "rad/s", "torque", "N.m", "torque against the motion", {-0.1, -0.01, 0.0, 0.01, 0.1}, y}));
    }
  }

  void of_forms() {
    for (std::size_t memory = 0; memory < model::kMemoryNames.size(); ++memory) {
      for (const bool has_points : {false, true}) {
        for (const bool curve_first : {false, true}) {
          Form form;
          form.argument = model::Argument::load_pressure;
          form.factor = model::Argument::rate;
          form.memory.kind = static_cast<model::Memory>(memory);
          form.curve_first = curve_first;
          if (has_points) {
            form.points = {-1.0, 0.0, 1.0};
          }
          check_.add(in_words(form));
        }
      }
    }
  }

  /// Every answer of `reason_of`.
  void of_trials() {
    const Trial best = tried({0, 0, "gimbal_friction", "lugre", "engine_torque"});
    for (const char* decision : {"kept", "tied", "dropped"}) {
      for (const double criterion : {-1230.0, -1.0, 100.0}) {
        for (const bool refined : {true, false}) {
          for (const bool screened : {true, false}) {
            Trial trial = tried({0, 0, "backlash", "", "load_spring"}, decision);
            trial.delta_criterion = criterion;
            trial.refined = refined;
            trial.screened = screened;
            check_.add(reason_of(trial, &best));
            check_.add(reason_of(trial, &trial));
          }
        }
      }
    }
  }

  SentenceCheck& check_;
};

}  // namespace

TEST_GROUP(Sentences) { const SentenceCheck check{HOTFIRE_SOURCE_DIR}; };

TEST(Sentences, EverySentenceOfTheReportIsShortFilledAndInStandardTerms) {
  SentenceCheck every(HOTFIRE_SOURCE_DIR);
  EverySentence sentences(every);
  sentences.of_listed_effects();
  sentences.of_unlisted_terms();
  sentences.of_places();
  sentences.of_verdicts_without_effects();
  sentences.of_reasons();
  sentences.of_warnings();
  sentences.of_comparisons();
  sentences.of_refusals();
  for (const PolicyConstant& constant : kPolicyConstants) {
    every.add(std::string(constant.reason));
  }
  std::ofstream file(HOTFIRE_SENTENCES);
  for (const std::string& text : every.texts()) {
    file << text << "\n";
  }
  STRCMP_EQUAL("", every.faults().c_str());
  // The laws of the effects alone make hundreds: fewer would mean that a list was not run over.
  CHECK_TRUE(every.texts().size() > 500);
}

TEST(Sentences, TheCheckFindsEachKindOfFault) {
  CHECK_TRUE(check.replaced_words() > 15);
  STRCMP_EQUAL("", check.fault_of("The engine equation leaves 2.5 N.m rms. It is 12 times the noise.").c_str());
  std::string long_sentence = "The";
  for (int i = 0; i < 24; ++i) {
    long_sentence += " word";
  }
  STRCMP_EQUAL("", check.fault_of(long_sentence + ". The next sentence is short.").c_str());
  STRCMP_EQUAL("26 words", check.fault_of("Short. " + long_sentence + " more").c_str());
  STRCMP_CONTAINS("placeholder", check.fault_of("The error is {:.2f}.").c_str());
  STRCMP_CONTAINS("blank", check.fault_of("The  error").c_str());
  STRCMP_CONTAINS("blank", check.fault_of("The error ").c_str());
  STRCMP_CONTAINS("'lacks'", check.fault_of("The declared model lacks friction").c_str());
  STRCMP_CONTAINS("'goes no faster'", check.fault_of("A spool that goes no faster than so").c_str());
  STRCMP_CONTAINS("begins with 'hardly '", check.fault_of("It is. Hardly separated: a and b.").c_str());
  STRCMP_CONTAINS("begins with 'only '", check.fault_of("only before that did it explain as much").c_str());
}

TEST(Sentences, NoSentenceIsBuiltWhereThisTestDoesNotSeeIt) {
  std::string elsewhere;
  for (const std::string& text : sentences_elsewhere(HOTFIRE_SOURCE_DIR)) {
    elsewhere += text + "\n";
  }
  STRCMP_EQUAL("", elsewhere.c_str());
}
