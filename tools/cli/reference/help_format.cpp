// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/reference/help_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

namespace hotfire {

namespace {

constexpr std::size_t kWidth = 100;

/// A text in lines of at most `kWidth`. The first begins behind `head`, the others at column `indent`.
std::string wrapped(std::string head, std::size_t indent, const std::string& text) {
  std::string result;
  std::string line = std::move(head);
  bool is_first = true;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!is_first && line.size() + 1 + word.size() > kWidth) {
      result += line + "\n";
      line.assign(indent, ' ');
      is_first = true;
    }
    line += (is_first ? "" : " ") + word;
    is_first = false;
  }
  return result + line + "\n";
}

std::string entry(const std::string& name, std::size_t column, const std::string& meaning) {
  std::string head = "  " + name;
  if (head.size() >= column) {
    return head + "\n" + wrapped(std::string(column, ' '), column, meaning);
  }
  head.resize(column, ' ');
  return wrapped(head, column, meaning);
}

/// The kind of an option's value, which its type begins with: "UINT:UINT in [1 - 8]". The description of a file has its
/// ending.
std::string kind_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string kind = type.substr(0, type.find(':'));
  if (kind == "INT" || kind == "UINT") {
    return "N";
  }
  if (kind == "FLOAT") {
    return "X";
  }
  const std::string& description = option.get_description();
  const bool is_file = description.find("(.") != std::string::npos || description.starts_with("file ");
  return description.starts_with("folder") ? "FOLDER" : is_file ? "FILE" : kind;
}

/// The allowed values, as the type of an option says them to the parser.
std::string allowed_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string checks = type.find(':') == std::string::npos ? "" : type.substr(type.find(':') + 1);
  if (checks == "POSITIVE") {
    return "above 0";
  }
  if (checks == "NONNEGATIVE") {
    return "at least 0";
  }
  const auto between = [&](char open, char close) {
    const std::size_t from = checks.find(open);
    const std::size_t to = checks.rfind(close);
    return from == std::string::npos || to == std::string::npos ? std::string() : checks.substr(from + 1, to - from - 1);
  };
  if (const std::string range = between('[', ']'); !range.empty()) {
    return CLI::detail::find_and_replace(range, " - ", " to ");
  }
  return CLI::detail::find_and_replace(between('{', '}'), ",", ", ");
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::string names;
  for (const CLI::Option* option : options) {
    names += (names.empty() ? "" : ", ") + option->get_name();
  }
  return names;
}

}  // namespace

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option), get_column_width(),
               make_option_desc(option));
}

std::string HelpFormat::make_option_opts(const CLI::Option* option) const {
  // A positional is named by its value. A flag has none.
  const bool has_kind = option->get_type_size() != 0 && !option->get_positional();
  const bool is_list = option->get_expected_max() == CLI::detail::expected_max_vector_size;
  return (has_kind ? " " + kind_of(*option) : "") + (is_list ? " ..." : "");
}

std::string HelpFormat::make_option_desc(const CLI::Option* option) const {
  std::string text = option->get_description();
  const auto add = [&](std::string_view words, const std::string& what) {
    if (!what.empty()) {
      text += fmt::format("; {}{}", words, what);
    }
  };
  add("allowed: ", allowed_of(*option));
  if (text.find("default") == std::string::npos) {
    std::string value = option->get_default_str();
    value.erase(std::remove_if(value.begin(), value.end(), [](char c) { return c == '[' || c == ']'; }), value.end());
    add("default ", value);
  }
  add("not with ", names_of(option->get_excludes()));
  add("needs ", names_of(option->get_needs()));
  add("", option->get_required() ? "required" : "");
  return text;
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), get_column_width(), command->get_description());
}

std::string HelpFormat::make_description(const CLI::App* command) const {
  return wrapped("", 0, command->get_description() + (command->get_description().ends_with('.') ? "" : "."));
}

std::string HelpFormat::make_footer(const CLI::App* command) const {
  std::string text;
  bool in_example = false;
  std::istringstream lines(command->get_footer());
  for (std::string line; std::getline(lines, line);) {
    in_example = line.starts_with("Example: ") || (in_example && line.starts_with(' '));
    text += in_example || line.starts_with(' ') ? line + "\n" : wrapped("", 0, line);
  }
  return text;
}

}  // namespace hotfire
