// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/study/draws/wild_draw.hpp"

namespace hotfire::study {
namespace {

constexpr std::array<std::string_view, kWildSites> kSites{"command",       "valve_command", "valve",       "flow",
                                                          "pressure",      "piston",        "load_spring", "engine_torque",
                                                          "sensor.piston", "sensor.engine"};

/// A shifted command is a shifted null of the torque motor, and to a few milliseconds a shifted spool and a further flow; a
/// flow is a pressure rate.
constexpr std::array<std::string_view, kWildSites> kRight{"command|valve_command",
                                                          "command|valve_command|valve|flow",
                                                          "valve_command|valve|flow",
                                                          "valve_command|valve|flow|pressure",
                                                          "flow|pressure",
                                                          "piston",
                                                          "load_spring|structure",
                                                          "engine_torque",
                                                          "sensor.piston|sensor",
                                                          "sensor.engine|sensor"};

constexpr std::array<std::string_view, kWildArguments> kArguments{"position", "rate",  "angle",         "angle rate",
                                                                  "pressure", "flow",  "deflection",    "spool",
                                                                  "command",  "error", "valve command", "time"};

std::string words_of_curve(const WildCurve& curve) {
  const auto first = [&](std::size_t i) { return curve.parts.front()[i]; };
  switch (curve.shape) {
    case WildCurve::Shape::line:
      return "";
    case WildCurve::Shape::waves: {
      const auto all_zero = [&](std::size_t i) {
        return std::all_of(curve.parts.begin(), curve.parts.end(), [&](const auto& part) { return part[i] == 0.0; });
      };
      return all_zero(1) ? "odd waves of " : all_zero(0) ? "even waves of " : "waves of ";
    }
    case WildCurve::Shape::bumps:
      return "bumps over ";
    case WildCurve::Shape::odd_power:
      return fmt::format("odd power {:.2f} of ", first(0));
    case WildCurve::Shape::even_power:
      return fmt::format("even power {:.2f} of ", first(0));
    case WildCurve::Shape::saturation:
      return fmt::format("saturation at {:.2f} of ", first(0));
    case WildCurve::Shape::dead_zone:
      return fmt::format("dead zone of {:.2f} of ", first(0));
    case WildCurve::Shape::one_sided:
      return fmt::format("one-sided, from {:.2f} of ", first(1));
    case WildCurve::Shape::ripple:
      return fmt::format("ripple over ");
    case WildCurve::Shape::stairs:
      return fmt::format("steps of {:.2f} of ", first(0));
  }
  return "";
}

std::string words_of_memory(const WildMemory& memory) {
  switch (memory.kind) {
    case WildMemory::Kind::none:
      return "";
    case WildMemory::Kind::delay:
      return fmt::format("{:.0f} ms late", 1e3 * memory.time);
    case WildMemory::Kind::first_order:
      return fmt::format("low-passed ({:.3g} s)", memory.time);
    case WildMemory::Kind::washout:
      return fmt::format("washed out ({:.3g} s)", memory.time);
    case WildMemory::Kind::second_order:
      return fmt::format("second order ({:.1f} Hz, {:.2f})", memory.frequency, memory.damping);
    case WildMemory::Kind::band_pass:
      return fmt::format("band-passed ({:.1f} Hz, {:.2f})", memory.frequency, memory.damping);
    case WildMemory::Kind::plays:
      return fmt::format("through {} plays", memory.plays.size());
    case WildMemory::Kind::stops:
      return fmt::format("through {} stops", memory.plays.size());
    case WildMemory::Kind::rate_limit:
      return fmt::format("rate-limited ({:.2g}/s)", memory.limit);
    case WildMemory::Kind::hold:
      return fmt::format("held for {} rows", memory.rows);
    case WildMemory::Kind::leaky_integral:
      return fmt::format("integrated with a leak ({:.1f} s)", memory.time);
    case WildMemory::Kind::swing:
      return fmt::format("as a swing at {:.1f} Hz that moves by {:.0f} %", memory.frequency, 100.0 * memory.damping);
  }
  return "";
}

}  // namespace

std::string_view right_sites(const WildLaw& law) { return kRight[static_cast<std::size_t>(law.site)]; }

std::string words_of(const WildLaw& law) {
  std::string argument(kArguments[static_cast<std::size_t>(law.argument)]);
  if (law.factor) {
    argument += fmt::format(" x {}", kArguments[static_cast<std::size_t>(*law.factor)]);
  }
  const std::string curve = words_of_curve(law.curve);
  const std::string memory = words_of_memory(law.memory);
  std::string text = fmt::format("{}: {}", kSites[static_cast<std::size_t>(law.site)], law.replaces ? "instead, " : "");
  if (memory.empty() || law.curve_first) {
    text += curve + argument + (memory.empty() ? "" : ", ") + memory;
  } else {
    text += curve + (curve.empty() ? argument + ", " + memory : "(" + argument + ", " + memory + ")");
  }
  return text;
}

}  // namespace hotfire::study
