// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/latent/form_regression.hpp"

namespace hotfire::explain {

/// A form with what it scored.
struct ScoredForm {
  Form form;
  FormScore score;
};

/// The forms of the grammar that explain most of what a model leaves, at one place: at most `most` of them, of different
/// arguments or memories, the best first. Every memory of every argument is screened over a comb of its parameter, with
/// its output and the size of its output as regressors; then curves are laid over the best, and their parameters are
/// refined.
std::vector<ScoredForm> search_forms(const FormRegression& regression, const LatentPlace& place, std::size_t most,
                                     unsigned threads);

/// The forms that replace the signal of their site by what a memory makes of it, one for each memory of `found`: the
/// memory's output is added and the signal itself subtracted. A regression finds less of both where a loop follows what is
/// missing.
std::vector<ScoredForm> replacing(const std::vector<ScoredForm>& found);

/// Forms that were found at other places, scored at this one. The screening at one place may miss a law that it finds at a
/// place which the records hardly separate from it. Each memory's parameter is refined here. Forms that `here` already has
/// are left out.
std::vector<ScoredForm> moved_forms(const FormRegression& regression, const LatentPlace& place,
                                    const std::vector<ScoredForm>& elsewhere, const std::vector<ScoredForm>& here,
                                    unsigned threads);

}  // namespace hotfire::explain
