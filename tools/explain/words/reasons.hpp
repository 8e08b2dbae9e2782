// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace hotfire::explain::words {

/// Reasons of the search without a figure: the column `reason` of `search` in report.json. Those that begin with a
/// punctuation mark or follow a label are parts of a sentence.
enum class Reason {
  not_screened,
  no_lower_criterion,
  behind_finalists,
  superfluous_newest,
  superfluous_earlier,
  beside_unlisted,
  falls_as_it_rises,
  feeds_energy,
  tied_site,
  not_clearly_less,
  rest_of_term,
  leaves_more,
  more_than_compensation,
  more_than_signal,
  other_hypothesis,
  saves_signal,
  interrupted_refined,
  interrupted_screened,
  interrupted_before
};
inline constexpr std::size_t kReasons = 19;
std::string_view text(Reason reason) noexcept;

/// How a law compares with another one of the same effect, whose label follows.
enum class LawChange { simpler, richer, rival_better, rival_tied, rival_separated };
inline constexpr std::size_t kLawChanges = 5;
std::string text(LawChange change, const std::string& other);

/// Shares are of one, not percent.
std::string lowers(double share_of_error, double criterion);
std::string changes_too_little(double share_of_error, double criterion);
std::string is_better(const std::string& label, double criterion);
std::string is_tied(const std::string& label, double criterion);
std::string leaves(double share_of_error);
/// The same where the held-out error of the other model is that of noise, of which nothing can be explained.
std::string leaves_noise(double share_of_error);
std::string leaves_far_above_noise(double share_of_error);
std::string replaces_listed(double share_left_by_listed);
std::string explained_by_signal(const std::string& sites);
/// Of a term of unknown law.
std::string has_a_law(const std::string& label);
std::string is_revised(const std::string& term, const std::string& listed);
/// Of a listed effect.
std::string imitates(const std::string& label);

/// Why a model with an effect is refused although its error as a whole is smaller.
std::string worse_record(const std::string& record, double share, const std::string& channel);
std::string worse_band(const std::string& channel, double share, double from, double to);
std::string refused(const std::string& harm);

}  // namespace hotfire::explain::words
