// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

#include "tools/explain/policy/policy.hpp"
#include "tools/files/text/error.hpp"
#include "tools/study/tally/judge.hpp"

namespace hotfire::study {
namespace {

constexpr std::array kFactors{0.7, 1.4};

bool is_good(const Judgement& judgement) {
  if (judgement.is_null()) {
    return judgement.names_right;
  }
  return judgement.is_unlisted() ? !judgement.wrong_name && judgement.site_right && judgement.halved
                                 : judgement.names_right && judgement.below_noise;
}

explain::Policy varied_policy(const Variation& variation) {
  explain::Policy policy = explain::policy();
  for (const explain::PolicyConstant& constant : explain::kPolicyConstants) {
    if (constant.name == variation.constant) {
      policy.*constant.value *= variation.factor;
    }
  }
  return policy;
}

const Ruling* find(const std::vector<Ruling>& rulings, const Variation& variation, const std::string& name) {
  const auto found = std::ranges::find_if(rulings, [&](const Ruling& ruling) {
    return ruling.constant == variation.constant && ruling.factor == variation.factor && ruling.name == name;
  });
  return found == rulings.end() ? nullptr : &*found;
}

}  // namespace

std::vector<Variation> variations(const std::vector<std::string>& only) {
  for (const std::string& name : only) {
    if (std::ranges::none_of(explain::kPolicyConstants, [&](const auto& constant) { return constant.name == name; })) {
      std::vector<std::string_view> names;
      std::ranges::transform(explain::kPolicyConstants, std::back_inserter(names), &explain::PolicyConstant::name);
      throw UsageError(fmt::format("{}: is no constant of the policy; give one of {}", name, fmt::join(names, ", ")));
    }
  }
  std::vector<Variation> all{{}};
  for (const explain::PolicyConstant& constant : explain::kPolicyConstants) {
    if (only.empty() || std::ranges::find(only, constant.name) != only.end()) {
      for (const double factor : kFactors) {
        all.push_back({constant.name, factor});
      }
    }
  }
  return all;
}

std::vector<Ruling> sensitivity(const std::vector<std::filesystem::path>& folders, const std::vector<Variation>& varied,
                                std::vector<Ruling> known, unsigned threads, const std::function<void(const Ruling&)>& say) {
  for (const Variation& variation : varied) {
    const explain::WithPolicy with(varied_policy(variation));
    for (const std::filesystem::path& folder : folders) {
      if (find(known, variation, folder.filename().string()) != nullptr) {
        continue;
      }
      const Judgement judgement = judge(folder, threads);
      known.push_back({std::string(variation.constant), variation.factor, judgement.name, is_good(judgement)});
      say(known.back());
    }
  }
  return known;
}

std::vector<Change> changes_of(const std::vector<Ruling>& rulings, const std::vector<Variation>& varied) {
  std::vector<Change> changes;
  for (const Variation& variation : varied) {
    if (variation.constant.empty()) {
      continue;
    }
    Change change{variation};
    for (const Ruling& ruling : rulings) {
      if (ruling.constant != variation.constant || ruling.factor != variation.factor) {
        continue;
      }
      if (const Ruling* as_is = find(rulings, {}, ruling.name)) {
        ++change.of;
        change.better += ruling.good && !as_is->good ? 1 : 0;
        change.worse += !ruling.good && as_is->good ? 1 : 0;
      }
    }
    changes.push_back(change);
  }
  return changes;
}

std::string table_of(const std::vector<Change>& changes) {
  std::string text = fmt::format("{:<24} {:>6} {:>7} {:>7} {:>7}\n", "constant", "factor", "better", "worse", "cases");
  for (const Change& change : changes) {
    text +=
        fmt::format("{:<24} {:>6} {:>7} {:>7} {:>7}{}\n", change.variation.constant, change.variation.factor, change.better,
                    change.worse, change.of, change.better + change.worse > kMostChanges ? "  MORE THAN TWO" : "");
  }
  return text;
}

nlohmann::json json_of(const Ruling& ruling) {
  return {{"constant", ruling.constant}, {"factor", ruling.factor}, {"case", ruling.name}, {"good", ruling.good}};
}

std::vector<Ruling> load_rulings(const std::filesystem::path& path) {
  std::vector<Ruling> rulings;
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    try {
      rulings.push_back({object.at("constant").get<std::string>(), object.at("factor").get<double>(),
                         object.at("case").get<std::string>(), object.at("good").get<bool>()});
    } catch (const nlohmann::json::exception&) {
      throw FileError(
          fmt::format("{}:{}: is no ruling of this command; give another file, or delete the line", path.string(), number));
    }
  }
  return rulings;
}

}  // namespace hotfire::study
