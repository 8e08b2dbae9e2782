#include "tools/explain/report/verdict.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

Assessed<SimplexFamily> leaving(double times_noise) {
  Assessed<SimplexFamily> assessed;
  ChannelFit fit;
  fit.rows = 100.0;
  fit.mean_square = times_noise * times_noise;
  assessed.goodness.held_out = {fit};
  return assessed;
}

Trial tried(const Candidate& candidate) {
  Trial trial;
  trial.round = 1;
  trial.candidate = candidate;
  return trial;
}

std::string sentence_with(const std::vector<Candidate>& kept) {
  SearchResult<SimplexFamily> found;
  found.declared = leaving(8.0);
  found.calibrated = leaving(4.0);
  found.explained = leaving(1.0);
  for (const Candidate& candidate : kept) {
    found.kept.push_back({tried(candidate), {}});
  }
  return sentence_of("explained", found);
}

const Candidate kLeakage{0, 0, "leakage", "laminar", "flow"};
const Candidate kScale{0, 1, "sensor_scale", "engine", "sensor.engine"};

}  // namespace

TEST_GROUP(Verdict){};

TEST(Verdict, AFaultOfTheRecordIsNotSaidOfTheModel) {
  STRCMP_CONTAINS("The declared model lacks leakage (laminar) at flow: with it", sentence_with({kLeakage}).c_str());
  STRCMP_CONTAINS("The records are at fault: sensor scale (engine) at sensor.engine: with it",
                  sentence_with({kScale}).c_str());
  STRCMP_CONTAINS(
      "The declared model lacks leakage (laminar) at flow, and the records are at fault: sensor scale (engine) at "
      "sensor.engine: with them the error on held-out data falls from 8.0 to 1.00 times the noise",
      sentence_with({kScale, kLeakage}).c_str());
}

TEST(Verdict, AnInterruptedSearchNamesWhatPromisedMostByThen) {
  SearchResult<SimplexFamily> found;
  found.interrupted = true;
  found.declared = found.calibrated = found.explained = leaving(4.0);
  Trial screened = tried(kLeakage);
  screened.delta_criterion = -500.0;
  Trial fitted = tried({0, 0, "backlash", "", "load_spring"});
  fitted.refined = true;
  fitted.delta_criterion = -400.0;
  fitted.held_out_ratio = 0.25;
  found.trials = {screened};
  STRCMP_CONTAINS("4.0 times the noise off on held-out data; in screening leakage (laminar) at flow promised most",
                  sentence_of("undecided", found).c_str());
  found.trials = {screened, fitted};
  STRCMP_CONTAINS("of what was fitted by then backlash at load_spring leaves least, 25 % of that",
                  sentence_of("undecided", found).c_str());
  found.trials.clear();
  STRCMP_CONTAINS("off on held-out data.", sentence_of("undecided", found).c_str());
}

TEST(Verdict, TimesTheNoiseIsNotSaidWhereAFloorStandsForIt) {
  SearchResult<SimplexFamily> found;
  found.declared = leaving(8.0);
  found.calibrated = leaving(4.0);
  found.explained = leaving(1.0);
  found.kept.push_back({tried(kLeakage), {}});
  const std::string sentence = sentence_of("partly-explained", found, false);
  STRCMP_CONTAINS("falls to 12.5 % of what the declared model leaves", sentence.c_str());
  CHECK(sentence.find("times the noise") == std::string::npos);
}

TEST(Verdict, TermsOverTheTimeOfARecordAreTold) {
  CHECK_TRUE(is_of_record_time({0, 4, "unlisted_torque", "friction_along_time", "engine_torque"}));
  CHECK_TRUE(is_of_record_time({0, 0, "unlisted_drift", "piston", "sensor.piston"}));
  CHECK_FALSE(is_of_record_time({0, 0, "unlisted_torque", "friction_along_position", "engine_torque"}));
  CHECK_FALSE(is_of_record_time(kLeakage));
}
