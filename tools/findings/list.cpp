#include <algorithm>
#include <array>

#include "tools/findings/finding.hpp"
#include "tools/findings/rows.hpp"

namespace hotfire::findings {

namespace {

constexpr std::array kFindings{
    Finding{"F1", "piston zeros [SD eq. 1-2]", "notch of a linear sine sweep within 0.5 % of the analytic zero",
            "hotfire findings --only F1", piston_zeros},
    Finding{"F2", "amplitude-dependent notch in the laboratory [SD fig. 3-5, eq. 4-7]",
            "five amplitudes: the frequency rises to the linear asymptote, simulation and eq. 7 within 5 %",
            "hotfire stiffness --model tools/findings/sets/lab.toml --from 6 --to 13", laboratory_notch},
    Finding{"F3", "pendulum at 6.75 Hz against 7.5 to 8 Hz predicted [SD 2.2]",
            "hammer test on a locked actuator, linear and soft stiffness",
            "hotfire hammer --model tools/findings/sets/ambient.toml --impulse 40 --seconds 1", locked_pendulum},
    Finding{"F4", "quiescent piston peaks at 5.9 to 8.2 Hz [SD fig. 7]",
            "powered, uncommanded, ambient excitation, dead bands",
            "hotfire quiescent --model tools/findings/sets/ambient.toml --torque-density 1000", quiescent_peaks},
    Finding{"F5", "load resonance near 6.5 Hz at ambient [GF slide Results]", "Green Run sine profile at ambient",
            "hotfire sweep --model tools/findings/sets/ambient.toml", ambient_sweep},
    Finding{"F6", "ambient step underdamped, more overshoot with the soft stiffness [SD fig. 9]",
            "steps of 0.6, 0.4, 0.2 deg", "hotfire step --model tools/findings/sets/ambient.toml", ambient_step},
    Finding{"F7", "hot fire: 9.5 Hz, gain loss and lag at 1 to 6 Hz, amplitude-dependent [GF]",
            "Green Run sine profile, friction on and off", "hotfire sweep --model tools/findings/sets/hot-fire.toml",
            hot_fire_sweep},
    Finding{"F8", "hot-fire step: damped, hesitation, depends on amplitude and direction [GF]", "steps at hot fire",
            "hotfire step --model tools/findings/sets/hot-fire.toml", hot_fire_step},
    Finding{"F9", "friction on a rigid gimbal removes the notch, compliance restores it [SD fig. 12]",
            "notch depth against its upper shoulder under 3 dB, then over 6 dB", "hotfire findings --only F9",
            notch_and_gimbal},
    Finding{"F10", "two-axis friction vector: motion in yaw lowers friction in pitch [GF slide Multi-Axis Modeling]",
            "the ratio follows v_pitch over the speed within 3 %", "hotfire findings --only F10", friction_vector},
    Finding{"F11", "vibration lowers friction at low speed, more at higher frequency [GF slide Vibration]",
            "closed forms within 3 %", "hotfire findings --only F11", friction_under_vibration},
    Finding{"F12", "load stiffness by location [SD fig. 11]",
            "notch-derived against modal integral at eight locations, within 2 %", "hotfire findings --only F12",
            stiffness_by_location},
    Finding{"F13", "string potentiometers: four an engine, affine fit to settled static angles [SD 2.3]",
            "recovers both angles; the error grows with placement error and with structure motion",
            "hotfire findings --only F13", string_potentiometers},
    Finding{"F14", "LuGre reference figures of the 1995 set", "within 1 %", "hotfire findings --only F14", lugre_reference},
    Finding{"F15", "many modes, none dominant; static or dynamic structure gives the same notch [SD fig. 2]",
            "notch within 2 % between the two", "hotfire findings --only F15", static_or_dynamic},
};

}  // namespace

bool Outcome::inside() const {
  return std::all_of(figures.begin(), figures.end(), [](const Figure& figure) { return figure.inside(); });
}

Sets load_sets(const std::filesystem::path& folder) {
  return {folder, load_model(folder / "lab.toml"), load_model(folder / "ambient.toml"),
          load_model(folder / "hot-fire.toml")};
}

std::span<const Finding> all_findings() { return kFindings; }

Figure near(std::string what, double value, double expected, double relative, std::string unit) {
  return {std::move(what), value, expected * (1.0 - relative), expected * (1.0 + relative), std::move(unit)};
}

}  // namespace hotfire::findings
