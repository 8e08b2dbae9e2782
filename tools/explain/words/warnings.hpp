// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire::explain::words {

/// Warnings of a report, `warnings` in report.json.
std::string ended_early();
/// `has_mean`: over time, which is then in the explained model.
std::string drifts(const std::string& effect, const std::string& site, bool has_mean);
std::string fault_of_record(const std::string& effect, const std::string& channel);
std::string left_out(const std::string& key);
std::string no_tolerance();
std::string moved_far(const std::string& key, double tolerances);
std::string at_a_bound(const std::string& key);
std::string undetermined(const std::string& key);
/// `effect`: one of the declared model.
std::string not_supported(const std::string& effect);
std::string noise_differs(const std::string& channel, double declared, double seen);
std::string unused_channel(const std::string& record, const std::string& channel, const std::vector<std::string>& known);
/// `seconds` from the start of a record are not compared.
std::string not_at_rest(const std::string& record, double seconds);
std::string excluded(const std::string& record, double from, double to);
std::string input_held(const std::string& record);
/// `bias` over full command.
std::string common_bias(double bias);

}  // namespace hotfire::explain::words
