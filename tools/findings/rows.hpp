// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/findings/finding.hpp"

namespace hotfire::findings {

Outcome piston_zeros(const Bench& bench);
Outcome laboratory_notch(const Bench& bench);
Outcome locked_pendulum(const Bench& bench);
Outcome quiescent_peaks(const Bench& bench);
Outcome ambient_sweep(const Bench& bench);
Outcome ambient_step(const Bench& bench);
Outcome hot_fire_sweep(const Bench& bench);
Outcome hot_fire_step(const Bench& bench);
Outcome notch_and_gimbal(const Bench& bench);
Outcome friction_vector(const Bench& bench);
Outcome friction_under_vibration(const Bench& bench);
Outcome stiffness_by_location(const Bench& bench);
Outcome string_potentiometers(const Bench& bench);
Outcome lugre_reference(const Bench& bench);
Outcome static_or_dynamic(const Bench& bench);
Outcome lag_and_lead(const Bench& bench);
Outcome one_axis_alone(const Bench& bench);
Outcome thrust_and_friction(const Bench& bench);
Outcome one_file(const Bench& bench);
Outcome engine_phase(const Bench& bench);
Outcome low_frequency(const Bench& bench);

}  // namespace hotfire::findings
