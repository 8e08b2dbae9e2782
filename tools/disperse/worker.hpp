// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>

#include "tools/disperse/dispersion.hpp"

namespace hotfire::disperse {

/// Runs the draws that another program hands out, one after the other. It first writes the line of the inputs, and a line
/// with the number of the draws and the draws that have a result. It then reads lines:
///   NUMBER    run this draw if it has no result; write the line of its result
///   a line of another worker, as that one wrote it    take its result, or refuse its inputs; write nothing
///   report    end
/// Returns true if a report is asked for; false if the lines end without. `progress(done, all)` is called after each result.
/// Throws as Dispersion::run and DrawStore::merge do, and UsageError for a number that is no draw.
bool work(Dispersion& dispersion, const CommandRunner& run, const std::function<void(int, int)>& progress, std::istream& in,
          std::ostream& out);

}  // namespace hotfire::disperse
