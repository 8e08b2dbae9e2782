// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/explain/result/result.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// True of an effect that is a fault of the record, not of the plant: a channel that is mis-scaled or late.
bool is_fault_of_record(const Candidate& candidate);

/// True for a term over the time of the record, alone or times another quantity: it says what drifted, and means nothing in
/// another run. An oscillation is not one.
bool is_of_record_time(const Candidate& candidate);

/// True of such a term if it has a mean over the records: a table over time alone.
bool has_mean_over_time(const ModelParameters& parameters, const Candidate& candidate);

/// The verdict of a search (docs/report.md). It is undecided if nothing is kept, more than noise is left, and the search was
/// interrupted or not asked for.
Verdict verdict_of(const Dataset& data, const SearchResult& found);

/// What was found, in one sentence or two. Errors are in times of the noise where that is known of every channel.
std::string sentence_of(Verdict verdict, const SearchResult& found, bool noise_is_known = true);

/// What the term of unknown law that was kept is not: the listed effect and the other such terms that came closest, and what
/// they leave.
std::string what_it_is_not(const SearchResult& found);

}  // namespace hotfire::explain
