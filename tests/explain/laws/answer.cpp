// SPDX-License-Identifier: Apache-2.0
#include "tests/explain/laws/answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "tools/explain/explain.hpp"

namespace hotfire::test {

namespace {

/// Of a two-sided interval of 95 %.
constexpr double kErrorsInInterval = 2.0 * 1.959964;
/// Two fits of other noise differ by more than this many standard errors of their difference once in 16,000.
constexpr double kMostErrors = 4.0;
/// A fit stops where a step takes less than this share off its cost.
constexpr double kFitStops = 1e-5;

Value value_of(double value, const std::string& unit, const std::optional<explain::Interval95>& interval) {
  return {value, interval ? (interval->second - interval->first) / kErrorsInInterval : 0.0, unit};
}

/// Names and sites. With other noise or fewer rows a term without a name may be a gain in one answer and a curve in the
/// other.
std::multiset<std::string> finds_of(const Answer& answer, Agreement agreement) {
  std::multiset<std::string> finds;
  for (const Find& find : answer.finds) {
    const bool says_law = agreement != Agreement::other || find.name != "unlisted";
    finds.insert(fmt::format("{} {} at {}", find.name, says_law ? find.law : "", find.site));
  }
  return finds;
}

/// How far two answers may lie apart, in standard errors of both. A fit that stops at a share of its cost beside the best
/// is off by the square root of twice that: the cost is half a chi-square over the values compared.
double most_apart(Agreement agreement, const Answer& answer) {
  return agreement == Agreement::other ? kMostErrors : std::sqrt(kFitStops * answer.compared);
}

}  // namespace

Answer answer_of(const Given& given) {
  explain::ExplainOptions options;
  options.threads = given.threads;
  const auto explanation = explain::explain(given.declared, given.records, options);
  const explain::Result& result = explanation.result;
  Answer answer;
  answer.verdict = explain::name_of(result.verdict);
  answer.model = model_text(explanation.model);
  for (const Record& record : given.records) {
    answer.compared += 2.0 * static_cast<double>(record.rows);
  }
  for (const explain::FoundEffect& effect : result.effects) {
    answer.finds.push_back({effect.name, effect.law, effect.site});
    for (const explain::EffectParameter& parameter : effect.parameters) {
      answer.values[effect.key + "." + parameter.name] = value_of(parameter.value, parameter.unit, parameter.interval);
    }
  }
  for (const explain::CalibratedParameter& parameter : result.calibration) {
    answer.values[parameter.key] = value_of(parameter.value, parameter.unit, parameter.interval);
  }
  return answer;
}

std::string broken(const Transformation& transformation, const Answer& original, const Answer& transformed) {
  if (transformation.agreement == Agreement::same_bits) {
    return original.model == transformed.model ? "" : "the explained model has other bits";
  }
  const auto finds = finds_of(original, transformation.agreement);
  const auto other_finds = finds_of(transformed, transformation.agreement);
  if (original.verdict != transformed.verdict || finds != other_finds) {
    return fmt::format("{} {} became {} {}", original.verdict, finds, transformed.verdict, other_finds);
  }
  const bool same_laws = finds_of(original, Agreement::same) == finds_of(transformed, Agreement::same);
  const double most = most_apart(transformation.agreement, original);
  std::string text;
  for (const auto& [key, value] : original.values) {
    if (!transformed.values.contains(key)) {
      text += !same_laws ? "" : fmt::format("{} is not there; ", key);
      continue;
    }
    const double factor = transformation.factor == nullptr ? 1.0 : transformation.factor(key, value.unit);
    const Value& other = transformed.values.at(key);
    if ((value.error > 0.0) != (other.error > 0.0)) {
      text += fmt::format("{} is determined in one of the two only; ", key);
      continue;
    }
    const double error = std::hypot(value.error, other.error / factor);
    const double apart = std::abs(other.value / factor - value.value);
    if (error > 0.0 && !(apart <= most * error)) {
      text += fmt::format("{}: {} became {}, {:.2f} standard errors apart, {:.2f} allowed; ", key, value.value,
                          other.value / factor, apart / error, most);
    }
  }
  return text;
}

}  // namespace hotfire::test
