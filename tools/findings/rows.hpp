#pragma once

#include "tools/findings/finding.hpp"

namespace hotfire::findings {

Outcome piston_zeros(const Sets& sets);
Outcome laboratory_notch(const Sets& sets);
Outcome locked_pendulum(const Sets& sets);
Outcome quiescent_peaks(const Sets& sets);
Outcome ambient_sweep(const Sets& sets);
Outcome ambient_step(const Sets& sets);
Outcome hot_fire_sweep(const Sets& sets);
Outcome hot_fire_step(const Sets& sets);
Outcome notch_and_gimbal(const Sets& sets);
Outcome friction_vector(const Sets& sets);
Outcome friction_under_vibration(const Sets& sets);
Outcome lugre_reference(const Sets& sets);
Outcome stiffness_by_location(const Sets& sets);
Outcome string_potentiometers(const Sets& sets);
Outcome static_or_dynamic(const Sets& sets);

}  // namespace hotfire::findings
