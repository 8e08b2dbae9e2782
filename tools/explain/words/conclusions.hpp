// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hotfire::explain::words {

/// Errors on held-out data as the verdict gives them: in times of the noise where that is known of every channel, else in
/// percent of the declared model's.
struct HeldOutError {
  double declared = 0.0;  ///< over the noise
  double model = 0.0;     ///< over the noise
  bool noise_is_known = true;
};
/// "8.0 times the noise", "12.5 % of the declared model's error".
std::string size_of(const HeldOutError& error);
/// "from 8.0 to 1.00 times the noise", "to 12.5 % of the declared model's error".
std::string fall_of(const HeldOutError& error);

/// "load pressure" of `load_pressure`.
std::string spoken(std::string_view name);
/// "a, b and c".
std::string listed(const std::vector<std::string>& names, std::string_view conjunction = "and");
/// "Pitch axis: TEXT".
std::string of_axis(const std::string& axis, const std::string& text);

/// The verdict: one sentence for each idea.
std::string nothing_missing(double times_noise);
std::string wrong_declaration(double times_noise, const std::string& key, double tolerances);
std::string unlisted_term(const std::vector<std::string>& terms, const HeldOutError& error);
std::string unlisted_unexplained(const HeldOutError& error);
std::string one_place(const std::string& sites);
std::string several_places(const std::vector<std::string>& sites);
std::string undecided(bool interrupted, const HeldOutError& error);
std::string best_so_far(const std::string& candidate, double share_of_error);
std::string best_in_screening(const std::string& candidate);
std::string missing_effects(const std::vector<std::string>& effects);
std::string faults_of_records(const std::vector<std::string>& faults);
/// What an explained model leaves.
enum class Rest { of_sensors, of_sensors_and_steps, unexplained };
std::string error_falls(bool of_one, const HeldOutError& error, Rest rest);
std::string black_box_is_better();

/// What a term of unknown law is not.
std::string no_listed_finalist();
std::string is_not_listed(const std::string& candidate, double share_of_error, double share_of_kept);
std::string is_not_other(const std::string& candidate, double share_of_error);

/// The best linear black box against the explained model.
std::string baseline(bool is_better);
std::string baseline_channel(const std::string& channel, std::size_t order, double delay, double left, double explained);
std::string baseline_difference(double from, double to, double least, double most);

/// The experiment that separates two candidates. `limits` is that of `limits_of_rig` or `limits_of_records`.
std::string explain_equally(const std::string& one, const std::string& other);
std::string limits_of_rig();
std::string limits_of_records();
std::string no_profile(const std::string& limits);
std::string separating_profile(const std::string& profile, double separation, const std::string& limits);
std::string weak_profile(const std::string& profile, double separation, const std::string& limits);

/// What the data identify. Shares are relative deviations.
std::string percent(double share);
std::string combination_identified(const std::string& name, double share, const std::vector<std::string>& factors);
std::string factor(const std::string& key, double share);
std::string hardly_separated(const std::string& key, const std::vector<std::string>& others, double share);
std::string moves_along(const std::string& key, double rate);
std::string not_determined(const std::vector<std::string>& keys);
/// Products of parameters that the data may identify better than their factors.
enum class Combination { notch, loop_gain, oil_stiffness, engine_damping, natural_frequency, mass_damping };
inline constexpr std::size_t kCombinations = 6;
std::string name_of(Combination combination);

/// The missing term that the equations give. `share` is that of its variance.
std::string trace(const std::string& equation, const std::string& label, double rms, const std::string& unit,
                  double signal_to_noise);
std::string trace_depends(const std::string& label, double share);
std::string trace_depends_on_none();

}  // namespace hotfire::explain::words
