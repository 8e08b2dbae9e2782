#include "tools/explain/report/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// "gimbal friction (lugre) at engine_torque".
std::string phrase(const Candidate& candidate) {
  std::string name = candidate.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return fmt::format("{}{} at {}", name, candidate.option_name.empty() ? "" : " (" + candidate.option_name + ")",
                     candidate.site);
}

/// "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

/// ", and of what was tried ... promised most": by a joint fit if there was one.
std::string promising(const std::vector<Trial>& trials) {
  const auto best = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.refined == b.refined ? a.delta_criterion < b.delta_criterion : a.refined;
  });
  if (best == trials.end() || best->delta_criterion > -kStrongEvidence) {
    return "";
  }
  return best->refined ? fmt::format("; of what was fitted by then {} leaves least, {:.0f} % of that",
                                     phrase(best->candidate), 100.0 * best->held_out_ratio)
                       : fmt::format("; in screening {} promised most", phrase(best->candidate));
}

/// The trial with the least held-out error of those fitted jointly that `is_meant`; null if there is none.
template <class F>
const Trial* closest_of(const std::vector<Trial>& trials, F&& is_meant) {
  const Trial* closest = nullptr;
  for (const Trial& trial : trials) {
    if (trial.refined && is_meant(trial) && (closest == nullptr || trial.held_out_ratio < closest->held_out_ratio)) {
      closest = &trial;
    }
  }
  return closest;
}

/// The first term of unknown law that was kept; null if there is none.
template <class Family>
const Kept* first_unlisted(const SearchResult<Family>& found) {
  const auto kept = std::ranges::find_if(found.kept, [](const Kept& k) { return is_unlisted<Family>(k.trial.candidate); });
  return kept == found.kept.end() ? nullptr : &*kept;
}

/// "a term at SITE that depends on ..., and gimbal friction at engine_torque" of everything that was kept.
template <class Family>
std::string terms_in_words(const SearchResult<Family>& found) {
  std::vector<std::string> terms;
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    terms.push_back(is_unlisted<Family>(candidate)
                        ? fmt::format("a term at {} {}", fmt::join(sites_of(kept), " or "), dependence_in_words(candidate))
                        : phrase(candidate));
  }
  return listed(terms);
}

/// Where what is missing acts, as far as the records say.
std::string place_in_words(const Located& located) {
  const std::vector<std::string> sites = located.likely_sites();
  return located.is_single
             ? fmt::format("One unknown signal at {} explains the records down to the noise", fmt::join(sites, " or "))
             : fmt::format("No single place explains it; the most likely ones are {}", listed(sites));
}

}  // namespace

bool is_fault_of_record(const Candidate& candidate) {
  return candidate.name == model::SensorScale::name || candidate.name == model::SensorDelay::name ||
         candidate.name == model::CommandScale::name;
}

bool is_of_record_time(const Candidate& candidate) {
  return candidate.name.starts_with("unlisted_") &&
         (candidate.option_name == "time" || candidate.option_name.ends_with("_along_time") ||
          candidate.name == model::UnlistedDrift::name);
}

template <class Family>
std::string verdict_of(const Dataset& data, const SearchResult<Family>& found) {
  if (first_unlisted(found) != nullptr) {
    return "unlisted-effect";
  }
  if (reaches_noise(data, found.explained)) {
    return found.kept.empty() ? "nothing-missing" : "explained";
  }
  if (!found.kept.empty()) {
    return "partly-explained";
  }
  return found.interrupted || !found.searched ? "undecided" : "unlisted-effect";
}

template <class Family>
std::string sentence_of(const std::string& verdict, const SearchResult<Family>& found, bool noise_is_known) {
  const double before = Goodness::combined(found.declared.goodness.held_out);
  const double after = Goodness::combined(found.explained.goodness.held_out);
  // Times a floor that is no size of the sensor says nothing.
  const std::string falls = noise_is_known
                                ? fmt::format("from {:.1f} to {:.2f} times the noise", before, after)
                                : fmt::format("to {:.3g} % of what the declared model leaves", 100.0 * after / before);
  if (verdict == "nothing-missing" && !is_within_tolerances(found.explained.model)) {
    const Moved farthest = farthest_from_declared(found.explained.model);
    return fmt::format(
        "No effect is found to be missing, but a declared value is wrong or stands in for one: the model meets the records "
        "down to the sensor noise ({:.2f} times its rms on held-out data) only with {} {:.1f} tolerances from its declared "
        "value.",
        after, farthest.key, farthest.tolerances);
  }
  if (verdict == "nothing-missing") {
    return fmt::format(
        "Nothing is missing: within its tolerances the declared model meets the records down to the sensor noise "
        "({:.2f} times its rms on held-out data).",
        after);
  }
  if (verdict == "unlisted-effect" && !found.kept.empty()) {
    return fmt::format(
        "The records hold an effect that is in no list. The explained model has {}: the error on held-out data falls {}.",
        terms_in_words(found), falls);
  }
  if (verdict == "unlisted-effect") {
    return fmt::format(
        "The records hold an effect that is in no list: the error of the calibrated model on held-out data is {}, and no "
        "candidate is supported.{}",
        noise_is_known ? fmt::format("{:.1f} times the noise", after)
                       : fmt::format("{:.3g} % of the declared model's", 100.0 * after / before),
        found.located.places.empty() ? "" : " " + place_in_words(found.located) + ".");
  }
  if (verdict == "undecided") {
    return fmt::format(
        "{}: the calibrated model is {} off on held-out data{}.",
        found.searched ? "Undecided, since the search was interrupted" : "Undecided, since no effect was looked for",
        noise_is_known ? fmt::format("{:.1f} times the noise", after)
                       : fmt::format("{:.3g} % of what the declared model is", 100.0 * after / before),
        promising(found.trials));
  }
  std::vector<std::string> lacks;
  std::vector<std::string> faults;
  for (const Kept& kept : found.kept) {
    (is_fault_of_record(kept.trial.candidate) ? faults : lacks).push_back(phrase(kept.trial.candidate));
  }
  std::string text = lacks.empty() ? "" : "The declared model lacks " + listed(lacks);
  if (!faults.empty()) {
    text += fmt::format("{} at fault: {}", lacks.empty() ? "The records are" : ", and the records are", listed(faults));
  }
  return fmt::format("{}: with {} the error on held-out data falls {}{}.", text, found.kept.size() == 1 ? "it" : "them",
                     falls,
                     verdict == "explained" ? ", close to what the sensors can tell" : "; a part is left unexplained");
}

template <class Family>
std::string what_it_is_not(const SearchResult<Family>& found) {
  const Trial& kept = first_unlisted(found)->trial;
  // Both in percent of what the calibrated model leaves: only the first round is judged against that as terms of unknown
  // law are.
  const Trial* listed = closest_of(found.trials, [](const Trial& t) {
    return t.round == 1 && t.decision != "taken out" && !is_unlisted<Family>(t.candidate);
  });
  const Trial* other = closest_of(found.trials, [&](const Trial& t) {
    return is_unlisted<Family>(t.candidate) && label(t.candidate) != label(kept.candidate);
  });
  std::string text = "No listed effect promised enough in screening to be fitted with everything else.";
  if (listed != nullptr) {
    text = fmt::format(
        "Not {}, of the listed effects the one that alone came closest: it leaves {:.1f} % of the calibrated "
        "model's held-out error, the term that was kept {:.1f} %.",
        phrase(listed->candidate), 100.0 * listed->held_out_ratio, 100.0 * kept.held_out_ratio);
  }
  if (other != nullptr) {
    text += fmt::format(" Not {} either, which leaves {:.1f} %.", phrase(other->candidate), 100.0 * other->held_out_ratio);
  }
  return text;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                \
  template std::string verdict_of<Family>(const Dataset&, const SearchResult<Family>&);            \
  template std::string sentence_of<Family>(const std::string&, const SearchResult<Family>&, bool); \
  template std::string what_it_is_not<Family>(const SearchResult<Family>&);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
