// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/inference/black_box.hpp"
#include "tools/explain/result/result.hpp"

namespace hotfire::explain {

/// What the best linear black box reaches on the rows that are held out, beside the explained model: per channel order,
/// delay [s] and errors, and a sentence that says which is better. Where the black box is, something is missing from the
/// explained model: the sentence names the band of frequency and the amplitude at which the two differ most. None where
/// there is no black box.
std::optional<Baseline> baseline_of(const BlackBox& box, const Dataset& data, const Prediction& explained);

/// Adds its errors to those of the models on one held-out record.
void add_baseline(const BlackBox& box, const Dataset& record, std::vector<ChannelErrors>& channels);

}  // namespace hotfire::explain
