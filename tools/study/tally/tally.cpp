// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace hotfire::study {
namespace {

/// Probability of at most `hits` of `trials`.
double at_most(std::size_t hits, std::size_t trials, double probability) {
  double sum = 0.0;
  const auto n = static_cast<double>(trials);
  for (std::size_t i = 0; i <= hits; ++i) {
    const auto k = static_cast<double>(i);
    const double ways = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
    sum += std::exp(ways + k * std::log(probability) + (n - k) * std::log1p(-probability));
  }
  return sum;
}

/// Where a falling function of a probability crosses `level`.
double crossing(const std::function<double(double)>& falling, double level) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (falling(middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

using Judgements = std::vector<const Judgement*>;

Judgements those(const std::vector<Judgement>& all, bool (*kind)(const Judgement&)) {
  Judgements some;
  for (const Judgement& judgement : all) {
    if (kind(judgement)) {
      some.push_back(&judgement);
    }
  }
  return some;
}

std::size_t count(const Judgements& some, bool (*holds)(const Judgement&)) {
  return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [&](const Judgement* j) { return holds(*j); }));
}

bool named(const Judgement& j) { return j.names_right; }
bool quiet(const Judgement& j) { return j.below_noise; }
bool placed_or_quiet(const Judgement& j) { return j.site_right || j.below_noise; }
bool without_wrong_name(const Judgement& j) { return j.failure.empty() && !j.wrong_name; }

/// `share_of` / `share_in` of the cases is what is asked for.
Figure at_least(const char* name, const Judgements& some, bool (*holds)(const Judgement&), std::size_t share_of,
                std::size_t share_in) {
  const std::size_t reached = count(some, holds);
  return {name, reached, some.size(), reached * share_in >= some.size() * share_of,
          fmt::format("at least {} of {}", share_of, share_in)};
}

Judgements nulls_of(const std::vector<Judgement>& all) {
  return those(all, [](const Judgement& j) { return j.is_null(); });
}

}  // namespace

std::array<double, 2> exact_interval(std::size_t hits, std::size_t trials) {
  constexpr double kSide = 0.025;
  const double low = hits == 0 ? 0.0 : crossing([&](double p) { return at_most(hits - 1, trials, p); }, 1.0 - kSide);
  const double high = hits == trials ? 1.0 : crossing([&](double p) { return at_most(hits, trials, p); }, kSide);
  return {low, high};
}

std::vector<Figure> figures_of(const std::vector<Judgement>& judgements) {
  std::vector<Figure> figures;
  const Judgements unlisted = those(judgements, [](const Judgement& j) { return j.is_unlisted() && !j.is_wild; });
  const Judgements wild = those(judgements, [](const Judgement& j) { return j.is_wild && j.wanted.size() == 1; });
  const Judgements beside = those(judgements, [](const Judgement& j) { return j.is_wild && j.wanted.size() > 1; });
  const Judgements single = those(judgements, [](const Judgement& j) { return j.wanted.size() == 1 && !j.is_unlisted(); });
  const Judgements several = those(judgements, [](const Judgement& j) { return j.wanted.size() > 1 && !j.is_wild; });
  const Judgements nulls = nulls_of(judgements);
  if (!single.empty()) {
    figures.push_back(at_least("one effect: named right", single, named, 19, 20));
    figures.push_back(at_least("one effect: model error below sensor noise", single, quiet, 18, 20));
  }
  if (!several.empty()) {
    figures.push_back(at_least("pairs: both named", several, named, 8, 10));
  }
  if (!unlisted.empty()) {
    figures.push_back(at_least("unlisted: no wrong name", unlisted, without_wrong_name, 1, 1));
    figures.push_back(at_least(
        "unlisted: site right", unlisted, [](const Judgement& j) { return j.site_right; }, 5, 6));
    figures.push_back(at_least(
        "unlisted: error halved", unlisted, [](const Judgement& j) { return j.halved; }, 1, 1));
  }
  if (!wild.empty()) {
    figures.push_back(at_least("wild: no wrong name", wild, without_wrong_name, 97, 100));
    figures.push_back(at_least("wild: right site, or below the noise", wild, placed_or_quiet, 85, 100));
    figures.push_back(at_least(
        "wild: error halved", wild, [](const Judgement& j) { return j.halved; }, 85, 100));
  }
  if (!beside.empty()) {
    figures.push_back(at_least("listed + wild: listed one named", beside, named, 27, 30));
    figures.push_back(at_least(
        "listed + wild: both", beside, [](const Judgement& j) { return named(j) && placed_or_quiet(j); }, 24, 30));
    figures.push_back(at_least("listed + wild: no wrong name", beside, without_wrong_name, 29, 30));
  }
  if (!nulls.empty()) {
    const std::size_t wrong = nulls.size() - count(nulls, named);
    figures.push_back({"null: false finds", wrong, nulls.size(), wrong * 40 <= nulls.size(), "at most 1 of 40"});
  }
  return figures;
}

bool all_met(const std::vector<Judgement>& judgements) {
  const std::vector<Figure> figures = figures_of(judgements);
  return std::all_of(figures.begin(), figures.end(), [](const Figure& figure) { return figure.met; });
}

std::string summary_of(const std::vector<Judgement>& judgements) {
  std::string text;
  const Judgements with_laws = those(judgements, [](const Judgement& j) {
    return !j.wanted_law.empty() && j.names_right && !j.is_unlisted() && j.found_laws.size() == 1;
  });
  if (!with_laws.empty()) {
    text += fmt::format("{:<44} {} of {}, of those named right; not asked for\n", "one effect: its law as it was made",
                        count(with_laws, [](const Judgement& j) { return j.found_laws.front() == j.wanted_law; }),
                        with_laws.size());
  }
  for (const Figure& figure : figures_of(judgements)) {
    text += fmt::format("{:<44} {} of {}, asked {}: {}\n", figure.name, figure.reached, figure.of, figure.asked,
                        figure.met ? "met" : "NOT MET");
  }
  if (const Judgements nulls = nulls_of(judgements); !nulls.empty()) {
    const auto interval = exact_interval(nulls.size() - count(nulls, named), nulls.size());
    text += fmt::format("{:<44} {:.1f} .. {:.1f} % (exact 95 % interval)\n", "null: false-find rate", 100.0 * interval[0],
                        100.0 * interval[1]);
  }
  return text;
}

nlohmann::json summary_json(const std::vector<Judgement>& judgements) {
  nlohmann::json result{{"figures", nlohmann::json::array()}, {"met", all_met(judgements)}};
  for (const Figure& figure : figures_of(judgements)) {
    result["figures"].push_back({{"name", figure.name},
                                 {"reached", figure.reached},
                                 {"of", figure.of},
                                 {"asked", figure.asked},
                                 {"met", figure.met}});
  }
  if (const Judgements nulls = nulls_of(judgements); !nulls.empty()) {
    result["false_find_rate_ci95"] = exact_interval(nulls.size() - count(nulls, named), nulls.size());
  }
  return result;
}

}  // namespace hotfire::study
