// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <vector>

#include "model/keys.hpp"
#include "tools/analysis/step_response.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/findings/finding.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::findings {

/// The axis that a test of one axis drives.
inline const std::string kPitch = "pitch";

/// The parameters of a set of one hydraulic axis. Throws FileError for any other topology.
SimplexParameters& axis_of(ModelFile& model);

/// Switches effect E of an axis on or off, and returns nothing if the axis does not know it.
template <class E, class Parameters>
void set_active(Parameters& parameters, bool active) {
  model::visit_effects(parameters, [&]<class Own>(std::size_t index, auto&) {
    if constexpr (std::is_same_v<Own, E>) {
      parameters.effects.active[index] = active;
    }
  });
}

/// The parameters of effect E.
template <class E, class Parameters>
typename E::template Params<double>& effect_of(Parameters& parameters) {
  typename E::template Params<double>* found = nullptr;
  model::visit_effects(parameters, [&]<class Own>(std::size_t, auto& values) {
    if constexpr (std::is_same_v<Own, E>) {
      found = &values;
    }
  });
  return *found;
}

/// The model without any effect: the declared linear parts, saturation and the root of the flow law.
ModelFile without_effects(ModelFile model);

/// Runs stepped sines on a model and analyses them.
std::vector<trials::ChannelSweep> swept(const ModelFile& model, const std::vector<double>& command, double lowest,
                                        double highest);

/// Runs stepped sines on one axis of a vehicle, the others uncommanded, and analyses them.
std::vector<trials::ChannelSweep> swept(const VehicleFile& model, const std::string& axis,
                                        const std::vector<double>& command, double lowest, double highest);

/// The Green Run profile on both axes of an engine at once: the responses of piston and engine of one axis, both amplitudes
/// joined. `record` is what `simulate` gives for `trials::green_run_record`.
struct GreenRun {
  trials::ChannelSweep piston;
  trials::ChannelSweep engine;
};
GreenRun green_run(const VehicleFile& model, const Record& record, const std::string& axis);

/// Steps of 0.6, 0.4 and 0.2 deg on pitch, each held for 2 s.
Record pitch_steps();

/// The response of the engine to each step of `command`, which is `pitch_steps`.
std::vector<analysis::StepResponse> engine_steps(const Record& command, const Record& response);

/// A notch that decides a row [Hz].
double notch_of(const trials::ChannelSweep& sweep);

/// Phase of a response at the point nearest to a frequency less that of another, within half a turn [deg].
double phase_between(const trials::ChannelSweep& sweep, const trials::ChannelSweep& other, double frequency);

/// Gain of a response at the point nearest to a frequency over that of another [dB].
double gain_between(const trials::ChannelSweep& sweep, const trials::ChannelSweep& other, double frequency);

/// The point of a response that is nearest to a frequency.
const analysis::ResponsePoint& nearest(const trials::ChannelSweep& sweep, double frequency);

}  // namespace hotfire::findings
