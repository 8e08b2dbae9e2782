// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/reference/completion.hpp"

#include <algorithm>
#include <cctype>

#include "tools/cli/reference/realtime_help.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/model_keys.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// The endings of files that a description names, as in "measured records (.csv, candump .log, .hfr, .mf4, .h5, .mat)".
std::vector<std::string> file_patterns(const std::string& description) {
  std::vector<std::string> patterns;
  for (std::size_t at = description.find('.'); at != std::string::npos; at = description.find('.', at + 1)) {
    std::size_t end = at + 1;
    while (end < description.size() && std::isalnum(static_cast<unsigned char>(description[end])) != 0) {
      ++end;
    }
    const bool begins_a_word = at > 0 && (description[at - 1] == ' ' || description[at - 1] == '(');
    if (begins_a_word && end > at + 1) {
      patterns.push_back("*" + description.substr(at, end - at));
    }
  }
  return patterns.empty() ? std::vector<std::string>{"*"} : patterns;
}

/// The values that an option allows, as its type lists them: TEXT:{sines,multisine}.
std::vector<std::string> allowed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) {
    return {};
  }
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::vector<std::string> values_of(const CLI::Option& option) {
  if (option.get_type_name() == kKeyType) {
    return key_words();
  }
  std::vector<std::string> allowed = allowed_values(option);
  if (!allowed.empty()) {
    return allowed;
  }
  // A number has nothing to be completed with.
  return option.get_type_name().starts_with("TEXT") ? file_patterns(option.get_description()) : std::vector<std::string>{};
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

const CLI::Option* option_of_value(const CLI::App& command, const std::string& word) {
  const CLI::Option* option = word.starts_with("-") ? command.get_option_no_throw(word) : nullptr;
  return option != nullptr && option->get_items_expected_max() > 0 ? option : nullptr;
}

/// The options of a command that hotfire-rt carries out; none where hotfire-rt is not installed.
std::vector<RealtimeOption> further_options(const CLI::App& command) {
  if (!command.get_allow_extras()) {
    return {};
  }
  try {
    return realtime_help(command.get_name()).options;
  } catch (const UsageError&) {
    return {};
  }
}

std::vector<std::string> completions_in(const CLI::App& command, const std::vector<std::string>& words) {
  const std::string& current = words.back();
  const std::string& previous = words[words.size() - 2];
  if (const CLI::Option* option = option_of_value(command, previous)) {
    return values_of(*option);
  }
  const std::vector<RealtimeOption> further = further_options(command);
  const auto taking = std::find_if(further.begin(), further.end(),
                                   [&](const RealtimeOption& one) { return one.name == previous && !one.value.empty(); });
  if (taking != further.end()) {
    return taking->value == "FILE" ? std::vector<std::string>{"*"} : std::vector<std::string>{};
  }
  if (current.starts_with("-")) {
    std::vector<std::string> names = option_names(command);
    for (const RealtimeOption& option : further) {
      if (std::find(names.begin(), names.end(), option.name) == names.end()) {
        names.push_back(option.name);
      }
    }
    return names;
  }
  const auto positionals = command.get_options([](const CLI::Option* one) { return one->get_positional(); });
  return positionals.empty() ? option_names(command) : values_of(*positionals.front());
}

}  // namespace

std::vector<std::string> completions(const CLI::App& program, const std::vector<std::string>& words) {
  if (words.size() > 1) {
    const auto named = program.get_subcommands([&](const CLI::App* one) { return one->get_name() == words.front(); });
    return named.empty() ? std::vector<std::string>{} : completions_in(*named.front(), words);
  }
  std::vector<std::string> names = option_names(program);
  for (const CLI::App* command : program.get_subcommands(is_listed)) {
    names.push_back(command->get_name());
  }
  return names;
}

}  // namespace hotfire
