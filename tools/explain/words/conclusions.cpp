// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/words/conclusions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace hotfire::explain::words {

std::string size_of(const HeldOutError& error) {
  return error.noise_is_known ? fmt::format("{:.1f} times the noise", error.model)
                              : fmt::format("{:.3g} % of the declared model's error", 100.0 * error.model / error.declared);
}

std::string fall_of(const HeldOutError& error) {
  // Times a floor that is no size of the sensor says nothing.
  return error.noise_is_known
             ? fmt::format("from {:.1f} to {:.2f} times the noise", error.declared, error.model)
             : fmt::format("to {:.3g} % of the declared model's error", 100.0 * error.model / error.declared);
}

std::string spoken(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string listed(const std::vector<std::string>& names, std::string_view conjunction) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? fmt::format(" {} ", conjunction) : ", ") + names[i];
  }
  return text;
}

std::string of_axis(const std::string& axis, const std::string& text) { return fmt::format("{} axis: {}", axis, text); }

std::string nothing_missing(double times_noise) {
  return fmt::format(
      "No effect is missing. The declared model reaches the sensor noise within its tolerances: its error on held-out data "
      "is {:.2f} times the noise.",
      times_noise);
}

std::string wrong_declaration(double times_noise, const std::string& key, double tolerances) {
  return fmt::format(
      "No missing effect is identified, but a declared value appears to be wrong. The model reaches the sensor noise only "
      "with {} {:.1f} tolerances from its declared value. Its error on held-out data is then {:.2f} times the noise.",
      key, tolerances, times_noise);
}

std::string unlisted_term(const std::vector<std::string>& terms, const HeldOutError& error) {
  std::string text = "The records contain an effect that is not listed.";
  for (const std::string& term : terms) {
    text += fmt::format(" The explained model {} {}.", &term == &terms.front() ? "has" : "also has", term);
  }
  return text + fmt::format(" The error on held-out data falls {}.", fall_of(error));
}

std::string unlisted_unexplained(const HeldOutError& error) {
  return fmt::format(
      "The records contain an effect that is not listed, and no candidate is supported. The error of the "
      "calibrated model on held-out data is {}.",
      size_of(error));
}

std::string one_place(const std::string& sites) {
  return fmt::format("One unknown signal at {} explains the records down to the noise.", sites);
}

std::string several_places(const std::vector<std::string>& sites) {
  return fmt::format("No single place explains it. The most likely places are {}.", listed(sites));
}

std::string undecided(bool interrupted, const HeldOutError& error) {
  return fmt::format("Undecided: {}. The error of the calibrated model on held-out data is {}.",
                     interrupted ? "the search was interrupted" : "no effect was searched for", size_of(error));
}

std::string best_so_far(const std::string& candidate, double share_of_error) {
  return fmt::format("Of the candidates fitted before, {} leaves the least: {:.0f} % of that error.", candidate,
                     100.0 * share_of_error);
}

std::string best_in_screening(const std::string& candidate) {
  return fmt::format("In screening, {} ranked first.", candidate);
}

std::string missing_effects(const std::vector<std::string>& effects) {
  return fmt::format("The declared model is missing {}.", listed(effects));
}

std::string faults_of_records(const std::vector<std::string>& faults) {
  return fmt::format("The records have a fault: {}.", listed(faults));
}

std::string error_falls(bool of_one, const HeldOutError& error, Rest rest) {
  constexpr std::array<std::string_view, 3> kRest{"The rest is close to the limit of the sensors.",
                                                  "The rest is close to the limit of the sensors and of the model's steps.",
                                                  "A part of it remains unexplained."};
  return fmt::format("With {}, the error on held-out data falls {}. {}", of_one ? "it" : "them", fall_of(error),
                     kRest.at(static_cast<std::size_t>(rest)));
}

std::string black_box_is_better() {
  return "A linear black box fits the records better, so the explained model is incomplete.";
}

std::string no_listed_finalist() { return "No listed effect ranked high enough in screening to be fitted jointly."; }

std::string is_not_listed(const std::string& candidate, double share_of_error, double share_of_kept) {
  return fmt::format(
      "The closest listed effect, {}, leaves {:.1f} % of the calibrated model's held-out error. The term that is kept "
      "leaves {:.1f} %.",
      candidate, 100.0 * share_of_error, 100.0 * share_of_kept);
}

std::string is_not_other(const std::string& candidate, double share_of_error) {
  return fmt::format("Another term, {}, leaves {:.1f} %.", candidate, 100.0 * share_of_error);
}

std::string baseline(bool is_better) {
  return is_better ? "The best linear black box fits the records better than the explained model, which is incomplete."
                   : "The best linear black box is no better than the explained model.";
}

std::string baseline_channel(const std::string& channel, std::size_t order, double delay, double left, double explained) {
  return fmt::format(
      "{}: order {} with a delay of {:.3g} ms leaves {:.3g}, the explained model {:.3g} (rms on held-out data).", channel,
      order, 1e3 * delay, left, explained);
}

std::string baseline_difference(double from, double to, double least, double most) {
  return fmt::format("The difference is largest between {:.3g} and {:.3g} Hz, at amplitudes of {:.3g} to {:.3g}.", from, to,
                     least, most);
}

std::string explain_equally(const std::string& one, const std::string& other) {
  return fmt::format("{} and {} explain these records equally well.", one, other);
}

std::string limits_of_rig() { return "the limits of the rig"; }
std::string limits_of_records() { return "the largest command of these records"; }

std::string no_profile(const std::string& limits) { return fmt::format("Within {}, no profile separates them.", limits); }

std::string separating_profile(const std::string& profile, double separation, const std::string& limits) {
  return fmt::format(
      "The profile that separates them best is {}. They then differ by {:.2g} times the sensor noise (rms), "
      "more than under any other profile within {}.",
      profile, separation, limits);
}

std::string weak_profile(const std::string& profile, double separation, const std::string& limits) {
  return fmt::format(
      "Within {}, no profile separates them. The best is {}. They then differ by only {:.2g} times the sensor "
      "noise.",
      limits, profile, separation);
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

std::string combination_identified(const std::string& name, double share, const std::vector<std::string>& factors) {
  return fmt::format("The data identify {}, to {}. They do not identify its factors separately: {}.", name, percent(share),
                     fmt::join(factors, ", "));
}

std::string factor(const std::string& key, double share) { return fmt::format("{} ({})", key, percent(share)); }

std::string hardly_separated(const std::string& key, const std::vector<std::string>& others, double share) {
  return fmt::format(
      "These estimates are strongly correlated. With {} larger by 1 %, {} gives nearly the same error. The relative "
      "standard deviation of {} alone is {}.",
      key, fmt::join(others, ", "), key, percent(share));
}

std::string moves_along(const std::string& key, double rate) {
  return fmt::format("{} {} by {}", key, rate < 0.0 ? "smaller" : "larger", percent(0.01 * std::abs(rate)));
}

std::string not_determined(const std::vector<std::string>& keys) {
  return fmt::format("The data do not determine {}. The declared values are kept.", fmt::join(keys, ", "));
}

std::string name_of(Combination combination) {
  constexpr std::array<std::string_view, kCombinations> names{
      "K_T R^2 / J, the square of the notch's frequency",
      "rated flow times position gain over piston area, the gain of the loop",
      "bulk modulus times piston area squared over trapped volume, the stiffness of the oil",
      "the damping of the engine over its inertia",
      "stiffness over inertia, the square of the natural frequency",
      "damping over inertia"};
  return std::string(names[static_cast<std::size_t>(combination)]);
}

std::string trace(const std::string& equation, const std::string& label, double rms, const std::string& unit,
                  double signal_to_noise) {
  return fmt::format(
      "The {} equation leaves a residual, {}, of {:.3g} {} rms. It is {:.1f} times what sensor noise alone "
      "would leave.",
      equation, label, rms, unit, signal_to_noise);
}

std::string trace_depends(const std::string& label, double share) {
  return fmt::format("Of the quantities examined, the {} explains most of it ({:.0f} % of its variance).", label,
                     100.0 * share);
}

std::string trace_depends_on_none() { return "It depends on none of the quantities examined."; }

}  // namespace hotfire::explain::words
