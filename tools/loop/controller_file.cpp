// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "tools/files/model/model_group.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/toml_source.hpp"
#include "tools/loop/controller.hpp"

namespace hotfire::loop {

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// An analogue section (b0 + b1 s + b2 s^2) / (a0 + a1 s + a2 s^2) by the bilinear rule s = c (z - 1) / (z + 1).
Section sampled(const std::array<double, 3>& b, const std::array<double, 3>& a, double c) {
  const auto squares = [c](const std::array<double, 3>& own) {
    return std::array{own[0] + c * own[1] + c * c * own[2], 2.0 * (own[0] - c * c * own[2]),
                      own[0] - c * own[1] + c * c * own[2]};
  };
  const auto above = squares(b);
  const auto below = squares(a);
  return {{above[0] / below[0], above[1] / below[0], above[2] / below[0]}, {below[1] / below[0], below[2] / below[0]}};
}

/// True if a row has as many finite numbers as `cells`, and nothing else.
bool read_cells(std::string_view row, std::array<double, 3>& cells) {
  const char* at = row.data();
  const char* const last = at + row.size();
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto [end, error] = std::from_chars(at, last, cells[k]);
    if (error != std::errc{} || !std::isfinite(cells[k])) {
      return false;
    }
    at = end;
    if (k + 1 < cells.size()) {
      if (at == last || *at != ',') {
        return false;
      }
      ++at;
    }
  }
  return at == last;
}

class ControllerReader {
 public:
  explicit ControllerReader(const std::filesystem::path& path) : source_(path), path_(path) {}

  Controller read() {
    source_.require_schema();
    const toml::table& root = source_.root();
    refuse_unknown_keys(
        source_, root, "",
        {"schema", "name", "axis", "period", "delay", "gain", "rate_gain", "integral_gain", "filter", "measured"});
    Controller controller;
    controller.path = path_;
    controller.name = root.contains("name") ? source_.text(*root.get("name"), "name") : path_.filename().string();
    controller.axis = source_.text(needed(root, "", "axis", "\"pitch\" or \"yaw\""), "axis");
    if (controller.axis != "pitch" && controller.axis != "yaw") {
      source_.refuse(*root.get("axis"), "axis", "allowed: \"pitch\", \"yaw\"");
    }
    controller.period = number(root, "", "period", "s", 1e-3, 1.0, {});
    controller.delay = number(root, "", "delay", "s", 0.0, 1.0, 0.0);
    if (const toml::node* delay = root.get("delay")) {
      controller.delay_at = fmt::format("{}:{}: ", path_.string(), delay->source().begin.line);
    }
    if (root.contains("measured")) {
      for (const char* key : {"gain", "rate_gain", "integral_gain", "filter"}) {
        if (root.contains(key)) {
          source_.refuse(*root.get(key), key, "beside \"measured\", which has all of the controller; remedy: leave out one");
        }
      }
      read_measured(path_.parent_path() / source_.text(*root.get("measured"), "measured"), controller);
      return controller;
    }
    controller.gain = number(root, "", "gain", "1", -1e6, 1e6, {});
    controller.rate_gain = number(root, "", "rate_gain", "s", -1e6, 1e6, 0.0);
    controller.integral_gain = number(root, "", "integral_gain", "1/s", -1e6, 1e6, 0.0);
    read_filters(controller);
    return controller;
  }

 private:
  const toml::node& needed(const toml::table& table, const std::string& prefix, const std::string& key,
                           const std::string& allowed) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      source_.refuse_missing(table, prefix + key, "missing; allowed: " + allowed);
    }
    return *node;
  }

  double number(const toml::table& table, const std::string& prefix, const std::string& key, const std::string& unit,
                double lower, double upper, std::optional<double> absent) const {
    if (absent && !table.contains(key)) {
      return *absent;
    }
    const std::string allowed = fmt::format("{:g} to {:g} {}", lower, upper, unit);
    const toml::node& node = needed(table, prefix, key, allowed);
    const double value = source_.number(node, prefix + key, unit);
    if (!(value >= lower && value <= upper)) {
      source_.refuse(node, prefix + key, "allowed: " + allowed);
    }
    return value;
  }

  void read_filters(Controller& controller) const {
    const toml::node* node = source_.root().get("filter");
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      source_.refuse(*node, "filter", "allowed: tables [[filter]]");
    }
    std::size_t index = 0;
    for (const toml::node& own : *list) {
      const std::string prefix = fmt::format("filter.{}.", ++index);
      controller.sections.push_back(section(source_.table(own, "filter"), prefix, controller.period));
    }
  }

  Section section(const toml::table& table, const std::string& prefix, double period) const {
    const toml::node& kind_node = needed(table, prefix, "kind", "lag, lead_lag, low_pass, notch");
    const std::string kind = source_.text(kind_node, prefix + "kind");
    const double highest = 0.49 / period;  // below half of the sampling rate
    const auto frequency = [&](const char* key) {
      return 2.0 * std::numbers::pi * number(table, prefix, key, "Hz", 1e-4, highest, {});
    };
    const auto kept = [period](double w) { return w / std::tan(0.5 * w * period); };
    if (kind == "lag") {
      refuse_unknown_keys(source_, table, prefix, {"kind", "frequency"});
      const double w = frequency("frequency");
      return sampled({w, 0.0, 0.0}, {w, 1.0, 0.0}, kept(w));
    }
    if (kind == "lead_lag") {
      refuse_unknown_keys(source_, table, prefix, {"kind", "zero", "pole"});
      const double zero = frequency("zero");
      const double pole = frequency("pole");
      return sampled({1.0, 1.0 / zero, 0.0}, {1.0, 1.0 / pole, 0.0}, kept(std::sqrt(zero * pole)));
    }
    if (kind == "low_pass") {
      refuse_unknown_keys(source_, table, prefix, {"kind", "frequency", "damping_ratio"});
      const double w = frequency("frequency");
      const double damping = number(table, prefix, "damping_ratio", "1", 0.01, 10.0, {});
      return sampled({w * w, 0.0, 0.0}, {w * w, 2.0 * damping * w, 1.0}, kept(w));
    }
    if (kind == "notch") {
      refuse_unknown_keys(source_, table, prefix, {"kind", "frequency", "damping_ratio", "depth"});
      const double w = frequency("frequency");
      const double damping = number(table, prefix, "damping_ratio", "1", 0.01, 10.0, {});
      const double depth = number(table, prefix, "depth", "1", 0.0, 1.0, 0.0);
      return sampled({w * w, 2.0 * depth * damping * w, 1.0}, {w * w, 2.0 * damping * w, 1.0}, kept(w));
    }
    source_.refuse(kind_node, prefix + "kind", suggestion(kind, {"lag", "lead_lag", "low_pass", "notch"}));
  }

  static void read_measured(const std::filesystem::path& path, Controller& controller) {
    CsvLines lines(path);
    std::string_view line;
    bool has_header = false;
    while (lines.next(line)) {
      if (line.empty() || line.starts_with('#')) {
        continue;
      }
      if (!has_header) {
        if (line != "frequency[Hz],gain[dB],phase[deg]") {
          lines.refuse("the header is not frequency[Hz],gain[dB],phase[deg]; a row is a point of command over attitude");
        }
        has_header = true;
        continue;
      }
      std::array<double, 3> cells{};
      if (!read_cells(line, cells)) {
        lines.refuse(
            fmt::format("\"{}\": not three finite numbers; allowed: frequency in Hz, gain in dB, phase in degrees", line));
      }
      if (!(cells[0] > (controller.measured.empty() ? 0.0 : controller.measured.back().frequency))) {
        lines.refuse(fmt::format("frequency = {:g}; allowed: above 0, ascending from row to row", cells[0]));
      }
      double phase = cells[2] * kRadians;
      if (!controller.measured.empty()) {
        const double turn = 2.0 * std::numbers::pi;
        phase += turn * std::round((controller.measured.back().phase - phase) / turn);
      }
      controller.measured.push_back({cells[0], cells[1] * std::numbers::ln10 / 20.0, phase});
    }
    if (controller.measured.size() < 2) {
      lines.refuse("fewer than two points; allowed: two or more");
    }
  }

  TomlSource source_;
  std::filesystem::path path_;
};

}  // namespace

Controller load_controller(const std::filesystem::path& path) { return ControllerReader(path).read(); }

}  // namespace hotfire::loop
