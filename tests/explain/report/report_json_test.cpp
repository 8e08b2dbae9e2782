// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/report_json.hpp"

#include <set>
#include <string>

#include "tools/explain/policy/policy.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;
using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) {
    keys.insert(key);
  }
  return keys;
}

void expect_keys(const std::set<std::string>& wanted, const json& object) { CHECK_TRUE(wanted == keys_of(object)); }

const std::set<std::string> kAlways{"schema",  "model",           "name",     "verdict",     "sentence",
                                    "records", "held_out",        "warnings", "channels",    "effects",
                                    "search",  "identifiability", "residual", "calibration", "policy"};

}  // namespace

TEST_GROUP(ReportJson){};

TEST(ReportJson, a_result_without_anything_has_the_keys_that_are_always_there_and_no_other) {
  const json report = report_json({});
  expect_keys(kAlways, report);
  expect_keys({"white", "unexplained_percent", "autocorrelation", "input_correlation", "by_frequency", "by_amplitude"},
              report["residual"]);
  for (const char* list : {"records", "held_out", "warnings", "effects", "search", "identifiability"}) {
    CHECK_TRUE(report[list].is_array() && report[list].empty());
  }
  for (const char* table : {"channels", "calibration"}) {
    CHECK_TRUE(report[table].is_object() && report[table].empty());
  }
}

TEST(ReportJson, what_is_optional_has_its_key_where_it_is_there) {
  Result result;
  result.held_out_records = {{"kept.csv", 10, 0.002, {}}};
  result.located = LocatedResult{{"flow"}, true, {}};
  result.trace = TraceResult{};
  result.baseline = Baseline{};
  result.valve_bias = 0.25;
  std::set<std::string> wanted = kAlways;
  wanted.insert({"held_out_records", "located", "trace", "baseline", "valve_bias"});
  expect_keys(wanted, report_json(result));
}

TEST(ReportJson, every_constant_of_the_policy_is_there_with_the_value_that_decided) {
  Policy other;
  other.clearly_less = 0.25;
  const WithPolicy with(other);
  const json policy = report_json({})["policy"];
  CHECK_EQUAL(kPolicyConstants.size(), policy.size());
  for (std::size_t i = 0; i < kPolicyConstants.size(); ++i) {
    expect_keys({"name", "value", "unit", "reason"}, policy[i]);
    DOUBLES_EQUAL(other.*kPolicyConstants[i].value, policy[i]["value"].get<double>(), 0.0);
    CHECK_TRUE(!policy[i]["reason"].get<std::string>().empty());
  }
}

TEST(ReportJson, a_channel_has_its_three_models_its_noise_source_and_its_black_box_where_they_are_known) {
  ChannelErrors channel;
  channel.name = "piston";
  channel.unit = "m";
  channel.noise = 1e-5;
  channel.declared.rms = 3.0;
  channel.calibrated.rms = 2.0;
  channel.explained.rms = 1.0;
  Result result;
  result.held_out_records = {{"kept.csv", 10, 0.002, {channel}}};
  result.held_out_records[0].channels[0].black_box = channel.calibrated;
  channel.noise_source = NoiseSource::floor;
  result.channels = {channel};
  const json report = report_json(result);
  const json& own = report["channels"]["piston"];
  expect_keys({"unit", "noise", "noise_source", "before", "calibrated", "after"}, own);
  STRCMP_EQUAL("floor", own["noise_source"].get<std::string>().c_str());
  DOUBLES_EQUAL(3.0, own["before"]["rms"].get<double>(), 0.0);
  DOUBLES_EQUAL(2.0, own["calibrated"]["rms"].get<double>(), 0.0);
  DOUBLES_EQUAL(1.0, own["after"]["rms"].get<double>(), 0.0);
  expect_keys({"unit", "noise", "before", "calibrated", "after", "black_box"},
              report["held_out_records"][0]["channels"]["piston"]);
}

TEST(ReportJson, a_parameter_that_is_not_identified_has_no_interval_and_no_source_of_one) {
  FoundEffect effect;
  effect.name = effect.key = "leakage";
  effect.parameters = {{"known", "1", "a gain", 2.0, Interval95{1.0, 3.0}, true}, {"open", "1", "a gain", 2.0, {}, false}};
  Result result;
  result.effects = {effect};
  const json parameters = report_json(result)["effects"][0]["parameters"];
  CHECK_TRUE(parameters["known"]["ci95"] == json({1.0, 3.0}));
  STRCMP_EQUAL("profile", parameters["known"]["interval_from"].get<std::string>().c_str());
  CHECK_TRUE(parameters["open"]["ci95"].is_null() && parameters["open"]["interval_from"].is_null());
  CHECK_TRUE(parameters["known"]["identified"].get<bool>() && !parameters["open"]["identified"].get<bool>());
}

TEST(ReportJson, only_a_term_of_unknown_law_has_sites_and_words_and_only_two_axes_have_an_axis) {
  FoundEffect listed;
  listed.name = listed.key = "leakage";
  FoundEffect unlisted = listed;
  unlisted.sites = {"flow", "valve"};
  unlisted.axis = "yaw";
  unlisted.law = "curve";
  Result result;
  result.effects = {listed, unlisted};
  const json effects = report_json(result)["effects"];
  expect_keys({"name", "site", "parameters", "evidence", "alternatives"}, effects[0]);
  expect_keys(
      {"name", "site", "parameters", "evidence", "alternatives", "axis", "law", "key", "sites", "looks_like", "is_not"},
      effects[1]);
}

TEST(ReportJson, the_verdicts_have_the_names_of_the_contract) {
  const std::pair<Verdict, const char*> names[] = {{Verdict::undecided, "undecided"},
                                                   {Verdict::unlisted_effect, "unlisted-effect"},
                                                   {Verdict::partly_explained, "partly-explained"},
                                                   {Verdict::explained, "explained"},
                                                   {Verdict::nothing_missing, "nothing-missing"}};
  for (const auto& [verdict, name] : names) {
    Result result;
    result.verdict = verdict;
    STRCMP_EQUAL(name, report_json(result)["verdict"].get<std::string>().c_str());
  }
}
