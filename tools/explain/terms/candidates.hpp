// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/explain/fit/scales.hpp"

namespace hotfire::explain {

/// An effect in one of its variants (law or channel), as the finder may add it.
struct Candidate {
  std::size_t effect = 0;  ///< position in the plant's effect list
  int option = 0;
  std::string name;            ///< "gimbal_friction"
  std::string option_name;     ///< "lugre"; empty if the effect has nothing to choose
  std::string site;            ///< "engine_torque", "sensor.engine"
  std::vector<int> choices{};  ///< what else the effect has to choose, in its order; empty: its defaults
};

/// Every variant of every effect of `plant` that the finder tries, whatever its values: all but tables (a table is what
/// `unlisted` is for) and sensor variants of channels that no record has.
std::vector<Candidate> all_candidates(const ModelParameters& plant, const Dataset& data);

/// The laws of a candidate's effect at the same site, its own among them.
std::vector<Candidate> laws_of(const ModelParameters& plant, const Dataset& data, const Candidate& candidate);

/// False for an effect that carries another one (`Effect` in model/declaration/effect.hpp) which is not active.
bool has_what_it_carries(const ModelParameters& parameters, const Candidate& candidate);

/// Those of `all_candidates` that can act beside what is active, at sites whose load is not measured.
std::vector<Candidate> candidates_beside(const ModelParameters& plant, const Dataset& data);

/// True if a candidate's effect is active in these parameters with the candidate's law.
bool has_law(const ModelParameters& parameters, const Candidate& candidate);

/// The declared parameters, of parts and of active effects, that have a tolerance, in the order of the model's keys.
std::vector<FreeParameter> declared_parameters(const ModelParameters& base, const std::map<std::string, double>& tolerance);

/// The parameters of an effect that its variant uses.
std::vector<FreeParameter> effect_parameters(const ModelParameters& base, const Candidate& candidate, const Scales& scales);

/// Initial position and velocity of every experiment that does not start at rest, with what its first rows say of them as
/// prior.
std::vector<FreeParameter> initial_states(const Dataset& data, const Scales& scales, std::vector<double>& u);

/// Points at which to start the fit of an effect, in coordinates: a quasi-random cover of the fields' typical values, times
/// and over four, with both signs where a value may be negative; a frequency starts at those given. One positive value
/// alone starts on a comb of its logarithm.
std::vector<std::vector<double>> start_points(const std::vector<FreeParameter>& own, const std::vector<double>& frequencies);

/// Activates a candidate's effect in parameters, with its option.
void activate(ModelParameters& parameters, const Candidate& candidate);

}  // namespace hotfire::explain
