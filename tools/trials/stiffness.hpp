// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/analysis/equivalent_stiffness.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

/// The engine on its load spring, as a model declares it.
struct LoadSpring {
  analysis::LoadResonance load;
  analysis::SpringCurve actuator;  ///< force over deflection of the actuator alone: its `soft_stiffness`, or K_act
  double loaded = 0.0;             ///< what the actuator's stiffness comes to under a large load [N/m]
};

/// The load spring of a hydraulic axis. Throws FileError for a topology without one.
LoadSpring load_spring_of(const ModelFile& model);

/// The load spring of one axis of a vehicle. K_L is what is local to the attach point in series with the modal integral
/// there, sum phi^2 / w^2 and residual; R is the arm at zero angles. A gimbal bearing that gives way and what the other
/// axes' actuators hold are left out. Throws UsageError for an axis the model has not.
LoadSpring load_spring_of(const VehicleFile& model, const std::string& axis);

/// What a load resonance says of the stiffness.
struct ResonanceStiffness {
  double frequency = 0.0;   ///< [Hz]
  double peak_force = 0.0;  ///< of the sine at that frequency, with the amplitude that is commanded [N] [SD eq. 4-5]
  double total = 0.0;       ///< K_T [N/m] [SD eq. 2, 10]
  double actuator = 0.0;    ///< K_act, what K_T leaves beside K_L [N/m] [SD eq. 3, 9]; infinite if K_T is no softer than K_L
};

/// The equivalent stiffness under sines of one amplitude.
struct SineStiffness {
  double amplitude = 0.0;                  ///< of the command [rad]
  std::optional<ResonanceStiffness> test;  ///< from the piston's notch; none if there is no notch in the band
  ResonanceStiffness expected;             ///< from the model's force curve [SD eq. 4-7]
};

/// Equivalent stiffness by amplitude from the responses of a stepped sine: the piston's notch is at its zeros, the load
/// resonance [SD eq. 1-2]. `bias` is the load of the actuator that the sines swing about [N]. Empty for a broadband command,
/// whose amplitude is not that of a sine.
std::vector<SineStiffness> sine_stiffnesses(const std::vector<ChannelSweep>& sweeps, const LoadSpring& spring,
                                            double bias = 0.0);

/// What the force curve expects of sines of an amplitude [rad] about a bias load of the actuator [N] [SD eq. 4-7].
ResonanceStiffness expected_stiffness(const LoadSpring& spring, double amplitude, double bias = 0.0);

/// The load resonance with the actuator as stiff as under a large load [Hz]: what `expected_stiffness` rises to.
double asymptote(const LoadSpring& spring);

}  // namespace hotfire::trials
