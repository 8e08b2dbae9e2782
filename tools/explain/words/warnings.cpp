// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/words/warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace hotfire::explain::words {

std::string ended_early() {
  return "The search ended early, by Ctrl-C or --seconds. The report has the results up to then.";
}

std::string drifts(const std::string& effect, const std::string& site, bool has_mean) {
  return fmt::format(
      "{} at {} drifts over the time of these records. {}, because it runs other records. The report has its law, and "
      "--keep-drift writes it.",
      effect, site, has_mean ? "explained.toml has its mean" : "explained.toml does not have it");
}

std::string fault_of_record(const std::string& effect, const std::string& channel) {
  return fmt::format(
      "{} is a fault of the record, not of the plant, so explained.toml does not have it. Correct channel {} and explain "
      "the records again.",
      effect, channel);
}

std::string left_out(const std::string& key) {
  return fmt::format("{} is not in the model file: its reference value is used as exact.", key);
}

std::string no_tolerance() {
  return "No declared parameter has a tolerance: a wrong declared value will look like a missing effect.";
}

std::string moved_far(const std::string& key, double tolerances) {
  return fmt::format("{} was moved {:.1f} tolerances from its declared value.", key, tolerances);
}

std::string at_a_bound(const std::string& key) { return fmt::format("{} ended at a bound of the effect.", key); }

std::string undetermined(const std::string& key) { return fmt::format("{} is not determined by the data.", key); }

std::string not_supported(const std::string& effect) {
  return fmt::format(
      "The records do not support the declared effect {}: without it the error is the same. Remove it, or add a record in "
      "which it acts.",
      effect);
}

std::string noise_differs(const std::string& channel, double declared, double seen) {
  return fmt::format("The noise of {} is declared as {:.3g}, but the records show {:.3g}.", channel, declared, seen);
}

std::string unused_channel(const std::string& record, const std::string& channel, const std::vector<std::string>& known) {
  return fmt::format("{}: channel {} is not used, because the model does not have it. The model has {}.{}", record, channel,
                     fmt::join(known, ", "), known.size() > 1 ? " A measured load is an input, torque." : "");
}

std::string not_at_rest(const std::string& record, double seconds) {
  return fmt::format("{} does not start at rest: its first {:.2f} s are simulated but not compared.", record, seconds);
}

std::string excluded(const std::string& record, double from, double to) {
  return fmt::format("{}: {:.4g} to {:.4g} s are excluded on request. They are simulated but not compared.", record, from,
                     to);
}

std::string input_held(const std::string& record) {
  return fmt::format(
      "{}: the input is missing in excluded rows, where its last value is held. If it moved there, exclude about 2 s more, "
      "until the transient has decayed.",
      record);
}

std::string common_bias(double bias) {
  return fmt::format(
      "The zeros of all records agree with one null bias of the valve, {:.3g} of its full command. An offset of the command "
      "would look the same. explained.toml has it as valve_bias.",
      bias);
}

}  // namespace hotfire::explain::words
