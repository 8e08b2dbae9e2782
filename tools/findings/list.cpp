// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "tools/findings/finding.hpp"
#include "tools/findings/rows.hpp"

namespace hotfire::findings {

namespace {

constexpr std::array kFindings{
    Finding{"F1",
            "piston zeros [SD eq. 1-2]",
            "notch of a linear sine sweep within 0.5 % of the analytic zero",
            "hotfire findings --only F1",
            piston_zeros,
            {Physics::load_spring}},
    Finding{"F2",
            "amplitude-dependent notch in the laboratory [SD fig. 3-5, eq. 4-7]",
            "five amplitudes: the frequency rises to the linear asymptote, simulation and eq. 7 within 5 %",
            "hotfire stiffness --model tools/findings/sets/lab.toml --from 6 --to 13",
            laboratory_notch,
            {Physics::soft_stiffness}},
    Finding{"F3",
            "pendulum at 6.75 Hz against 7.5 to 8 Hz predicted [SD 2.2]",
            "hammer test on locked actuators without thrust, linear and soft stiffness",
            "hotfire hammer --model tools/findings/sets/core-stage.toml --thrust 0 --axis pitch --impulse 168 --seconds 1",
            locked_pendulum,
            {Physics::soft_stiffness, Physics::friction}},
    Finding{"F4",
            "quiescent piston peaks at 5.9 to 8.2 Hz [SD fig. 7]",
            "powered, uncommanded, ambient excitation: the peak moves by more than its own width",
            "hotfire quiescent --model tools/findings/sets/core-stage.toml --thrust 0 --axis pitch --torque-density 1000",
            quiescent_peaks,
            {Physics::friction}},
    Finding{"F5",
            "load resonance near 6.5 Hz at ambient, seen in the piston [SD 2.3, GF slide Results]",
            "stepped sines of one amplitude, grid finer than 1 %",
            "hotfire sweep --model tools/findings/sets/core-stage.toml --thrust 0 --axis pitch --profile sines --from 5.2 "
            "--to 10.5 --count 90",
            ambient_sweep,
            {Physics::unloaded_structure, Physics::load_spring}},
    Finding{"F6",
            "ambient step underdamped, more overshoot with the soft stiffness [SD fig. 9]",
            "steps of 0.6, 0.4, 0.2 deg without thrust",
            "hotfire step --model tools/findings/sets/core-stage.toml --thrust 0 --axis pitch",
            ambient_step,
            {Physics::soft_stiffness}},
    Finding{"F7",
            "hot fire: 9.5 Hz, gain loss and lag at 1 to 6 Hz, amplitude-dependent [GF]",
            "Green Run profile on both axes at once, friction on and off",
            "hotfire sweep --model tools/findings/sets/core-stage.toml --axis pitch --profile green-run-both",
            hot_fire_sweep,
            {Physics::friction, Physics::load_spring}},
    Finding{"F8",
            "hot-fire step: damped, hesitation, depends on amplitude and direction [GF]",
            "steps at hot fire",
            "hotfire step --model tools/findings/sets/core-stage.toml --axis pitch",
            hot_fire_step,
            {Physics::friction}},
    Finding{"F9",
            "friction on a rigid gimbal takes the notch away, compliance restores it [SD fig. 12]",
            "notch depth against its upper shoulder, as shipped and with the friction that it takes, mu 0.18",
            "hotfire findings --only F9",
            notch_and_gimbal,
            {Physics::bearing_compliance, Physics::friction}},
    Finding{"F10",
            "two-axis friction vector: motion in yaw lowers friction in pitch [GF slide Multi-Axis Modeling]",
            "the ratio follows v_pitch over the speed within 3 %",
            "hotfire findings --only F10",
            friction_vector,
            {Physics::friction_vector}},
    Finding{"F11",
            "vibration lowers friction at low speed; by frequency it depends on what is kept equal [GF slide Vibration]",
            "closed forms and the gamma2 law within 3 %, LuGre in the plant under imposed slip and imposed torque",
            "hotfire findings --only F11",
            friction_under_vibration,
            {Physics::vibration}},
    Finding{"F12",
            "load stiffness by location, and how far the notch gives it [SD fig. 11]",
            "notch-derived against modal integral at eight locations, a third of the flexibility in modes",
            "hotfire findings --only F12",
            stiffness_by_location,
            {Physics::modes}},
    Finding{"F13",
            "string potentiometers: four an engine, affine fit to settled static angles [SD 2.3]",
            "recovers both angles; the error grows with what the fit cannot take up",
            "hotfire findings --only F13",
            string_potentiometers,
            {Physics::string_motion}},
    Finding{"F14",
            "LuGre reference figures of the 1995 set",
            "within 1 %",
            "hotfire findings --only F14",
            lugre_reference,
            {Physics::stribeck}},
    Finding{"F15",
            "many modes, none dominant: how far static and dynamic structure give the same notch [SD fig. 2]",
            "notch of both at eight locations, a third of the flexibility in modes",
            "hotfire findings --only F15",
            static_or_dynamic,
            {Physics::modes}},
    Finding{"F16",
            "the phase that friction adds to the piston turns from lag to lead, by frequency and amplitude [GF slide "
            "Matching GRHF]",
            "Green Run profile and sines of two amplitudes at hot fire, friction on and off",
            "hotfire findings --only F16",
            lag_and_lead,
            {Physics::friction}},
    Finding{"F17",
            "a test of one axis alone overstates what friction does in the test of both [GF slide Multi-Axis Modeling]",
            "Green Run profile with yaw and without",
            "hotfire findings --only F17",
            one_axis_alone,
            {Physics::friction_vector, Physics::friction}},
    Finding{"F18",
            "friction follows the thrust: mu N r",
            "zero, half and full thrust in one run differ by it within 1 %",
            "hotfire findings --only F18",
            thrust_and_friction,
            {Physics::friction_follows_load, Physics::misalignment}},
    Finding{"F19",
            "load resonance from 6.5 Hz to 9.5 Hz [GF slide Results], by one file and its thrust",
            "notch of one sweep without and under full thrust",
            "hotfire findings --only F19",
            one_file,
            {Physics::unloaded_structure}},
    Finding{"F20",
            "the engine's phase above the notch is shaped by the structure's modes [GF slide Matching GRHF]",
            "engine of the stage with the modes' dynamics and with their static flexibility",
            "hotfire findings --only F20",
            engine_phase,
            {Physics::modes}},
};

}  // namespace

bool Outcome::inside() const {
  return std::all_of(figures.begin(), figures.end(), [](const Figure& figure) { return figure.inside(); });
}

std::span<const Finding> all_findings() { return kFindings; }

Figure near(std::string what, double value, double expected, double relative, std::string unit) {
  return {std::move(what), value, expected * (1.0 - relative), expected * (1.0 + relative), std::move(unit)};
}

}  // namespace hotfire::findings
