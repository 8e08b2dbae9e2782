// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "model/numerics/step_size.hpp"
#include "tests/benchmark/operations.hpp"

namespace hotfire::test {

namespace {

using Results = std::map<std::string, Measured>;

/// The results whose names begin with a word, by the number that follows it.
std::vector<std::pair<double, Measured>> series(const Results& measured, const std::string& word) {
  std::vector<std::pair<double, Measured>> found;
  for (const auto& [name, own] : measured) {
    if (name.starts_with(word + "/")) {
      found.emplace_back(std::stod(name.substr(word.size() + 1)), own);
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return found;
}

/// Least squares of time over modes: what a step costs without modes, and what each adds [s], and the largest deviation from
/// it over the cost.
struct Line {
  double constant = 0.0;
  double slope = 0.0;
  double deviation = 0.0;
};

Line fitted(const std::vector<std::pair<double, Measured>>& points) {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const auto& [modes, own] : points) {
    n += 1.0;
    x += modes;
    y += own.seconds;
    xx += modes * modes;
    xy += modes * own.seconds;
  }
  Line line;
  line.slope = (n * xy - x * y) / (n * xx - x * x);
  line.constant = (y - line.slope * x) / n;
  for (const auto& [modes, own] : points) {
    line.deviation = std::max(line.deviation, std::abs(line.constant + line.slope * modes - own.seconds) / own.seconds);
  }
  return line;
}

void append_steps(std::string& text, const Results& measured) {
  const auto axis = measured.find("step_axis");
  const auto taos = measured.find("step_taos");
  const auto masv = series(measured, "step_masv");
  if (axis == measured.end() || taos == measured.end() || masv.size() < 2) {
    return;
  }
  const auto add = std::back_inserter(text);
  fmt::format_to(
      add,
      "\n## One step\n\n| plant | time | relative to one axis | target | state and constants |\n|---|---|---|---|---|\n");
  const double one = axis->second.seconds;
  const auto row = [&](const std::string& name, const Measured& own, const char* wanted) {
    fmt::format_to(add, "| {} | {:.0f} ns | {:.2f} | {} | {:.1f} KiB |\n", name, 1e9 * own.seconds, own.seconds / one,
                   wanted, own.counters.at("bytes") / 1024.0);
  };
  row("one axis, friction, soft spring, dead band", axis->second, "");
  row("TAOS, hot fire", taos->second, "under 3");
  for (const auto& [modes, own] : masv) {
    row(fmt::format("MASV, hot fire, {:.0f} modes", modes), own, modes == 64.0 ? "under 14, under 64 KiB" : "");
  }
  const Line line = fitted(masv);
  fmt::format_to(
      add,
      "\nThe time of MASV is linear in its number of modes: {:.0f} ns + {:.2f} ns a mode. No point is further than "
      "{:.1f} %\n"
      "from that line. `ctest -R vehicle_cost` checks the number of instructions, which does not depend on other "
      "load.\n",
      1e9 * line.constant, 1e9 * line.slope, 100.0 * line.deviation);
}

/// How many plants step within half of a period: the other half is for inputs, outputs, the recorder and the latency.
void append_axes_of_a_core(std::string& text, const Results& measured) {
  struct Plant {
    const char* name;
    const char* words;
    int axes;
  };
  constexpr Plant kPlants[] = {{"step_axis", "one axis, friction, soft spring, dead band", 1},
                               {"step_taos", "TAOS, hot fire", 2},
                               {"step_masv/64", "MASV, hot fire, 64 modes", 8}};
  constexpr double kShare = 0.5;
  constexpr double kPeriods[] = {1e-3, 2.5e-4, 1e-4};
  if (std::any_of(std::begin(kPlants), std::end(kPlants), [&](const Plant& own) { return !measured.contains(own.name); })) {
    return;
  }
  const auto add = std::back_inserter(text);
  text.append(
      "\n## Axes of one core\n\nThis many axes step within half of a period. The other half is for inputs, outputs, the "
      "recorder\nand the latency of the machine. A period of 1 ms has two steps of 0.5 ms.\n\n"
      "| plant | 1 kHz | 4 kHz | 10 kHz |\n|---|---|---|---|\n");
  for (const Plant& own : kPlants) {
    fmt::format_to(add, "| {} |", own.words);
    for (const double period : kPeriods) {
      const double step = model::steps_per_period(period) * measured.at(own.name).seconds;
      fmt::format_to(add, " {} |", own.axes * static_cast<int>(kShare * period / step));
    }
    text.append("\n");
  }
}

void append_batches(std::string& text, const Results& measured) {
  const auto alone = measured.find("batch_alone");
  const auto together = measured.find("batch_together");
  if (alone == measured.end() || together == measured.end()) {
    return;
  }
  const auto add = std::back_inserter(text);
  text.append(
      "\n## Many parameter sets\n\n"
      "1,000 parameter sets of one axis with friction, soft spring and dead band, 2 s each, on one core. Side by side, "
      "eight\n"
      "runs share the registers of the core (`hotfire.simulate_many`). Each run has the bits that it has alone.\n\n"
      "| | simulated seconds a second | over one after the other | target |\n|---|---|---|---|\n");
  const auto row = [&](const char* name, const Measured& own, const char* wanted) {
    fmt::format_to(add, "| {} | {:.0f} | {:.2f} | {} |\n", name, own.counters.at("simulated") / own.seconds,
                   alone->second.seconds / own.seconds, wanted);
  };
  row("one after the other", alone->second, "");
  row("side by side", together->second, "3");
}

/// What the arithmetic of a step is, beside which its instructions stand.
void append_contents(std::string& text, const Results& measured) {
  if (measured.find("step_axis") == measured.end()) {
    return;
  }
  const auto add = std::back_inserter(text);
  text.append(
      "\n## What a step is made of\n\n"
      "| plant | additions | multiplications | divisions | roots | exponentials | comparisons | constants and state |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const StepContents& own : contents_of_steps()) {
    const Operations& of = own.operations;
    fmt::format_to(add, "| {} | {} | {} | {} | {} | {} | {} | {:.1f} KiB |\n", own.name, of.additions, of.multiplications,
                   of.divisions, of.roots, of.exponentials, of.comparisons, static_cast<double>(own.bytes) / 1024.0);
  }
  text.append(
      "\nThe counts are means over a run, by a scalar that counts. Three products of a matrix and a vector make most of "
      "the\n"
      "multiplications (8 x 8, and 8 x 6 three times). A processor with AVX2 does four of them in one instruction. An\n"
      "exponential takes about 30 instructions. `ctest --test-dir build/release -R step_cost -V` prints the instructions of "
      "a\n"
      "step, how often it reads and writes data, its conditional branches, and its misses of the first cache. What the\n"
      "instructions are beyond the arithmetic reads and writes constants and state.\n");
}

/// The fastest run of CVODE whose error is no larger; null if none is.
const std::pair<double, Measured>* as_accurate(const std::vector<std::pair<double, Measured>>& cvode, double error) {
  const std::pair<double, Measured>* best = nullptr;
  for (const auto& candidate : cvode) {
    if (candidate.second.counters.at("error") <= error &&
        (best == nullptr || candidate.second.seconds < best->second.seconds)) {
      best = &candidate;
    }
  }
  return best;
}

/// Both tables of one plant, whose benchmarks are `ours_PLANT` and `cvode_PLANT`.
void append_comparison(std::string& text, const Results& measured, const std::string& plant, const std::string& title) {
  const auto own = series(measured, "ours_" + plant);
  const auto cvode = series(measured, "cvode_" + plant);
  if (own.empty() || cvode.empty()) {
    return;
  }
  const auto add = std::back_inserter(text);
  fmt::format_to(add,
                 "\n### {}\n\n| step of the model | error | time | CVODE with no larger error: tolerance, time | ratio "
                 "|\n|---|---|---|---|---|\n",
                 title);
  for (const auto& [parts, ours] : own) {
    const double error = ours.counters.at("error");
    fmt::format_to(add, "| {:.3g} ms | {:.2g} % | {:.2f} ms |", 1.0 / parts, 100.0 * error, 1e3 * ours.seconds);
    if (const auto* best = as_accurate(cvode, error)) {
      fmt::format_to(add, " 1e-{:.0f}, {:.0f} ms | {:.0f} |\n", best->first, 1e3 * best->second.seconds,
                     best->second.seconds / ours.seconds);
    } else {
      fmt::format_to(add, " none of those that ran | |\n");
    }
  }
  fmt::format_to(add, "\n| CVODE, relative tolerance | error | time | evaluations |\n|---|---|---|---|\n");
  for (const auto& [digits, other] : cvode) {
    fmt::format_to(add, "| 1e-{:.0f} | {:.2g} % | {:.0f} ms | {:.0f} |\n", digits, 100.0 * other.counters.at("error"),
                   1e3 * other.seconds, other.counters.at("evaluations"));
  }
}

void append_work_precision(std::string& text, const Results& measured) {
  const bool ran =
      std::any_of(measured.begin(), measured.end(), [](const auto& own) { return own.first.starts_with("cvode_"); });
  if (!ran) {
    return;
  }
  text.append(
      "\n## Work and precision\n\n"
      "The tables compare the model's step with CVODE at equal error. The ratio is the time of CVODE over the time of the "
      "model.\n"
      "The target is a ratio of at least 20.\n"
      "\n"
      "- **Test.** Sines and steps about every angle, with commands that are held for 1 ms. One axis runs for 1.5 s, the "
      "other\n"
      "  plants for 1.2 s. The start state is computed before the measurement.\n"
      "- **Error.** The rms error of a piston or an engine over the rms of its signal; the table gives the largest one. "
      "The\n"
      "  reference is CVODE at a relative tolerance of 1e-10, on independently written equations.\n"
      "- **CVODE.** It uses BDF with a dense Jacobian by differences. It restarts at every command, because the command "
      "jumps. CVODE\n"
      "  accepts any equations, whereas the model's step is made for these. The reference equations are written for clarity "
      "and not\n"
      "  for speed: bisection solves the force of a soft spring.\n"
      "- **Evaluations** are those of the equations, without the ones for the Jacobian. A step of the model evaluates them "
      "twice.\n");
  append_comparison(text, measured, "axis", "One axis, friction, soft spring, dead band");
  append_comparison(text, measured, "taos", "TAOS: two axes, hot fire with every effect, four modes");
  append_comparison(text, measured, "masv", "MASV: eight axes, hot fire with every effect, twelve modes that couple them");
}

constexpr double kRigParts = 2.0;  // steps a millisecond, of the rig's own step

/// The model at the rig's own step against every other solver at its cheapest step with no larger error.
void append_rivals(std::string& text, const Results& measured) {
  struct Method {
    const char* name;
    const char* words;
    bool is_fixed;
  };
  constexpr Method kMethods[] = {
      {"rk4", "Runge-Kutta, fourth order", true},
      {"extrapolation2", "linearly implicit Euler, extrapolated to order 2", true},
      {"extrapolation3", "linearly implicit Euler, extrapolated to order 3", true},
      {"midpoint2", "implicit midpoint rule, 2 Newton steps", true},
      {"midpoint3", "implicit midpoint rule, 3 Newton steps", true},
      {"jacobian", "CVODE, analytic Jacobian", false},
  };
  const auto add = std::back_inserter(text);
  const auto table = [&](const std::string& plant, const char* title) {
    const auto ours = series(measured, "ours_" + plant);
    const auto rig = std::find_if(ours.begin(), ours.end(), [](const auto& own) { return own.first == kRigParts; });
    if (rig == ours.end() || series(measured, std::string("rk4_") + plant).empty()) {
      return;
    }
    const double error = rig->second.counters.at("error");
    fmt::format_to(
        add,
        "\n### {}\n\nThe model at 0.5 ms: error {:.2g} %, {:.2f} ms.\n\n"
        "| solver | largest stable step | step or tolerance with no larger error | error | time | over the model |\n"
        "|---|---|---|---|---|---|\n",
        title, 100.0 * error, 1e3 * rig->second.seconds);
    for (const Method& method : kMethods) {
      const auto own = series(measured, std::string(method.name) + "_" + plant);
      const auto stable = std::find_if(own.begin(), own.end(),
                                       [](const auto& run) { return std::isfinite(run.second.counters.at("error")); });
      const auto* best = as_accurate(own, error);
      const std::string largest = !method.is_fixed      ? ""
                                  : stable == own.end() ? "none"
                                                        : fmt::format("{:.3g} ms", 1.0 / stable->first);
      if (best == nullptr) {
        fmt::format_to(add, "| {} | {} | none of those that ran | | | |\n", method.words, largest);
        continue;
      }
      const std::string at =
          method.is_fixed ? fmt::format("{:.3g} ms", 1.0 / best->first) : fmt::format("1e-{:.0f}", best->first);
      fmt::format_to(add, "| {} | {} | {} | {:.2g} % | {:.2f} ms | {:.2g} |\n", method.words, largest, at,
                     100.0 * best->second.counters.at("error"), 1e3 * best->second.seconds,
                     best->second.seconds / rig->second.seconds);
    }
  };
  const std::size_t before = text.size();
  text.append(
      "\n## Against other solvers\n\n"
      "These solvers integrate the same equations over the same run. The equations are written for speed; the laws of\n"
      "friction and spring are the model's own. Jacobians are exact, by dual numbers. A fixed step divides the millisecond\n"
      "over which a command is held: 1, 1/2, 1/3, 1/4, 1/6, 1/8, 1/12 or 1/16 ms. The target holds at the rig's step of "
      "0.5 ms.\n"
      "It is 5 (one axis and TAOS) and 8 (MASV) over the best fixed-step solver, and 50 over CVODE.\n\n"
      "An explicit solver needs no Jacobian. It is unstable beyond a step that the stiffest part sets: friction, bearing "
      "or\n"
      "oil. The model's step is stable at any step.\n");
  const std::size_t heading = text.size();
  table("plain", "One axis as declared");
  table("axis", "One axis, friction, soft spring, dead band");
  table("taos", "TAOS, hot fire with every effect, four modes");
  table("masv", "MASV, hot fire with every effect, twelve modes");
  if (text.size() == heading) {
    text.resize(before);
  }
}

}  // namespace

void Collector::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) {
      continue;
    }
    std::string name = run.run_name.function_name;
    if (!run.run_name.args.empty()) {
      name.append("/").append(run.run_name.args);
    }
    Measured& own = measured_[name];
    own.seconds = std::min(own.seconds, run.cpu_accumulated_time / static_cast<double>(run.iterations));
    for (const auto& [counter, value] : run.counters) {
      own.counters[counter] = value;
    }
  }
}

std::string performance_page(const Results& measured) {
  std::string text =
      "# Performance\n\n"
      "With this page you can choose a period, a step and a processor. It gives the cost of a step of the model, and "
      "compares its\n"
      "accuracy and cost with those of a general-purpose integrator. TAOS is one engine with two axes. MASV is four "
      "engines with\n"
      "eight axes on one structure.\n"
      "\n"
      "`cmake --build build/release --target hotfire-benchmark` builds the program that prints this page, and\n"
      "`build/release/bin/hotfire-benchmark --benchmark_min_time=0.2` prints it. Each time is processor time, "
      "measured by Google "
      "Benchmark. It\n"
      "is the best one if there are several repetitions. Times depend on the machine. Ratios come from one run and hardly "
      "depend on\n"
      "the machine.\n";
  append_steps(text, measured);
  append_axes_of_a_core(text, measured);
  append_batches(text, measured);
  append_contents(text, measured);
  append_work_precision(text, measured);
  append_rivals(text, measured);
  return text;
}

}  // namespace hotfire::test
