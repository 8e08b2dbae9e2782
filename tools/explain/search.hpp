#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/explain/assessed.hpp"
#include "tools/explain/next_experiment.hpp"
#include "tools/explain/screening.hpp"

namespace hotfire::explain {

/// Two candidates whose BIC differs by less than this are not told apart by the data.
inline constexpr double kTied = 10.0;

/// One candidate in one round, and what became of it.
struct Trial {
  int round = 0;
  Candidate candidate;
  bool refined = false;          ///< fitted jointly with everything else
  double delta_criterion = 0.0;  ///< BIC with it minus without it (negative is better)
  double held_out_ratio = 1.0;   ///< held-out error with it over without it; 1 if not refined
  double seconds = 0.0;
  std::string decision;  ///< "kept", "dropped", "taken out"
  std::string reason;
};

/// An effect the search kept, with what it reached when it was added and the other effects tried in its place, best first.
struct Kept {
  Trial trial;
  std::vector<Trial> alternatives;
};

template <class Family>
struct SearchResult {
  Assessed<Family> declared;
  Assessed<Family> calibrated;
  Assessed<Family> explained;
  std::vector<Kept> kept;
  std::vector<Trial> trials;
  std::optional<Rival<Family>> rival;  ///< of the effect kept last
  bool interrupted = false;
};

struct SearchOptions {
  unsigned threads = 1;
  int most_effects = 4;
  Watch watch;
};

/// True if every channel's residual is noise but for a part that the sensor could not show.
bool reaches_noise(const Dataset& data, const Prediction& prediction);

/// "gimbal_friction (lugre)".
std::string label(const Candidate& candidate);

/// Calibrates the declared model within its tolerances, then adds effects one by one while the data support them: every
/// candidate is screened, the best are fitted jointly with everything else, and one is kept if it lowers the BIC and the
/// error on held-out blocks. An effect that a later one makes superfluous is taken out again.
template <class Family>
SearchResult<Family> search(const Dataset& data, const ModelFile& model, const SearchOptions& options);

extern template SearchResult<SimplexFamily> search(const Dataset&, const ModelFile&, const SearchOptions&);
extern template SearchResult<DirectFamily> search(const Dataset&, const ModelFile&, const SearchOptions&);

}  // namespace hotfire::explain
