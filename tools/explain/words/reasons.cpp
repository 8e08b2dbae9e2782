// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/words/reasons.hpp"

#include <fmt/format.h>

namespace hotfire::explain::words {

std::string_view text(Reason reason) noexcept {
  constexpr std::array<std::string_view, kReasons> texts{
      "not fitted: none of its simpler laws was a finalist",
      "does not lower the BIC",
      "ranked below the finalists in screening",
      "removed: the error is the same without it",
      "the model is as good without it since a later effect was added",
      "explains little in addition to a term of unknown law",
      ", but its signal falls where it should rise",
      ", but its friction adds energy",
      ", as much as the term that is kept at another site",
      ": not clearly less",
      ", more than noise at the site of a term of unknown law",
      ", more than the term of unknown law",
      ", more than the calibration beyond its tolerances",
      ", more than a signal at another site",
      "; another hypothesis is kept",
      "saves an unknown signal most",
      "fitted jointly before the search was interrupted; other candidates were not",
      "screened before the search was interrupted",
      "not fitted before the search was interrupted"};
  return texts[static_cast<std::size_t>(reason)];
}

std::string text(LawChange change, const std::string& other) {
  constexpr std::array<std::string_view, kLawChanges> texts{
      "is preferred, because the data determine all its parameters, unlike",
      "is better, after a later effect was added, than",
      "explains more, after a later effect was added, than",
      "with the later effects added, it explains as much as",
      "before a later effect was added, it explained as much as",
  };
  return fmt::format("{} {}", texts[static_cast<std::size_t>(change)], other);
}

std::string lowers(double share_of_error, double criterion) {
  return fmt::format("lowers the held-out error by {:.1f} % and the BIC by {:.0f}", 100.0 * share_of_error, criterion);
}

std::string changes_too_little(double share_of_error, double criterion) {
  return fmt::format("changes the held-out error by {:+.2f} % and the BIC by {:+.0f}: too little", 100.0 * share_of_error,
                     criterion);
}

std::string is_better(const std::string& label, double criterion) {
  return fmt::format("{} is better by {:.0f} in BIC", label, criterion);
}

std::string is_tied(const std::string& label, double criterion) {
  return fmt::format("the data do not separate it from {}: the BIC differs by {:+.1f}", label, criterion);
}

std::string leaves(double share_of_error) {
  return fmt::format("leaves {:.1f} % of the held-out error", 100.0 * share_of_error);
}

std::string leaves_noise(double share_of_error) { return leaves(share_of_error) + ", which is mostly noise"; }

std::string leaves_far_above_noise(double share_of_error) {
  return fmt::format("leaves {:.0f} % of the held-out error, far above the noise", 100.0 * share_of_error);
}

std::string replaces_listed(double share_left_by_listed) {
  return fmt::format("; the listed effects leave {:.1f} % and are removed", 100.0 * share_left_by_listed);
}

std::string has_a_law(const std::string& label) { return fmt::format("{} leaves as little", label); }

std::string is_revised(const std::string& term, const std::string& listed) {
  return fmt::format("{} and {} together leave clearly less", term, listed);
}

std::string imitates(const std::string& label) {
  return fmt::format("what it leaves acts at its own site, where {} leaves clearly less", label);
}

std::string explained_by_signal(const std::string& sites) {
  return fmt::format("one unknown signal at {} explains the records down to the noise", sites);
}

std::string worse_record(const std::string& record, double share, const std::string& channel) {
  return fmt::format("the error in {} is {:.0f} % larger on held-out rows ({})", record, 100.0 * share, channel);
}

std::string worse_band(const std::string& channel, double share, double from, double to) {
  return fmt::format("the error of {} is {:.0f} % larger between {:.3g} and {:.3g} Hz", channel, 100.0 * share, from, to);
}

std::string refused(const std::string& harm) { return "refused: " + harm; }

}  // namespace hotfire::explain::words
