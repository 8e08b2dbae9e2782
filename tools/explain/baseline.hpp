// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/explain/inference/black_box.hpp"

namespace hotfire::explain {

/// What the best linear black box reaches on the rows that are held out, beside the explained model: per channel order,
/// delay [s] and errors, and a sentence that says which is better. Where the black box is, something is missing from the
/// explained model: the sentence names the band of frequency and the amplitude at which the two differ most. Null where
/// there is no black box.
nlohmann::json baseline_json(const BlackBox& box, const Dataset& data, const Prediction& explained);

/// Adds its errors to those of the models on one held-out record, as "black_box".
void add_baseline(const BlackBox& box, const Dataset& record, nlohmann::json& channels);

}  // namespace hotfire::explain
