// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/find_period.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

// As `hotfire-rt timing --period-us` takes them [us].
constexpr int kShortest = 50;
constexpr int kLongest = 10'000;
constexpr double kResolution = 1.05;
constexpr int kTiming = static_cast<int>(ExitStatus::timing);

/// One period that was run.
struct Trial {
  long overruns = 0;
  bool is_good = false;                 ///< the program's verdict: no overrun, and the limits that are given hold
  std::string verdict{};                ///< in words
  std::map<std::string, long> blame{};  ///< cycles that each phase made late
  double latest_us = 0.0;
  double median_step_us = 0.0;
  double longest_step_us = 0.0;
  bool real_time = false;

  bool holds() const { return overruns == 0 && is_good; }
};

std::string blamed(const Trial& trial) {
  std::string words;
  for (const auto& [phase, cycles] : trial.blame) {
    if (cycles > 0) {
      words += fmt::format("{}{} {}", words.empty() ? "" : ", ", phase, cycles);
    }
  }
  return words;
}

Trial run_at(const PeriodSearch& search, int period_us) {
  const auto cycles = std::lround(search.seconds * 1e6 / period_us);
  std::vector<std::string> arguments{
      "timing", "--json", "--period-us", std::to_string(period_us), "--cycles", std::to_string(cycles)};
  arguments.insert(arguments.end(), search.arguments.begin(), search.arguments.end());
  const ProgramOutput output = run_realtime_program(arguments);
  // It has said why on standard error. --require-realtime ends it before there is a report.
  if ((output.status != 0 && output.status != kTiming) || output.text.empty()) {
    throw UsageError(fmt::format("hotfire-rt timing ended with status {}", output.status));
  }
  const auto report = nlohmann::json::parse(output.text).at("hotfire");
  Trial trial;
  trial.overruns = report.at("overruns").get<long>();
  trial.is_good = output.status == 0;
  trial.verdict = report.at("reason").get<std::string>();
  for (const auto& [phase, count] : report.at("blame").items()) {
    trial.blame[phase] = count.get<long>();
  }
  trial.latest_us = report.at("wake_up_us").at("max").get<double>();
  trial.median_step_us = report.at("step_us").at("median").get<double>();
  trial.longest_step_us = report.at("step_us").at("max").get<double>();
  trial.real_time = report.at("real_time").get<bool>();
  return trial;
}

nlohmann::json json_of(int period_us, const Trial& trial) {
  return {{"period_us", period_us},
          {"overruns", trial.overruns},
          {"held", trial.holds()},
          {"reason", trial.verdict},
          {"blame", trial.blame},
          {"latest_wake_up_us", trial.latest_us},
          {"median_step_us", trial.median_step_us},
          {"longest_step_us", trial.longest_step_us}};
}

using Trials = std::map<int, Trial>;  ///< by period [us]

bool all_in_real_time(const Trials& trials) {
  return std::all_of(trials.begin(), trials.end(), [](const auto& own) { return own.second.real_time; });
}

/// `shortest`: the shortest period that held, 0 for none.
void print_as_json(const PeriodSearch& search, const Trials& trials, int shortest) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& [period, trial] : trials) {
    all.push_back(json_of(period, trial));
  }
  print_json({{"shortest_period_us", shortest > 0 ? nlohmann::json(shortest) : nlohmann::json(nullptr)},
              {"seconds_each", search.seconds},
              {"real_time", all_in_real_time(trials)},
              {"trials", all}});
}

/// The shortest period that held and the longest that did not [us]; 0 for none.
struct Ends {
  int held;
  int failed;
};

void print_words(const PeriodSearch& search, const Trials& trials, const Ends& ends) {
  if (ends.held == 0) {
    const Trial& longest = trials.at(kLongest);
    fmt::print("no period up to {} us is without an overrun in {:g} s{}\n", kLongest, search.seconds,
               longest.overruns > 0 ? "" : " and within the limits: " + longest.verdict);
    return;
  }
  fmt::print("shortest period without an overrun in {:g} s: {} us\n", search.seconds, ends.held);
  if (ends.failed > 0) {
    const Trial& shorter = trials.at(ends.failed);
    fmt::print("at {} us {}\n", ends.failed,
               shorter.overruns > 0 ? "these phases made cycles late: " + blamed(shorter)
                                    : "a limit was exceeded: " + shorter.verdict);
  }
  if (!all_in_real_time(trials)) {
    fmt::print("this machine refused real-time running: the figure does not describe a real-time machine\n");
  }
}

}  // namespace

int find_shortest_period(const PeriodSearch& search) {
  Trials trials;
  const auto holds = [&](int period_us) {
    const Trial& trial = trials[period_us] = run_at(search, period_us);
    if (!search.json) {
      fmt::print("{:6} us: {} overruns{}; wake-up {:.1f} us at the latest, step {:.1f} us (median), {:.1f} us (longest){}\n",
                 period_us, trial.overruns, trial.overruns > 0 ? " (" + blamed(trial) + ")" : "", trial.latest_us,
                 trial.median_step_us, trial.longest_step_us,
                 trial.overruns == 0 && !trial.is_good ? "; beyond a limit" : "");
      std::fflush(stdout);
    }
    return trial.holds();
  };
  // Bisection over the logarithm: a period that holds, and a shorter one that does not.
  int good = kLongest;
  int bad = 0;
  if (!holds(kLongest)) {
    good = 0;
  } else if (holds(kShortest)) {
    good = kShortest;
  } else {
    bad = kShortest;
    while (good > kResolution * bad && good > bad + 1) {
      const int middle = std::clamp(static_cast<int>(std::lround(std::sqrt(double{1.0} * good * bad))), bad + 1, good - 1);
      (holds(middle) ? good : bad) = middle;
    }
  }
  search.json ? print_as_json(search, trials, good) : print_words(search, trials, {good, bad});
  return good > 0 ? 0 : kTiming;
}

}  // namespace hotfire
