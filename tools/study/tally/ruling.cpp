// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/ruling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

namespace hotfire::study {
namespace {

constexpr std::string_view kUnlisted = "unlisted@";

using Errors = std::map<std::string, double>;

Errors::const_iterator loudest(const Errors& errors) {
  return std::max_element(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
}

bool is_unlisted_word(const std::string& word) { return word.starts_with(kUnlisted); }

std::vector<std::string> split(const std::string& sites) {
  std::vector<std::string> words;
  std::istringstream text(sites);
  for (std::string word; std::getline(text, word, '|');) {
    words.push_back(word);
  }
  return words;
}

/// Whether what the finder says of the site is right: the site, or a set with it that is no larger than the largest set of
/// sites from which no prior separates it.
bool is_placed(const std::string& said, const std::string& wanted) {
  constexpr std::size_t kLargestSet = 4;
  const std::vector<std::string> sites = split(said);
  const std::vector<std::string> right = split(wanted);
  return sites.size() <= kLargestSet && std::any_of(sites.begin(), sites.end(), [&](const std::string& site) {
           return std::find(right.begin(), right.end(), site) != right.end();
         });
}

}  // namespace

bool Judgement::is_unlisted() const { return std::any_of(wanted.begin(), wanted.end(), is_unlisted_word); }

std::optional<double> Judgement::left() const {
  if (after.empty() || effect.empty()) {
    return std::nullopt;
  }
  const auto most = loudest(effect);
  return after.at(most->first) / most->second;
}

std::optional<double> Judgement::over_noise() const {
  return after.empty() ? std::nullopt : std::optional(loudest(after)->second);
}

void rule_on_unlisted(const std::set<std::string>& may_name, Judgement& judgement) {
  std::multiset<std::string> missing;
  std::string sites;
  for (const std::string& word : judgement.wanted) {
    if (is_unlisted_word(word)) {
      sites += fmt::format("{}{}", sites.empty() ? "" : "|", word.substr(kUnlisted.size()));
    } else {
      missing.insert(word);
    }
  }
  bool any = false;
  bool all_placed = true;
  for (std::size_t i = 0; i < judgement.found.size(); ++i) {
    if (const auto listed = missing.find(judgement.found[i]); listed != missing.end()) {
      missing.erase(listed);
      continue;
    }
    const bool named = !is_unlisted_word(judgement.found[i]);
    judgement.wrong_name = judgement.wrong_name || (named && !may_name.contains(judgement.found[i]));
    any = true;
    all_placed = all_placed && is_placed(judgement.found_sites[i], sites);
  }
  judgement.site_right = any && all_placed;
  judgement.names_right = judgement.failure.empty() && missing.empty();
  judgement.halved = judgement.left().value_or(1.0) < 0.5;
}

void add_find(const explain::FoundEffect& effect, Judgement& judgement) {
  const std::string axis = effect.axis.empty() ? "" : "." + effect.axis;
  std::vector<std::string> sites = effect.sites;
  if (sites.empty() && !effect.site.empty()) {
    sites.push_back(effect.site);
  }
  for (std::string& site : sites) {
    site += axis;
  }
  const bool is_named = !effect.name.empty() && effect.name != "unlisted" && effect.name != "residual";
  judgement.found_sites.push_back(fmt::format("{}", fmt::join(sites, "|")));
  judgement.found.push_back(is_named ? effect.name + axis : std::string(kUnlisted) + judgement.found_sites.back());
  judgement.found_laws.push_back(effect.law);
}

}  // namespace hotfire::study
