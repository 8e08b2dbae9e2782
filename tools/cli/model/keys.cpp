// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/model_keys.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

using Json = nlohmann::ordered_json;

struct KeysOptions {
  std::vector<std::string> words;
  std::string topology = "simplex";
  bool json = false;
};

/// "0.003155 m^3/s, allowed: 1e-05 to 1"; the words of a choice.
std::string values_of(const ModelKey& key) {
  if (!key.words.empty()) {
    return fmt::format("\"{}\"", fmt::join(key.words, "\" | \""));
  }
  std::string value = key.points > 0 ? "[...]" : key.reference ? fmt::format("{:g}", *key.reference) : std::string{};
  if (key.unit != "1") {
    value += (value.empty() ? "" : " ") + key.unit;
  }
  std::vector<std::string> parts;
  if (!value.empty()) {
    parts.push_back(value);
  }
  if (key.points > 0) {
    parts.push_back(fmt::format("up to {} points", key.points));
  }
  if (std::isfinite(key.lower) && std::isfinite(key.upper)) {
    parts.push_back(fmt::format("allowed: {:g} to {:g}", key.lower, key.upper));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const KeyTable& table, const std::string& only) {
  std::string text = fmt::format("[{}]{}\n", table.path, table.site.empty() ? "" : "  # effect at " + table.site);
  for (const ModelKey& key : table.keys) {
    if (only.empty() || key.name == only) {
      text += fmt::format("{} = {}\n", key.name, values_of(key));
      text += fmt::format("    {}{}\n", key.meaning,
                          key.of_options.empty() ? "" : fmt::format("; of {} only", fmt::join(key.of_options, ", ")));
    }
  }
  return text;
}

Json json_of(const KeyTable& table, const std::string& only) {
  Json keys = Json::array();
  for (const ModelKey& key : table.keys) {
    if (!only.empty() && key.name != only) {
      continue;
    }
    Json one{{"key", key.name}, {"meaning", key.meaning}};
    if (key.words.empty()) {
      one["unit"] = key.unit;
      one["allowed"] = {key.lower, key.upper};  // JSON has no infinity: an open end is null
      one["reference"] = key.reference ? Json(*key.reference) : Json(nullptr);
    } else {
      one["words"] = key.words;
    }
    if (key.points > 0) {
      one["points"] = key.points;
    }
    if (!key.of_options.empty()) {
      one["only_of"] = key.of_options;
    }
    keys.push_back(std::move(one));
  }
  return {{"table", table.path}, {"site", table.site.empty() ? Json(nullptr) : Json(table.site)}, {"keys", keys}};
}

/// What a word selects: a table, an effect by its name alone, or a key with its table.
struct Selected {
  const KeyTable* table;
  std::string key;  ///< empty: all
};

Selected selected(const std::vector<KeyTable>& tables, const std::string& word, const std::string& topology) {
  for (const KeyTable& table : tables) {
    if (table.path == word || table.path == "effects." + word) {
      return {&table, {}};
    }
    for (const ModelKey& key : table.keys) {
      if (table.path + "." + key.name == word || table.path + "." + key.name == "effects." + word) {
        return {&table, key.name};
      }
    }
  }
  std::vector<std::string> known;
  for (const KeyTable& table : tables) {
    known.push_back(table.path);
    std::transform(table.keys.begin(), table.keys.end(), std::back_inserter(known),
                   [&](const ModelKey& key) { return table.path + "." + key.name; });
  }
  const std::vector<std::string_view> near = nearest_words(word, {known.begin(), known.end()}, 3);
  throw UsageError(
      fmt::format("\"{}\": no table, effect or key of a \"{}\" model; near it: {}. 'hotfire keys --topology {}' lists "
                  "them",
                  word, topology, fmt::join(near, ", "), topology));
}

/// The tables and the effects in one line each.
std::string overview(const std::vector<KeyTable>& tables) {
  std::string text = "tables of a declared model:\n";
  for (const KeyTable& table : tables) {
    if (table.site.empty()) {
      text += fmt::format("  {:<22} {} keys\n", table.path, table.keys.size());
    }
  }
  text += "effects, [effects.NAME]:\n";
  for (const KeyTable& table : tables) {
    if (!table.site.empty()) {
      text += fmt::format("  {:<22} at {}\n", table.path.substr(table.path.find('.') + 1), table.site);
    }
  }
  return text;
}

void run_keys(const KeysOptions& options) {
  const std::vector<KeyTable> tables = key_tables(options.topology);
  std::vector<Selected> chosen;
  std::transform(options.words.begin(), options.words.end(), std::back_inserter(chosen),
                 [&](const std::string& word) { return selected(tables, word, options.topology); });
  if (options.json) {
    Json result = Json::array();
    if (chosen.empty()) {
      std::transform(tables.begin(), tables.end(), std::back_inserter(chosen), [](const KeyTable& table) {
        return Selected{&table, {}};
      });
    }
    for (const Selected& one : chosen) {
      result.push_back(json_of(*one.table, one.key));
    }
    print_json(result);
    return;
  }
  if (chosen.empty()) {
    std::cout << overview(tables);
  }
  for (const Selected& one : chosen) {
    std::cout << text_of(*one.table, one.key);
  }
}

}  // namespace

void add_keys(CLI::App& program) {
  const auto options = std::make_shared<KeysOptions>();
  CLI::App* command = program.add_subcommand(
      "keys", "Describe the keys and effects of a model file: unit, allowed range, reference value, meaning");
  command->add_option("KEY", options->words, "table, effect or key to describe; none: lists the tables and effects")
      ->type_name(kKeyType);
  command->add_option("--topology", options->topology, "topology of the model")
      ->check(CLI::IsMember(topologies()))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Example: hotfire keys gimbal_friction servovalve.rated_flow\n"
      "A bare number in a model file is in the unit that is shown; a string has a unit of its own: \"50 gallon/minute\".");
  command->callback([options] { run_keys(*options); });
}

}  // namespace hotfire
