// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/axes_result.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

/// One axis that explains its piston and leaves a term at `site` out, if it has one.
AxisResult axis_result(const char* axis, Verdict verdict, const char* site) {
  AxisResult own{axis, {}};
  Result& result = own.result;
  result.verdict = verdict;
  result.sentence = "Something.";
  result.warnings = {"of both", std::string("of ") + axis};
  ChannelErrors channel;
  channel.name = "piston";
  result.channels = {channel};
  result.records = {{"steps.csv", 10, 0.002, {{"piston", 1e-5, 2e-5}}}};
  CalibratedParameter parameter;
  parameter.key = "engine.inertia";
  result.calibration = {parameter};
  result.search = {{}};
  if (site != nullptr) {
    LocatedPlace place;
    place.sites = {site};
    place.log_likelihood_gain = verdict == Verdict::undecided ? 20.0 : 10.0;
    result.located = LocatedResult{{site}, true, {place}};
  }
  return own;
}

}  // namespace

TEST_GROUP(TwoAxesResult){};

TEST(TwoAxesResult, the_verdict_is_that_of_the_axis_that_is_explained_worse) {
  const Result joined = joined_result(
      {axis_result("pitch", Verdict::explained, nullptr), axis_result("yaw", Verdict::partly_explained, nullptr)});
  CHECK_TRUE(joined.verdict == Verdict::partly_explained);
  STRCMP_CONTAINS("pitch axis: ", joined.sentence.c_str());
  STRCMP_CONTAINS("yaw axis: ", joined.sentence.c_str());
}

TEST(TwoAxesResult, every_channel_parameter_and_row_has_its_axis) {
  const Result joined =
      joined_result({axis_result("pitch", Verdict::explained, nullptr), axis_result("yaw", Verdict::explained, nullptr)});
  STRCMP_EQUAL("piston.pitch", joined.channels.at(0).name.c_str());
  STRCMP_EQUAL("piston.yaw", joined.channels.at(1).name.c_str());
  LONGS_EQUAL(1, joined.records.size());
  STRCMP_EQUAL("piston.yaw", joined.records.at(0).channels.at(1).name.c_str());
  STRCMP_EQUAL("engine.pitch.inertia", joined.calibration.at(0).key.c_str());
  STRCMP_EQUAL("engine.yaw.inertia", joined.calibration.at(1).key.c_str());
  STRCMP_EQUAL("yaw", joined.search.at(1).axis.c_str());
}

TEST(TwoAxesResult, a_text_of_both_axes_is_given_once_and_one_of_one_axis_with_its_name) {
  const Result joined =
      joined_result({axis_result("pitch", Verdict::explained, nullptr), axis_result("yaw", Verdict::explained, nullptr)});
  CHECK_TRUE(joined.warnings == (std::vector<std::string>{"of both", "pitch: of pitch", "yaw: of yaw"}));
}

TEST(TwoAxesResult, places_of_both_axes_are_given_the_best_first_and_then_no_single_one_explains_all) {
  const AxisResult pitch = axis_result("pitch", Verdict::unlisted_effect, "flow");
  const AxisResult yaw = axis_result("yaw", Verdict::undecided, "valve");
  const Result both = joined_result({pitch, yaw});
  CHECK_TRUE(both.located->sites == (std::vector<std::string>{"flow.pitch", "valve.yaw"}));
  CHECK_FALSE(both.located->is_single);
  STRCMP_EQUAL("valve.yaw", both.located->places.at(0).sites.at(0).c_str());
  const Result one = joined_result({pitch, axis_result("yaw", Verdict::explained, nullptr)});
  CHECK_TRUE(one.located->sites == (std::vector<std::string>{"flow.pitch"}));
  CHECK_TRUE(one.located->is_single);
  CHECK_FALSE(joined_result({axis_result("pitch", Verdict::explained, nullptr)}).located.has_value());
}
